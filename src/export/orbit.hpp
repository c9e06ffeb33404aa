#pragma once
// Loops: what is played once is changed so that it goes round without an end.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "wisp/model/model.hpp"

namespace wisp::exporting {

/// Makes rows of an ARX or switched model's outputs the periodic orbit under the shocks that they contain: to each row
/// is added what the model does without shocks from the difference of the two ends, for ever. `rows` begin lags − 1
/// rows before the loop's first frame and end with the frame that is to be the first one again; `mode` says which mode
/// made each row (switched models). Returns false where that does not converge: the model forgets too slowly.
///
/// Precondition: rows.size() == (lags + frames) × outputs, and lags == output_lags(model).
bool close_orbit(const Model& model, std::span<const std::size_t> mode, std::size_t lags, std::vector<double>& rows);

/// Longest lag of an output in an ARX or switched model, at least 1.
std::size_t output_lags(const Model& model);

}  // namespace wisp::exporting
