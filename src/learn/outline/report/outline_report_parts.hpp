#pragma once
// What the reports of learning and validating an outline have in common.

#include <string>
#include <string_view>
#include <vector>

#include "learn/outline/outline_alignment.hpp"
#include "wisp/base/report.hpp"

namespace wisp {

/// A number of steps in an id: "1", "5", … and "inf".
std::string step_id(int steps);

/// An entry ID.STEPS for every number of steps. `label` empty: for programs only; else the horizon is added in words.
void add_by_steps(const std::string& id, const std::vector<int>& steps, const std::vector<double>& values,
                  const std::string& label, const std::string& unit, ReportSection& section);

/// The mean over control points of figures that are one a number of steps and control point.
std::vector<double> mean_per_step(const std::vector<std::vector<double>>& per_step);

/// The entry of `values` for a number of steps; NaN where it was not judged.
double at_steps(const std::vector<int>& steps, const std::vector<double>& values, int wanted);

/// Columns PREFIX.STEPS of a table for programs.
void add_step_columns(const std::string& prefix, const std::vector<int>& steps, ReportTable& table);

/// `alignment` [{recording, input, motion, offset_seconds, …}], and a sentence each for people.
void add_alignment(const std::vector<InputAlignment>& alignment, ReportSection& section);

}  // namespace wisp
