#pragma once
// What learning answers with.

#include "wisp/base/report.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// A model and what to think of it. The model's `training` has the verdict and the figures that stay with it; the
/// report has everything that was found.
struct Fit {
  Model model;
  Report report;
};

}  // namespace wisp
