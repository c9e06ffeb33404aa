#pragma once
// What of a recording's input was 1 when a model was learned.

#include <string>

#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// Errors: the model has no input of that name, or was not learned from recordings.
Result<double> trained_scale(const Model& model, const std::string& input);

}  // namespace wisp
