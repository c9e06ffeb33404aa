#include "learn/outline/report/outline_report_parts.hpp"

#include <cmath>
#include <limits>

#include "base/statistics.hpp"
#include "learn/arx/judge/prediction.hpp"

namespace wisp {
namespace {

std::string horizon(int steps) {
  if (steps == kFreeRun) return "simulated freely";
  return steps == 1 ? "next frame" : std::to_string(steps) + " frames ahead";
}

}  // namespace

std::string step_id(int steps) { return steps == kFreeRun ? "inf" : std::to_string(steps); }

void add_by_steps(const std::string& id, const std::vector<int>& steps, const std::vector<double>& values,
                  const std::string& label, const std::string& unit, ReportSection& section) {
  for (std::size_t k = 0; k < steps.size() && k < values.size(); ++k) {
    section.entries.push_back(
        {id + "." + step_id(steps[k]), values[k], label.empty() ? label : label + ", " + horizon(steps[k]), unit});
  }
}

std::vector<double> mean_per_step(const std::vector<std::vector<double>>& per_step) {
  std::vector<double> means;
  for (const auto& values : per_step) means.push_back(mean(values));
  return means;
}

double at_steps(const std::vector<int>& steps, const std::vector<double>& values, int wanted) {
  for (std::size_t k = 0; k < steps.size() && k < values.size(); ++k) {
    if (steps[k] == wanted) return values[k];
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void add_step_columns(const std::string& prefix, const std::vector<int>& steps, ReportTable& table) {
  for (int k : steps) table.columns.push_back({prefix + "." + step_id(k), ""});
}

void add_alignment(const std::vector<InputAlignment>& alignment, ReportSection& section) {
  ReportTable table{"alignment",
                    "",
                    {{"recording", ""},
                     {"input", ""},
                     {"motion", ""},
                     {"offset_seconds", ""},
                     {"offset_ci95", ""},
                     {"usable", ""},
                     {"reason", ""},
                     {"frames_moved", ""}},
                    {}};
  for (const InputAlignment& one : alignment) {
    section.entries.push_back({"", one.note(), "timing", ""});
    table.rows.push_back({one.source, one.input, one.motion, one.found.offset_seconds,
                          ReportList{one.found.low_seconds, one.found.high_seconds}, one.found.usable, one.found.reason,
                          one.frames_moved});
  }
  section.tables.push_back(std::move(table));
}

}  // namespace wisp
