#pragma once
// What the leaf's equations cost: counted by running them on numbers that count.

#include <cstdint>

#include "simulate/leaf/leaf_flight.hpp"

namespace wisp {

/// Arithmetic operations: + − × ÷ √, absolute values and changes of sign. Comparisons and moves are none.
struct LeafCost {
  std::int64_t evaluation = 0;  ///< one evaluation of the right-hand side, in a wind that is given
  std::int64_t step = 0;        ///< one step, its four evaluations included
};

/// Counts them, in still air.
///
/// Precondition: check(leaf) is good.
LeafCost count_leaf_operations(const Leaf& leaf);

}  // namespace wisp
