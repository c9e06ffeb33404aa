#pragma once
// Figures of extinction in the reports of models, of learning and of validating.

#include <optional>

#include "learn/flame/extinction_learning.hpp"
#include "wisp/base/report.hpp"

namespace wisp {

/// `extinction` {input, level, seconds, haste, recovery, modes […]} as model_report() has it; none where nothing puts
/// the model out.
ReportSection extinction_section(const Model& model);

/// extinction_section() of a model that was just learned, with `source`, `agreement` {…}, `unexplained`, `level_range`
/// and `seconds_range`.
ReportSection extinction_section(const Model& model, const std::optional<LearnedExtinction>& learned);

/// `extinction` {deaths, died, gusts, spared, …}; none where the model has no rule.
ReportSection extinction_section(const std::optional<JudgedExtinction>& judged);

}  // namespace wisp
