#pragma once
// Fidelity of synthesized behaviour to the recorded one. Every measure has two bounds from the same data: the floor
// (real against real) and the ceiling (real against its own frames in random order).
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

struct FidelityOptions {
  std::vector<std::string> channels;  ///< channels to compare; empty: all outputs of the first real recording
  std::size_t welch_samples = 64;     ///< even, at least 16; at most the longest stretch of each half and of the play
  std::size_t max_windows = 500;      ///< ≥ 2, maximum on each side
  std::uint64_t seed = 1;
  bool motion_only = false;  ///< compute no long_spectra, tails and verbatim_seconds (NaN), whose time grows with the
                             ///< square of the rate or of the length
};

struct Bounded {
  double value = 0;    ///< real against synthesized
  double floor = 0;    ///< real against real: every other recording, or half the time of a single one, against the rest
  double ceiling = 0;  ///< real against its own frames in random order
};

struct ChannelFidelity {
  std::string name;
  double sd_real = 0;
  double sd_synthesized = 0;
  Bounded log_spectral_distance;  ///< dB
};

/// Result of a comparison. NaN where there are too few data for a measure.
struct Fidelity {
  std::vector<ChannelFidelity> channels;
  Bounded log_spectral_distance;  ///< mean over channels

  Bounded energy_distance;  ///< normalised to [0, 1], over standardised windows of all channels and their velocities

  // Measures of long_distances(). NaN where the recording is too short.
  Bounded long_motion;   ///< normalised energy distance of windows of all channels and their velocities
  Bounded long_spectra;  ///< normalised energy distance of log spectra in geometric bands
  Bounded tails;         ///< mean |ln| of synthesized over real, for the 99th and 99.9th percentile of |acceleration|

  double verbatim_seconds = 0;  ///< duration of the longest synthesized stretch that copies the real recording

  std::size_t welch_samples = 0;  ///< length of the segments used by Welch's method
};

/// Compares synthesized recordings with real ones, which should be unseen in training. Synthesized stretches are cut to
/// the longest real one's length, so that windows are comparable. Errors: no recordings, a channel missing from one,
/// rates that differ, fewer than 16 consecutive complete rows in either half of the real or in the synthesized data.
Result<Fidelity> fidelity(std::span<const Recording> real, std::span<const Recording> synthesized,
                          const FidelityOptions& options = {});

}  // namespace wisp
