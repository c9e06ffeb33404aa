#pragma once
// Sound against picture: by how much one is late, found from what both tell of the same wind.

#include <cstdint>
#include <span>
#include <string>

#include "wisp/base/result.hpp"

namespace wisp {

/// How the offset is searched.
struct AlignmentOptions {
  double rate_hz = 60;             ///< of both series
  double most_seconds = 1;         ///< offsets searched: ± this, 0.05 to 10
  double confidence_level = 0.95;  ///< of the interval, 0.5 to 0.999
  int resamples = 200;             ///< bootstrap resamples for the interval, 50 to 10000
  double block_seconds = 2;        ///< length of the bootstrap's blocks: longer than gusts, 0.1 to 60
  std::uint64_t seed = 1;          ///< of the bootstrap
};

/// By how much the motion comes after the wind.
struct Alignment {
  double offset_seconds = 0;  ///< motion(t) goes with wind(t − offset): positive where the picture comes later
  double low_seconds = 0;     ///< the interval's ends
  double high_seconds = 0;
  double correlation = 0;  ///< at that offset, −1 to 1
  bool usable = false;     ///< an offset stands out from chance and lies within the search
  std::string reason;      ///< why not, or what was found
};

/// Estimates by cross-correlation, of both series whitened alike, how much later `motion` follows `wind`. The offset
/// includes the time that the thing itself takes to answer (a flame: tens of milliseconds).
/// Both series have one value a frame; NaN is missing.
/// Errors: lengths differ, fewer than 4 × most_seconds of samples, an option outside its range.
Result<Alignment> align_offset(std::span<const double> wind, std::span<const double> motion,
                               const AlignmentOptions& options = {});

}  // namespace wisp
