#pragma once
// A recording: named channels at one fixed rate, cut into episodes, with missing samples.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// What a channel is to the system that was recorded.
enum class Role {
  kInput,   ///< acts on the thing (wind)
  kOutput,  ///< what the thing does (an outline's control point)
  kMotion,  ///< where the thing is held (the base of a candle that is carried about)
};

/// One named time series. A missing sample is a quiet NaN.
struct Channel {
  std::string name;
  std::string unit;  ///< as written between brackets; empty where none is stated
  Role role = Role::kOutput;
  std::vector<double> samples;
};

/// A mark on rows, such as `filled`: one byte a row, 0 or 1.
struct RowFlag {
  std::string name;
  std::vector<std::uint8_t> rows;
};

/// A named fact about the whole recording (a CSV comment line `# NAME VALUE…`). kNotNumbers names a column that was
/// left out, since it holds no numbers.
struct Attribute {
  std::string name;
  std::string value;
};
inline constexpr std::string_view kNotNumbers = "not_numbers";

/// Rows [begin, end) of one episode: a stretch that history may cross.
struct Episode {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t size() const { return end - begin; }
};

/// How the rate was found; not written to a file.
struct RateNote {
  std::string text{};    ///< empty: the file or the caller stated it
  bool guessed = false;  ///< whether a person should look at it
};

/// Inputs, outputs and motion over time. All channels and flags have `rows()` entries.
struct Recording {
  std::string source{};  ///< where it came from, for messages
  double rate_hz = 0;    ///< samples a second, > 0
  std::vector<Channel> channels{};
  std::vector<RowFlag> flags{};
  std::vector<std::int64_t> episode_ids{};  ///< one a row; empty: a single episode
  std::vector<Attribute> attributes{};
  std::size_t first_row = 0;  ///< of a slice: which row of the whole its first one is
  RateNote rate_note{};

  std::size_t rows() const { return channels.empty() ? 0 : channels.front().samples.size(); }
};

/// The episodes of a recording: maximal runs of rows with one episode id. History never crosses from one to the next.
std::vector<Episode> episodes(const Recording& recording);

/// Indices into `recording.channels` of all channels with a role, in their order.
std::vector<std::size_t> channels_with_role(const Recording& recording, Role role);

/// Index of the channel of that name, or nothing.
std::optional<std::size_t> find_channel(const Recording& recording, std::string_view name);

/// The attribute's value, or nothing.
std::optional<std::string_view> find_attribute(const Recording& recording, std::string_view name);

/// The attribute's value as numbers separated by blanks; nothing where there is no such attribute.
/// Errors: something in it is not a finite number.
Result<std::optional<std::vector<double>>> numbers_attribute(const Recording& recording, std::string_view name);

/// Sets an attribute to numbers that numbers_attribute() reads back bit for bit.
void set_numbers_attribute(Recording& recording, std::string_view name, std::span<const double> values);

/// When every row was, in seconds since the first row of the whole.
std::vector<double> seconds_of(const Recording& recording);

/// Rows [first, last) of a recording, with its channels, flags, episodes and attributes.
///
/// Precondition: first <= last <= recording.rows().
Recording slice(const Recording& recording, std::size_t first, std::size_t last);

/// Checks what every consumer relies on: rate finite and positive, channels and flags of one length, names present and
/// unique, no infinite sample. Errors name the channel and row (1-based).
Result<void> check(const Recording& recording);

}  // namespace wisp
