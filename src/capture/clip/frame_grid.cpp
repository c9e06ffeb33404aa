#include "capture/clip/frame_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace wisp {

std::int64_t FrameGrid::place(double seconds) {
  const std::int64_t next = last_ + 1;
  if (!first_) first_ = seconds;
  const double place = (seconds - *first_) * rate_hz_;
  const double longest = static_cast<double>(next) + kLongestGapSeconds * rate_hz_;
  if (place > longest) {
    // Shifts the time origin, so that this frame follows the last one by the longest gap.
    ++long_gaps_;
    last_ = static_cast<std::int64_t>(longest);
    removed_ += (place - static_cast<double>(last_)) / rate_hz_;
    first_ = seconds - static_cast<double>(last_) / rate_hz_;
    offsets_.resize(static_cast<std::size_t>(last_) + 1);
    return last_;
  }
  last_ = std::max(next, static_cast<std::int64_t>(std::llround(place)));
  offsets_.resize(static_cast<std::size_t>(last_));
  offsets_.push_back(static_cast<float>(place - static_cast<double>(last_)));
  return last_;
}

std::int64_t FrameGrid::follow() {
  offsets_.push_back(0);
  return ++last_;
}

std::vector<std::string> FrameGrid::warnings(const std::string& name) const {
  std::vector<std::string> out;
  if (long_gaps_ > 0) out.push_back(name + ": " + std::to_string(long_gaps_) + " holes in time were shortened");
  float worst = 0;
  for (const float offset : offsets_) worst = std::max(worst, std::abs(offset));
  if (worst > 0.6) {  // places
    char line[200];
    std::snprintf(
        line, sizeof line,
        ": frames come at irregular times, up to %.1f ms off a rate of %.6g a second; only outlines are interpolated",
        1000 * worst / rate_hz_, rate_hz_);
    out.push_back(name + line);
  }
  return out;
}

}  // namespace wisp
