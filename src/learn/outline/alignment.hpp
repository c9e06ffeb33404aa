#pragma once
// The delay between sound and picture, from what both say of the same wind.

#include <span>
#include <string>

#include "wisp/base/result.hpp"

namespace wisp {

/// How the offset is searched.
struct AlignmentOptions {
  double rate_hz = 60;     ///< of both series, > 0
  double max_seconds = 1;  ///< offsets searched: from minus to plus this, > 0
};

/// By how much the motion comes after the wind.
struct Alignment {
  double offset_seconds = 0;  ///< motion(t) goes with wind(t − offset): positive where the motion comes later
  double low_seconds = 0;     ///< the ends of its 95 % interval
  double high_seconds = 0;
  double correlation = 0;  ///< of the whitened series at that offset, −1 to 1
  double chance = 0;       ///< largest |correlation| that unrelated recordings reach in one of a hundred
  bool usable = false;     ///< the offset stands out from chance, lies within the search and is sharp
  std::string reason;      ///< one clause: what was found, or why it is not usable
};

/// Estimates how much later `motion` follows `wind`, by the cross-correlation of both after an autoregressive filter
/// that whitens the wind (Box & Jenkins, Time Series Analysis, section on prewhitening): it peaks where the response of
/// motion to wind does. So the offset is that of the recording plus the time that the thing itself takes to answer (a
/// flame's tip: some 50 ms). Its interval comes from a bootstrap over blocks of time.
/// Both series have one value a frame; NaN is missing.
/// Errors: lengths differ; less than four times max_seconds in which both are known; a series that never changes.
Result<Alignment> align_offset(std::span<const double> wind, std::span<const double> motion,
                               const AlignmentOptions& options = {});

}  // namespace wisp
