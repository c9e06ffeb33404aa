#pragma once
// Over-fitting that fidelity alone would praise: behaviour copied from the data.

#include <cstddef>
#include <span>

#include "learn/fidelity/fidelity_stretch.hpp"

namespace wisp {

/// The longest run of consecutive rows in `synthesized` that repeats consecutive rows of `real`: every channel within
/// `tolerance` times its standard deviation over `real`. Returns its rows.
///
/// Precondition: the same channels on both sides; tolerance >= 0.
std::size_t longest_verbatim_run(std::span<const Stretch> real, std::span<const Stretch> synthesized, double tolerance);

}  // namespace wisp
