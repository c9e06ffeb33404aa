#pragma once
// Reports on learning and validating an outline.

#include <vector>

#include "learn/outline/outline_fit.hpp"
#include "learn/outline/outline_judgement.hpp"
#include "wisp/base/report.hpp"

namespace wisp {

/// Sections with the figures of a fit, without its verdict and warnings.
std::vector<ReportSection> report_sections(const OutlineFit& fit);

/// Sections with the figures of a validation, without its warnings and the series of plots.
std::vector<ReportSection> report_sections(const OutlineJudgement& found);

}  // namespace wisp
