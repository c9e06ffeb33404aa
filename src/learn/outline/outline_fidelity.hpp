#pragma once
// Figures for the verdict: how steadily what was recorded moves, and how far free play is from it. `validate` has more.

#include <optional>

#include "learn/fidelity/fidelity.hpp"
#include "learn/outline/outline_preparation.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// How much neighbouring frames differ, of how much frames picked at random do: mean squared differences over all
/// outputs. 0 moves steadily, 1 is frames in random order. Half the ratio of J. von Neumann, Annals of Mathematical
/// Statistics 12 (1941).
double unsteadiness(const PreparedOutlines& prepared);

/// The normalised energy distance between a recording in the model's units and a play along `driving`, between that
/// recording's halves (floor) and to its own frames in random order (ceiling). Nothing where it is too short.
/// Errors: as synthesize().
Result<std::optional<Bounded>> play_distance(const Model& model, const PreparedOutlines& prepared, std::size_t which,
                                             const Recording& driving, std::uint64_t seed);

}  // namespace wisp
