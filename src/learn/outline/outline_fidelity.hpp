#pragma once
// How far free play is from what was learned from, quickly: one figure for the verdict. `validate` has all of them.

#include <optional>

#include "learn/fidelity/fidelity.hpp"
#include "learn/outline/outline_preparation.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// The normalised energy distance between a recording in the model's units and a play along `driving`, between that
/// recording's halves (floor) and to its own frames in random order (ceiling). Nothing where it is too short.
/// Errors: as synthesize().
Result<std::optional<Bounded>> play_distance(const Model& model, const PreparedOutlines& prepared, std::size_t which,
                                             const Recording& driving, std::uint64_t seed);

}  // namespace wisp
