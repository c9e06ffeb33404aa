#pragma once
// How like the real thing is synthesized behaviour? Every measure stands between two bounds from the same data: the
// floor (real against real) and the ceiling (real against its own frames in random order).
//
// Definitions, sources and how to read the figures: docs/explanation/fidelity.md.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// How to compare.
struct FidelityOptions {
  std::vector<std::string> channels;  ///< which to compare; empty: all outputs of the first real recording
  std::size_t welch_samples = 64;     ///< even, at least 16; shortened where half of the data has no such stretch
  std::size_t max_windows = 500;      ///< ≥ 2, a side
  std::uint64_t seed = 1;
};

/// A measure between its two bounds.
struct Bounded {
  double value = 0;    ///< real against synthesized
  double floor = 0;    ///< real against real: one half of the recordings against the other, or of a single one in time
  double ceiling = 0;  ///< real against its own frames in random order
};

/// One channel.
struct ChannelFidelity {
  std::string name;
  double sd_real = 0;
  double sd_synthesized = 0;
  Bounded log_spectral_distance;  ///< dB
};

/// The comparison. NaN where there are too few data for a measure.
struct Fidelity {
  std::vector<ChannelFidelity> channels;
  Bounded log_spectral_distance;  ///< mean over channels

  Bounded energy_distance;  ///< normalised, in [0, 1], over standardised windows of all channels and their velocities

  // Over two seconds (long_distances()). NaN where the recording has too few such windows.
  Bounded long_motion;   ///< normalised energy distance of windows of all channels and their velocities
  Bounded long_spectra;  ///< the same of log spectra in geometric bands
  Bounded tails;         ///< mean |ln| of the ratio of the 99th and 99.9th percentile of accelerations

  double verbatim_seconds = 0;  ///< longest stretch of synthesized behaviour that is copied from the real one

  std::size_t welch_samples = 0;  ///< that were used
};

/// Compares synthesized recordings with real ones, which learning should not have seen. Synthesized stretches are cut
/// to the length of the longest real one, so that both are seen through the same window.
/// Errors: no recordings, a channel that one of them has not, rates that differ, fewer than 16 consecutive complete
/// rows in either half of the real or in the synthesized data.
Result<Fidelity> fidelity(std::span<const Recording> real, std::span<const Recording> synthesized,
                          const FidelityOptions& options = {});

}  // namespace wisp
