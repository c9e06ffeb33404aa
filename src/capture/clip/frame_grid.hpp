#pragma once
// Assigns frames with arbitrary time stamps to a grid of fixed rate.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wisp {

class FrameGrid {
 public:
  /// Maximum length of a gap; longer gaps are shortened to it, as an episode ends at such a gap.
  static constexpr double kLongestGapSeconds = 2;

  /// Precondition: rate_hz > 0.
  explicit FrameGrid(double rate_hz) : rate_hz_(rate_hz) {}

  /// Returns the place (index on the grid) of a frame at `seconds` (on any clock): the place nearest to this time that
  /// follows the last frame's. Gaps of more than two seconds are shortened to two.
  std::int64_t place(double seconds);

  /// Returns the place of a frame whose time is unknown: the one after the last.
  std::int64_t follow();

  /// Place of the last frame; -1 before the first.
  std::int64_t last() const { return last_; }

  /// Offset of each place's frame from its grid time, in places, positive if late; 0 without a frame.
  const std::vector<float>& offsets() const { return offsets_; }

  /// Number of gaps that were shortened, and the time that this removed, seconds.
  int shortened() const { return long_gaps_; }
  double removed() const { return removed_; }

  /// Warnings about irregular times of the clip `name`, one sentence each.
  std::vector<std::string> warnings(const std::string& name) const;

 private:
  double rate_hz_;
  std::optional<double> first_;  // time of place 0
  std::int64_t last_ = -1;
  std::vector<float> offsets_;
  int long_gaps_ = 0;
  double removed_ = 0;
};

}  // namespace wisp
