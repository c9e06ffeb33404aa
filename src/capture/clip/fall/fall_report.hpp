#pragma once
// What is said of the falls in a film: whether to learn from them, why there are none, and their figures.

#include <optional>
#include <string>
#include <vector>

#include "capture/clip/fall/fall_scene.hpp"
#include "capture/clip/fall/fall_tracks.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"

namespace wisp::fall {

/// What all falls have in common.
struct Facts {
  std::size_t rows = 0;
  std::size_t filled = 0;  ///< of them, between frames in which it was seen
  double aspect = 0;       ///< length over width, median
  double short_share = 0;  ///< of the rows, in which it is too short to tell how it lies
  double jerks = 0;        ///< share of the rows at which its axis jumps

  /// Whether it is long enough in view to tell how it lies, and why, or why not.
  bool tilt() const;
  const char* tilt_reason() const;
};

/// Precondition: there are falls, each with rows.
Facts facts_of(const std::vector<Fall>& falls);

/// Why there is no fall in a film.
Error no_fall(const std::string& source, const Wall& wall, const std::vector<Seen>& frames, const Falls& found);

ReportVerdict verdict_on(const Falls& found, const Wall& wall);

/// Where too many of the rows were interpolated.
std::optional<std::string> filled_warning(const Facts& facts);

/// `frames`: empty where one was lost; `repeated` of them are as the one before.
ReportSection frames_section(const std::vector<std::vector<std::uint8_t>>& frames, std::size_t repeated,
                             const Wall& wall, double rate_hz);

ReportSection falls_section(const Falls& found, const Facts& facts, double metres_per_pixel, double rate_hz);

}  // namespace wisp::fall
