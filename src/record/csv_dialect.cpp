#include "record/csv_dialect.hpp"

#include "record/csv_cells.hpp"

namespace wisp::csv {
namespace {

struct Shape {
  std::size_t cells = 0;
  std::size_t filled = 0;  // cells before the empty ones at the end
  bool numbers = true;     // all cells are numbers or missing
  bool any_number = false;
};

Shape shape_of(std::string_view line, char separator) {
  Shape shape;
  for_each_cell(line, separator, [&](const Cell& cell) {
    ++shape.cells;
    if (!cell.text.empty()) shape.filled = shape.cells;
    const bool number = number_of(cell, separator).has_value();
    shape.any_number |= number;
    shape.numbers &= number || is_missing(cell);
  });
  return shape;
}

// Rows may end in separators that the names do not have.
bool fits(const Shape& names, const Shape& row) {
  return names.filled >= 2 && row.cells >= names.filled && row.filled <= names.filled;
}

}  // namespace

char separator_of(const std::vector<std::string>& lines) {
  const std::string_view names = lines.front(), row = lines.back();
  for (char candidate : {'\t', ';', ',', kBlanks}) {
    const Shape shape = shape_of(row, candidate);
    if (shape.numbers && shape.any_number && fits(shape_of(names, candidate), shape)) return candidate;
  }
  for (char candidate : {'\t', ';', ','}) {
    if (fits(shape_of(names, candidate), shape_of(row, candidate))) return candidate;
  }
  for (char candidate : {'\t', ';', ','}) {
    if (shape_of(names, candidate).cells >= 2) return candidate;
  }
  // With one column, a comma in a number is a decimal mark.
  return shape_of(row, ';').numbers && has_comma({row, false}) ? ';' : ',';
}

bool has_number(std::string_view line, char separator) { return shape_of(line, separator).any_number; }

bool is_row(std::string_view line, char separator) {
  const Shape shape = shape_of(line, separator);
  return shape.numbers && shape.any_number;
}

bool is_row_of_units(std::string_view line, std::string_view next, char separator) {
  bool text = false, number = false;
  for_each_cell(line, separator, [&](const Cell& cell) {
    const bool one = cell.text == "1" || cell.text == "-";  // how units say that there is none
    number |= !one && number_of(cell, separator).has_value();
    text |= !one && !is_missing(cell) && !number_of(cell, separator);
  });
  return text && !number && has_number(next, separator);
}

std::vector<std::string> units_in(std::string_view line, char separator) {
  std::vector<std::string> units;
  for_each_cell(line, separator, [&](const Cell& cell) {
    std::string_view unit = cell.text;
    const bool bracketed = unit.size() >= 2 &&
                           ((unit.front() == '[' && unit.back() == ']') || (unit.front() == '(' && unit.back() == ')'));
    if (bracketed) unit = unit.substr(1, unit.size() - 2);
    units.emplace_back(unit == "-" ? "1" : unit);
  });
  return units;
}

char told_separator(std::string_view line) {
  const std::string_view said = cell_of(line).text;
  const bool told = said.size() == 5 && (said.substr(0, 4) == "sep=" || said.substr(0, 4) == "SEP=");
  return told ? said[4] : '\0';
}

}  // namespace wisp::csv
