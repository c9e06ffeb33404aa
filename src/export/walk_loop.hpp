#pragma once
// Loops of a chain: where a walk comes back to the place in a segment at which it was so many frames before.

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "wisp/run/bank.hpp"

namespace wisp::exporting {

struct WalkLoop {
  std::vector<float> rows;  ///< frames × outputs; its first row is at the origin
  std::array<double, 3> travel{};
};

/// Plays banks of one chain until an instance comes back to a place in a segment after exactly `frames` steps, and
/// makes its walk a loop: turned evenly by what its heading has turned, so that the frame after the last one has the
/// attitude and the velocity of the first. Returns nothing where none of the walks comes back.
///
/// Precondition: the model is a valid chain that is played as segments; inputs.size() == model.inputs.size().
std::optional<WalkLoop> find_walk_loop(const Model& model, std::size_t frames, std::uint64_t seed,
                                       const std::vector<float>& inputs);

}  // namespace wisp::exporting
