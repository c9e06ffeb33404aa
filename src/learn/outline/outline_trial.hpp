#pragma once
// What is seen of a learned outline when it plays freely, beside the recording that it plays along.

#include <optional>
#include <vector>

#include "learn/fidelity/fidelity.hpp"
#include "learn/outline/outline_preparation.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// Figures of a free play along the recording in which most moves.
struct OutlineTrial {
  double unsteadiness = 0;  ///< of the recordings: mean square difference of neighbouring frames over that of frames
                            ///< picked at random; 0 moves steadily, 1 is frames in random order (half the ratio of
                            ///< J. von Neumann, Annals of Mathematical Statistics 12 (1941))
  double held_share = 0;    ///< of steps in which something was clamped to its range
  std::vector<double> sd_ratio;  ///< per output, played over recorded; 1 where nothing moves
  double crossed = 0;            ///< share of played outlines that cross themselves
  double crossed_recorded = 0;   ///< and of recorded ones
  double outside = 0;            ///< share of played outlines farther from every recorded one than 99 % of those of the
                                 ///< last 40 % of the rows are from the rows before
  std::optional<Bounded> half_second;  ///< normalised energy distance of windows; nothing where that is too short
  std::optional<Bounded> two_seconds;  ///< likewise
};

/// Plays a model along the inputs of the liveliest of the recordings in the model's units; `original` are the same
/// recordings with their inputs, in step.
/// Errors: as synthesize().
Result<OutlineTrial> try_outline(const Model& model, const PreparedOutlines& prepared,
                                 std::span<const Recording> original, std::uint64_t seed);

}  // namespace wisp
