#pragma once
// Cost of a model in operations, counted by running the real kernels on a counting number type.

#include <cstdint>

#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// Operations of one instance in one frame (one step, one reading of the view).
struct Cost {
  std::int64_t multiply_adds_per_frame = 0;  ///< number of nonzero coefficients of A and B, the paper's count
  std::int64_t operations_per_frame = 0;     ///< all arithmetic: sum of dynamics, noise, random, view and extinction
  std::int64_t dynamics_operations = 0;  ///< inputs, filters, and the record of clamping: + − × ÷ √ on numbers, logic
  std::int64_t noise_operations = 0;   ///< on numbers: from random words to noise added to the outputs
  std::int64_t random_operations = 0;  ///< arithmetic and logic on 32-bit words, for the noise
  std::int64_t view_operations = 0;    ///< interpolation between two steps (none for a chain), units, and the polyline
  /// Operations of the most expensive frame: one with a segment join, a search for a residual while the input swings,
  /// or the shrinking of an extinguished flame; for models without such frames equal to operations_per_frame.
  std::int64_t worst_operations = 0;
  std::int64_t steered_operations = 0;     ///< as worst_operations, while a chain is steered, whose joins then weigh
                                           ///< breadth × modes candidates; 0: not steerable
  std::int64_t extinction_operations = 0;  ///< on numbers: rule of extinction while the flame burns; 0 without a rule
};

/// Counts the operations of one frame of one instance, with an outline read as a polyline of `polyline_points` (0:
/// control points only). Every input is at its highest value, as a step skips regressors that have been 0 for the whole
/// history; the worst frame is also sought among frames whose inputs swing between 0 and that value. Comparisons,
/// conversions and moves are not arithmetic and are not counted. Errors: those of Bank::create().
Result<Cost> count_operations(const Model& model, int polyline_points = 32);

}  // namespace wisp
