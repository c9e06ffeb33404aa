#pragma once
// The delay between sound and picture, from what both say of the same wind.

#include <cstdint>
#include <span>
#include <string>

#include "wisp/base/result.hpp"

namespace wisp {

/// How the offset is searched.
struct AlignmentOptions {
  double rate_hz = 60;             ///< of both series, > 0
  double max_seconds = 1;          ///< offsets searched: from minus to plus this, 0.05 to 10
  double confidence_level = 0.95;  ///< of the interval, 0.5 to 0.999
  int resamples = 400;             ///< bootstrap resamples for the interval, 50 to 100000
  double block_seconds = 2;        ///< of the bootstrap's blocks, 0.1 to 60: longer than a gust, so that blocks are
                                   ///< nearly independent
  std::uint64_t seed = 1;          ///< of the bootstrap
};

/// By how much the motion comes after the wind.
struct Alignment {
  double offset_seconds = 0;  ///< motion(t) goes with wind(t − offset): positive where the motion comes later
  double low_seconds = 0;     ///< the interval's ends
  double high_seconds = 0;
  double correlation = 0;  ///< of the whitened series at that offset, −1 to 1
  double chance = 0;       ///< what the largest |correlation| would reach by chance in one of a hundred recordings
  bool usable = false;     ///< the offset stands out from chance, lies within the search and is sharp
  std::string reason;      ///< one clause: what was found, or why it is not usable
};

/// Estimates how much later `motion` follows `wind`, by the cross-correlation of both after an autoregressive filter
/// that whitens the wind (Box & Jenkins, Time Series Analysis, section on prewhitening): it peaks where the response of
/// motion to wind does. So the offset is that of the recording plus the time that the thing itself takes to answer (a
/// flame's tip: some 50 ms). Its interval comes from a bootstrap over blocks of time.
/// Both series have one value a frame; NaN is missing.
/// Errors: lengths differ; less than four times max_seconds in which both are known; a series that never changes; an
/// option outside its range.
Result<Alignment> align_offset(std::span<const double> wind, std::span<const double> motion,
                               const AlignmentOptions& options = {});

}  // namespace wisp
