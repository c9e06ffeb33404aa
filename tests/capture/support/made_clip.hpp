#pragma once
// Clips that are made picture by picture, and captured.

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "capture/support/synthetic.hpp"
#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp::support {

inline OutlineCaptureOptions options_for(int points = 8) {
  OutlineCaptureOptions options;
  options.points = points;
  options.rate_hz = 30;
  options.source = "made.mp4";
  return options;
}

/// A camera's noise, so that no two frames are the same picture.
inline void add_noise(Plane& plane, unsigned seed) {
  std::mt19937 random(seed);
  for (auto& pixel : plane.pixels) {
    pixel = static_cast<std::uint8_t>(std::clamp(pixel + static_cast<int>(random() % 5) - 2, 0, 255));
  }
}

inline Plane noisy_flame(int k) {
  Plane plane = flame_picture(swaying(k));
  add_noise(plane, static_cast<unsigned>(k) + 1);
  return plane;
}

inline Result<CapturedOutline> capture(int frames, const std::function<Plane(int)>& picture,
                                       const OutlineCaptureOptions& options = options_for()) {
  OutlineCapture capture(options);
  for (int k = 0; k < frames; ++k) {
    const Plane plane = picture(k);
    if (auto fed = capture.feed(grey_picture(plane.view())); !fed) return fed.error();
  }
  return capture.finish();
}

/// Whether a row has no outline.
inline bool missing(const CapturedOutline& captured, std::size_t row) {
  return std::isnan(captured.recording.channels[0].samples[row]);
}

}  // namespace wisp::support
