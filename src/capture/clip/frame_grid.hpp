#pragma once
// Frames that come at times of their own, on a grid of one fixed rate.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wisp {

class FrameGrid {
 public:
  /// Precondition: rate_hz > 0.
  explicit FrameGrid(double rate_hz) : rate_hz_(rate_hz) {}

  /// The place of the next frame, whose time is `seconds` on any clock: the nearest after the last one. A hole of more
  /// than two seconds is shortened to that.
  std::int64_t place(double seconds);

  /// The place of the next frame, whose time is not known.
  std::int64_t follow();

  /// The last frame's; -1 before the first.
  std::int64_t last() const { return last_; }

  /// How far each place's frame was from it, in places, later positive; 0 where none is.
  const std::vector<float>& offsets() const { return offsets_; }

  /// How many holes were shortened.
  int shortened() const { return long_gaps_; }

  /// What was odd about the times, one sentence each about `name`.
  std::vector<std::string> warnings(const std::string& name) const;

 private:
  double rate_hz_;
  std::optional<double> first_;  // time of place 0
  std::int64_t last_ = -1;
  std::vector<float> offsets_;
  int long_gaps_ = 0;
};

}  // namespace wisp
