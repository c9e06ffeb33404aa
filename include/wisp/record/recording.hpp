#pragma once
// A recording: named channels at one fixed rate, divided into episodes, with missing samples.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// Role of a channel in the recorded system.
enum class Role {
  kInput,   ///< acts on the object (wind)
  kOutput,  ///< behaviour of the object (an outline's control point)
  kMotion,  ///< position of the object's support (the base of a candle that is carried about)
};

/// One named time series. A missing sample is a quiet NaN.
struct Channel {
  std::string name;
  std::string unit;  ///< as written between the brackets of a column's name; empty: none stated
  Role role = Role::kOutput;
  std::vector<double> samples;
};

/// A flag of rows, such as `filled`: one byte per row, 0 or 1.
struct RowFlag {
  std::string name;
  std::vector<std::uint8_t> rows;
};

/// Name of the flag of rows whose picture is missing or repeats the previous picture: they hold no measurement.
inline constexpr std::string_view kLostRows = "lost";

/// A named fact about the whole recording (a CSV comment line `# NAME VALUE…`). The value of an attribute named
/// kNotNumbers is the name of a column that was omitted because it holds no numbers.
struct Attribute {
  std::string name;
  std::string value;
};
inline constexpr std::string_view kNotNumbers = "not_numbers";

/// Rows [begin, end) of one episode, which was recorded without interruption.
struct Episode {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t size() const { return end - begin; }
};

/// How the rate was determined; not written to a file.
struct RateNote {
  std::string text{};    ///< empty: the file or the caller stated the rate
  bool guessed = false;  ///< true: the rate is a guess that a person should check
};

/// Inputs, outputs and motion over time. All channels and flags have `rows()` entries.
struct Recording {
  std::string source{};  ///< origin, for messages
  double rate_hz = 0;    ///< samples per second, > 0
  std::vector<Channel> channels{};
  std::vector<RowFlag> flags{};
  std::vector<std::int64_t> episode_ids{};  ///< one per row; empty: a single episode
  std::vector<Attribute> attributes{};
  std::size_t first_row = 0;  ///< for a slice: index of its first row in the original recording
  RateNote rate_note{};

  std::size_t rows() const { return channels.empty() ? 0 : channels.front().samples.size(); }
};

/// Returns the episodes of a recording: maximal runs of rows with one episode id. No model's history crosses a border.
std::vector<Episode> episodes(const Recording& recording);

/// Returns indices into `recording.channels` of all channels with a role, in their order.
std::vector<std::size_t> channels_with_role(const Recording& recording, Role role);

/// Returns the index of the channel of that name, or nothing.
std::optional<std::size_t> find_channel(const Recording& recording, std::string_view name);

/// Returns whether the flag of that name marks a row; false without such a flag.
bool is_flagged(const Recording& recording, std::string_view flag, std::size_t row);

/// Returns the attribute's value, or nothing.
std::optional<std::string_view> find_attribute(const Recording& recording, std::string_view name);

/// Returns the numbers in the attribute's value, which are separated by blanks; nothing if there is no such attribute.
/// Errors: a part of the value is not a finite number.
Result<std::optional<std::vector<double>>> numbers_attribute(const Recording& recording, std::string_view name);

/// Sets an attribute to numbers that numbers_attribute() reads back bit for bit.
void set_numbers_attribute(Recording& recording, std::string_view name, std::span<const double> values);

/// Returns the time of every row, in seconds since the first row of the original recording (see first_row).
std::vector<double> seconds_of(const Recording& recording);

/// Returns rows [first, last) of a recording, with its channels, flags, episodes and attributes.
/// Precondition: first <= last <= recording.rows().
Recording slice(const Recording& recording, std::size_t first, std::size_t last);

/// Checks the invariants of a recording: rate finite and positive; channels, flags and episode ids of one length;
/// channel names present and unique; no infinite sample. Errors name the channel or flag, and the sample (1-based).
Result<void> check(const Recording& recording);

}  // namespace wisp
