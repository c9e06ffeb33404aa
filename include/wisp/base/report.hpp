#pragma once
// The results of capturing, learning and validating as data: named figures, tables, series, warnings, and a verdict.
// describe/ renders a report as text, JSON or HTML; the command line plots its series.

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

/// One value of a report: nothing, a boolean, an integer, a number, a text, or a list of values. A number that is not
/// finite means that the figure does not exist.
struct ReportValue;
using ReportList = std::vector<ReportValue>;
struct ReportValue : std::variant<std::monostate, bool, std::int64_t, double, std::string, ReportList> {
  using Base = std::variant<std::monostate, bool, std::int64_t, double, std::string, ReportList>;
  ReportValue() = default;
  ReportValue(ReportValue&&) = default;
  ReportValue& operator=(const ReportValue&) = default;
  ReportValue& operator=(ReportValue&&) = default;
  ~ReportValue() = default;
  // If a copy runs out of memory, libstdc++ 12's constructor destroys unconstructed values; its assignment does not.
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
  std::string id;  ///< path in the JSON document: a dot begins a nested field ("stable.radius"), brackets name a list
                   ///< element ("step[0].sd"), a backslash escapes the next character
  ReportValue value;
  std::string label;                                ///< name in words; empty: for programs only
  std::string unit;                                 ///< unit of the value, such as "%"; empty: none
  std::optional<std::array<double, 2>> interval{};  ///< 95 % confidence interval; in JSON beside the value as ID_ci95
  std::string meaning{};                            ///< what the figure measures, and which values are good
};

/// A column of a table.
struct ReportColumn {
  std::string id;     ///< key in the JSON objects of the rows; dots nest
  std::string label;  ///< empty: for programs only
  std::string unit{};
};

/// Rows with common columns; in JSON a list of objects.
struct ReportTable {
  std::string id;
  std::string label;  ///< empty: for programs only
  std::vector<ReportColumn> columns;
  std::vector<std::vector<ReportValue>> rows;  ///< one value per column
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

/// Verdict whether the subject of the report may be used, with its reason in one sentence.
struct ReportVerdict {
  bool usable = false;
  std::string reason;
  std::string code{};  ///< machine-readable reason; empty: only the sentence is known
};

/// Verdict, warnings and sections of one capture, learning run or validation.
struct Report {
  std::optional<ReportVerdict> verdict{};
  std::vector<std::string> warnings{};
  std::vector<ReportSection> sections{};

  /// Adds a section and returns it.
  ReportSection& add(std::string title);

  /// Returns the entry with that id; null where there is none.
  const ReportEntry* find(std::string_view id) const;

  /// Appends the sections and warnings of another report; the verdict stays.
  void append(Report other);
};

}  // namespace wisp
