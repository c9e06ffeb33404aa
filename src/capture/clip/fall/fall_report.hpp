#pragma once
// Report on the falls in a film: whether they are usable for learning, why there are none, and their figures.

#include <optional>
#include <string>
#include <vector>

#include "capture/clip/fall/fall_scene.hpp"
#include "capture/clip/fall/fall_tracks.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"

namespace wisp::fall {

/// Summary of all falls.
struct Facts {
  std::size_t rows = 0;
  std::size_t filled = 0;  ///< number of rows interpolated between frames in which it was seen
  double aspect = 0;       ///< median of length / width
  double short_share = 0;  ///< share of rows in which it is too short to measure attitude
  double jerks = 0;        ///< share of rows in which its axis jumps

  /// Whether it is long enough in view to measure attitude; with the reason.
  bool tilt() const;
  const char* tilt_reason() const;
};

/// Precondition: there are falls, each with rows.
Facts facts_of(const std::vector<Fall>& falls);

/// The reason why a film contains no fall.
Error no_fall(const std::string& source, const Wall& wall, const std::vector<Seen>& frames, const Falls& found);

ReportVerdict verdict_on(const Falls& found, const Wall& wall);

/// Warning where too many rows were interpolated.
std::optional<std::string> filled_warning(const Facts& facts);

/// `frames`: empty for lost frames; `repeated` of them equal the frame before.
ReportSection frames_section(const std::vector<std::vector<std::uint8_t>>& frames, std::size_t repeated,
                             const Wall& wall, double rate_hz);

ReportSection falls_section(const Falls& found, const Facts& facts, double metres_per_pixel, double rate_hz);

}  // namespace wisp::fall
