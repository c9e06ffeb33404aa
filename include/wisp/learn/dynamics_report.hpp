#pragma once
// What a model's dynamics are, as figures: nothing that needs a recording.

#include <string>

#include "wisp/base/report.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// Of an ARX model its coefficients, poles, zeros and static gains; of a switched one its modes and what decides
/// between them; of others nothing. `prefix` stands before every id.
Report dynamics_report(const Model& model, const std::string& prefix = "");

}  // namespace wisp
