#include "learn/outline/outline_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "learn/numeric/constants.hpp"
#include "learn/outline/outline_shape.hpp"

namespace wisp {
namespace {

constexpr double kMinSearch = 0.05;  // seconds either way; align_offset() takes no less

// Short recordings are searched less far: the search takes a quarter of what there is.
AlignmentOptions options_for(const Recording& recording, const std::vector<double>& input,
                             const std::vector<double>& motion) {
  double rows = 0;
  for (std::size_t t = 0; t < input.size(); ++t) rows += std::isnan(input[t]) || std::isnan(motion[t]) ? 0 : 1;
  AlignmentOptions options{.rate_hz = recording.rate_hz};
  options.max_seconds = std::clamp(rows / recording.rate_hz / 5, kMinSearch, options.max_seconds);
  return options;
}

Alignment found_or_reason(const Recording& recording, const std::vector<double>& input,
                          const std::vector<double>& motion) {
  auto found = align_offset(input, motion, options_for(recording, input, motion));
  if (found) return *std::move(found);
  Alignment none;
  none.reason = found.error().message;
  return none;
}

// The correlation over the level that chance reaches.
double clarity(const Alignment& alignment) {
  return alignment.chance > 0 ? std::abs(alignment.correlation) / alignment.chance : 0;
}

// Frames by which the input must be moved so that the motion comes no earlier; 0 unless that is sure.
int frames_too_late(const Alignment& alignment, double rate_hz) {
  if (!alignment.usable || alignment.high_seconds >= 0) return 0;
  return static_cast<int>(std::lround(-alignment.offset_seconds * rate_hz));
}

void move_earlier(Recording& recording, std::size_t channel, int frames) {
  auto& samples = recording.channels[channel].samples;
  for (const Episode& episode : episodes(recording)) {
    const auto begin = samples.begin() + static_cast<std::ptrdiff_t>(episode.begin);
    const auto end = samples.begin() + static_cast<std::ptrdiff_t>(episode.end);
    const auto kept = std::min(static_cast<std::ptrdiff_t>(frames), end - begin);
    std::copy(begin + kept, end, begin);
    std::fill(end - kept, end, kMissing);
  }
}

}  // namespace

TipMotion tip_motion(const Recording& recording, const OutlineLayout& layout) {
  const OutlineCurve curve(layout.knots);
  TipMotion out;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const std::vector<double> control = whole_row(recording, layout, row);
    const OutlinePoint tip = control.empty() ? OutlinePoint{kMissing, kMissing} : tip_of(curve.polyline(control));
    const std::size_t last = control.empty() ? 0 : control.size() - 2;
    out.sway.push_back(control.empty() ? kMissing : tip[0] - (control[0] + control[last]) / 2);
    out.height.push_back(control.empty() ? kMissing : tip[1] - (control[1] + control[last + 1]) / 2);
  }
  return out;
}

std::string InputAlignment::note() const {
  if (frames_moved == 0) return input + ": " + found.reason;
  char moved[96];
  std::snprintf(moved, sizeof moved, "; it was moved %d frames earlier, since nothing moves before it is blown at",
                frames_moved);
  return input + ": " + found.reason + moved;
}

Result<AlignedOutline> align_outline(const Recording& recording, const std::vector<std::string>& inputs) {
  const auto layout = outline_layout(recording);
  if (!layout) return layout.error();
  AlignedOutline out{recording, {}};
  const TipMotion tip = tip_motion(recording, *layout);
  for (const std::string& name : inputs) {
    const auto channel = find_channel(recording, name);
    if (!channel) continue;
    const auto& samples = recording.channels[*channel].samples;
    const Alignment sway = found_or_reason(recording, samples, tip.sway);
    const Alignment height = found_or_reason(recording, samples, tip.height);
    const bool by_sway = clarity(sway) >= clarity(height);
    InputAlignment one{recording.source, name, by_sway ? "sway" : "height", by_sway ? sway : height, 0};
    one.frames_moved = frames_too_late(one.found, recording.rate_hz);
    if (one.frames_moved > 0) move_earlier(out.recording, *channel, one.frames_moved);
    out.inputs.push_back(std::move(one));
  }
  return out;
}

}  // namespace wisp
