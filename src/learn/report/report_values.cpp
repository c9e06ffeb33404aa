#include "learn/report/report_values.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "record/number_text.hpp"
#include "wisp/learn/arx_recipe.hpp"

namespace wisp::arx {

void add(ReportSection& section, std::string id, ReportValue value, std::string label, std::string unit,
         std::string meaning) {
  section.entries.push_back(
      {std::move(id), std::move(value), std::move(label), std::move(unit), std::nullopt, std::move(meaning)});
}

void add_line(ReportSection& section, std::string label, ReportValue value, std::string meaning) {
  add(section, "", std::move(value), std::move(label), "", std::move(meaning));
}

void add_orders(const ArxOrders& orders, const std::string& prefix, ReportSection& section) {
  add_all(section, prefix, "na", list_of(orders.na), "nb", list_of(orders.nb), "nk", list_of(orders.nk));
}

ReportList list_of(const OrderMatrix& orders) {
  ReportList rows;
  for (int i = 0; i < orders.rows(); ++i) {
    ReportList row;
    for (int j = 0; j < orders.columns(); ++j) row.push_back(orders(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

ReportList matrix_of(std::span<const double> values, std::size_t rows) {
  ReportList all;
  const std::size_t columns = rows > 0 ? values.size() / rows : 0;
  for (std::size_t r = 0; r < rows; ++r) {
    const auto row = values.subspan(r * columns, columns);
    all.push_back(ReportList(row.begin(), row.end()));
  }
  return all;
}

ReportValue list_or_none(const std::vector<double>& values) {
  return values.empty() ? ReportValue() : ReportValue(values);
}

CoefficientLists lists_of(const ArxOrders& orders, const std::vector<std::vector<double>>& rows) {
  CoefficientLists out;
  for (int i = 0; i < orders.outputs(); ++i) {
    auto next = rows[static_cast<std::size_t>(i)].begin();
    const auto take = [&next](int count) {
      ReportList lags(next, next + count);
      next += count;
      return lags;
    };
    ReportList a, b;
    for (int j = 0; j < orders.outputs(); ++j) a.push_back(take(orders.na(i, j)));
    for (int k = 0; k < orders.inputs(); ++k) b.push_back(take(orders.nb(i, k)));
    out.a.push_back(std::move(a));
    out.b.push_back(std::move(b));
  }
  return out;
}

std::string steps_id(int steps) { return steps == kFreeRun ? "inf" : std::to_string(steps); }

std::string as_id(const std::string& name) {
  std::string id;
  for (char c : name) {
    if (c == '.' || c == '[' || c == '\\') id += '\\';
    id += c;
  }
  return id;
}

std::string element(const char* list, std::size_t index, const char* field) {
  return std::string(list) + "[" + std::to_string(index) + "]." + field;
}

ReportSection cost_section(const Cost& cost) {
  ReportSection section{"Cost"};
  add(section, "cost.multiply_adds_per_frame", cost.multiply_adds_per_frame, "multiply-adds a frame", "",
      "by the paper's count");
  add(section, "cost.operations_per_frame", cost.operations_per_frame, "operations a frame", "",
      "all arithmetic, noise and view included");
  add(section, "cost.worst_operations_per_frame", cost.worst_operations, "operations in the worst frame");
  add(section, "cost.steered_operations_per_frame", cost.steered_operations);
  return section;
}

void complete(Fit& fit) {
  fit.model.training.program = "wisp " WISP_VERSION;
  for (std::string& source : fit.model.training.sources) source = std::filesystem::path(source).filename().string();
  for (const Output& output : fit.model.outputs) {
    const double range = output.highest - output.lowest;
    const double step = std::max(std::abs(output.lowest), std::abs(output.highest)) * 0x1p-23;
    if (std::holds_alternative<PlainView>(fit.model.view) && range > 0 && step > 0.01 * range)
      fit.report.warnings.push_back("output '" + output.name + "' moves by " + number_text(range, 3) +
                                    " far from 0, where play, in single precision, has steps of " +
                                    number_text(step, 2) + ": subtract its level");
  }
  const auto cost = count_operations(fit.model);
  if (!cost && fit.report.verdict && fit.report.verdict->usable) {
    fit.model.training.usable = {false, "the model cannot be played: " + cost.error().message};
    fit.report.verdict = ReportVerdict{false, fit.model.training.usable.reason};
  }
  if (!cost) return;
  // Runtimes with little memory read the cost from the model instead of counting.
  fit.model.training.multiply_adds_per_frame = cost->multiply_adds_per_frame;
  fit.model.training.operations_per_frame = cost->operations_per_frame;
  fit.report.sections.push_back(cost_section(*cost));
}

}  // namespace wisp::arx
