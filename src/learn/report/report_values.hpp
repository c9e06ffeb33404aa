#pragma once
// Building blocks of reports on ARX models.

#include <span>
#include <string>
#include <vector>

#include "wisp/base/report.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/run/cost.hpp"

namespace wisp::arx {

/// Adds a figure. Without a label it is shown to programs only, without an id to people only.
void add(ReportSection& section, std::string id, ReportValue value, std::string label = {}, std::string unit = {},
         std::string meaning = {});

/// Adds figures for programs: pairs of an id and a value, with `prefix` before every id.
template <class Value, class... More>
void add_all(ReportSection& section, const std::string& prefix, const char* id, Value&& value, More&&... more) {
  add(section, prefix + id, std::forward<Value>(value));
  if constexpr (sizeof...(more) > 0) add_all(section, prefix, std::forward<More>(more)...);
}

void add_line(ReportSection& section, std::string label, ReportValue value, std::string meaning = {});

/// Adds a column to a table, with value(row) in each of its rows.
template <class Value>
void add_column(ReportTable& table, ReportColumn column, Value value) {
  table.columns.push_back(std::move(column));
  for (std::size_t row = 0; row < table.rows.size(); ++row) table.rows[row].emplace_back(value(row));
}

/// Adds for programs `na`, `nb` and `nk`, with `prefix` before their ids.
void add_orders(const ArxOrders& orders, const std::string& prefix, ReportSection& section);

ReportList list_of(const OrderMatrix& orders);
ReportList matrix_of(std::span<const double> values, std::size_t rows);

/// List of the values; null where there are none.
ReportValue list_or_none(const std::vector<double>& values);

/// Coefficients A[i][j] and B[i][k], taken from the layout of ArxModel::theta.
struct CoefficientLists {
  ReportList a;
  ReportList b;
};
CoefficientLists lists_of(const ArxOrders& orders, const std::vector<std::vector<double>>& rows);

/// Id of a number of steps: "5", or "inf" for free simulation.
std::string steps_id(int steps);

/// A name as one field of an id: dots, opening brackets and backslashes are escaped by a backslash.
std::string as_id(const std::string& name);

/// The id of an element's field: "inputs[2].name".
std::string element(const char* list, std::size_t index, const char* field);

/// Section `cost` {multiply_adds_per_frame, operations_per_frame, …}.
ReportSection cost_section(const Cost& cost);

/// Records in the model's training the program's version, the file names of the sources without the folders of the
/// user's disk, and the cost of a frame; adds the cost to the report. A model that cannot be played has no cost.
void complete(Fit& fit);

/// Returns the matrix [output][input] of value(output, input).
template <class Value>
ReportList per_pair(const ArxOrders& orders, Value value) {
  ReportList rows;
  for (int i = 0; i < orders.outputs(); ++i) {
    ReportList row;
    for (int k = 0; k < orders.inputs(); ++k) row.push_back(value(i, k));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace wisp::arx
