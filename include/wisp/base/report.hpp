#pragma once
// What capturing, learning and validating have to say, as data: named figures, tables, series, warnings, and a verdict.
// describe/ makes text, JSON and pictures of it; nothing else formats figures.

#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace wisp {

/// One value of a report: nothing, a truth, a whole number, a number, a text, or a list of values. A number that is not
/// finite means that there is no such figure.
struct ReportValue;
using ReportList = std::vector<ReportValue>;
struct ReportValue : std::variant<std::monostate, bool, std::int64_t, double, std::string, ReportList> {
  using Base = std::variant<std::monostate, bool, std::int64_t, double, std::string, ReportList>;
  ReportValue() = default;
  ReportValue(ReportValue&&) = default;
  ReportValue& operator=(const ReportValue&) = default;
  ReportValue& operator=(ReportValue&&) = default;
  ~ReportValue() = default;
  // libstdc++ 12 destroys what was never made where a copy of such a variant finds no memory; assigning, it does not.
  ReportValue(const ReportValue& other) : Base() { *this = other; }  // NOLINT(bugprone-copy-constructor-init)
  ReportValue(bool value) : Base(value) {}
  template <std::integral Whole>
  ReportValue(Whole value) : Base(static_cast<std::int64_t>(value)) {}
  ReportValue(double value) : Base(value) {}
  ReportValue(const char* value) : Base(std::string(value)) {}
  ReportValue(std::string value) : Base(std::move(value)) {}
  ReportValue(ReportList values) : Base(std::move(values)) {}
  ReportValue(const std::vector<double>& values) : Base(ReportList(values.begin(), values.end())) {}
};

/// A named figure or fact.
struct ReportEntry {
  std::string id;  ///< its place in the JSON document: dots nest, "stable.radius", brackets are elements, "step[0].sd",
                   ///< and a backslash takes the next character as it is
  ReportValue value;
  std::string label;                                ///< in words; empty: for programs only
  std::string unit;                                 ///< of the value, "%" among them; empty: none
  std::optional<std::array<double, 2>> interval{};  ///< 95 % confidence; in JSON beside it as ID_ci95
  std::string meaning{};                            ///< what it says, and what a good one is
};

/// A column of a table.
struct ReportColumn {
  std::string id;     ///< of the field in the JSON objects of the rows; dots nest
  std::string label;  ///< empty: for programs only
  std::string unit{};
};

/// Rows of the same shape; in JSON a list of objects.
struct ReportTable {
  std::string id;
  std::string label;  ///< empty: for programs only
  std::vector<ReportColumn> columns;
  std::vector<std::vector<ReportValue>> rows;  ///< as many values as columns
};

/// A curve to plot.
struct ReportSeries {
  std::string id;
  std::string label;
  std::string x_label;  ///< with its unit
  std::string y_label;
  std::vector<double> x;
  std::vector<double> y;
};

/// Figures that belong together.
struct ReportSection {
  std::string title;  ///< empty: none
  std::vector<ReportEntry> entries{};
  std::vector<ReportTable> tables{};
  std::vector<ReportSeries> series{};
};

/// Whether a thing may be used, first, in a sentence.
struct ReportVerdict {
  bool usable = false;
  std::string reason;
  std::string code{};  ///< names the reason for programs; empty: only the sentence is known
};

/// The whole.
struct Report {
  std::optional<ReportVerdict> verdict{};
  std::vector<std::string> warnings{};
  std::vector<ReportSection> sections{};

  /// Adds a section and returns it.
  ReportSection& add(std::string title);

  /// The entry of that id; null where there is none.
  const ReportEntry* find(std::string_view id) const;

  /// Adds another report's sections and warnings after its own; the verdict stays.
  void append(Report other);
};

}  // namespace wisp
