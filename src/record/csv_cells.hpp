#pragma once
// Cells of tables that other programs wrote: separators, quotes, numbers with a decimal point or comma. Also their time
// column: the step between rows, and whether it is constant.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::csv {

struct Cell {
  std::string_view text;  ///< without the quotes and blanks around it
  bool quoted = false;
};

/// Separator that means any number of blanks.
inline constexpr char kBlanks = ' ';

inline std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Returns the length of a quoted cell at the beginning of a line, with the blanks after the closing quote; 0 if the
/// quote is not closed or other text follows.
std::size_t quoted_length(std::string_view line, char separator);

/// Removes quotes and blanks around a cell's text.
Cell cell_of(std::string_view text);

template <class Visit>
void for_each_cell(std::string_view line, char separator, Visit visit) {
  if (separator == kBlanks) line = trimmed(line);
  for (;;) {
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    const bool quote = begin < line.size() && line[begin] == '"', blanks = separator == kBlanks && !quote;
    const std::size_t length = quote ? quoted_length(line.substr(begin), separator) : 0;
    std::size_t end = blanks ? line.find_first_of(" \t", begin) : line.find(separator, begin + length);
    if (length > 0 && begin + length < line.size()) end = begin + length;
    visit(cell_of(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
    if (separator == kBlanks) line = trimmed(line);
  }
}

/// Returns a cell's text in UTF-8; in a quoted cell each doubled quote becomes one. Text that is not UTF-8 is taken as
/// Latin 1, as Excel writes CSV in western Europe.
std::string text_of(const Cell& cell);

/// Returns a name as it is written between commas: in quotes, its own doubled, if it has a comma or a quote.
std::string as_named(const std::string& name);

/// Returns whether a cell means a missing sample: empty, NaN, NA and the like.
bool is_missing(const Cell& cell);

/// Parses the whole of a cell as a double, with a decimal point or, if it is quoted or commas are no separators, a
/// decimal comma; nothing if it is no number. A number too small for a double is 0, a too large one infinite.
std::optional<double> number_of(const Cell& cell, char separator);

/// A decimal number, with or without a minus, a point and an exponent, for which one multiplication or division of two
/// exact doubles gives the nearest double.
struct PlainNumber {
  double value = 0;
  std::size_t length = 0;  ///< characters of the text; 0: no such number
  bool point = false;
};

/// Parses the decimal number at the beginning of a text.
PlainNumber plain_number(std::string_view text);

/// Returns whether a column's name denotes time: t, time, seconds, timestamp, elapsed, zeit, date or datetime, in any
/// case, with or without a unit after it (`t_ms`, `Time (s)`).
bool names_time(std::string_view name);

/// Returns the unit in the name of a time column, s for `seconds`; empty if it has none.
std::string unit_in_time_name(std::string_view name);

/// Returns the unit, in seconds, of a time that counts ms, µs or ns since 1970, between 2001 and 2286; 0 for others.
double unit_since_1970(double time);

/// Returns the seconds per unit (s, ms, us, min, h and their words); nothing for an unknown one.
std::optional<double> seconds_of(std::string_view unit);

/// Returns the seconds since 1970 of a date with or without a time of day, such as 2024-01-31 13:05:00.25,
/// 2024/01/31T13:05Z or 31.01.2024, or since midnight of a time of day alone, in which 05:00.5 are minutes and seconds;
/// nothing for other text. The decimal mark is a point or a comma; AM or PM may follow. `dotted`: 13.05.59 is no date.
std::optional<double> seconds_of_date(std::string_view text, bool dotted = true);

/// Resamples rows of one episode, recorded at `times` in seconds, to an even step: the mean of the steps near the
/// median, rounded by at most 1 %. Interpolates linearly, or repeats the last sample of a channel that moves in steps.
/// rate_note reports the unevenness of the clock and the interpolation error. Gaps of more than 1.5 steps are missing
/// samples. Errors: time does not increase; most steps are far from the median; over 1000 rows would result per row.
Result<Recording> resampled(const Recording& recording, const std::vector<double>& times);

/// Step of time, in the column's unit.
struct TimeStep {
  double step = 0;       ///< between rows
  double tolerance = 0;  ///< largest deviation of an even step: 1 %, or the digits' rounding error up to half a step
};

/// Determines the time step from the first rows, up to the first uneven step. Of all steps that agree with the written
/// digits, selects the one with the fewest digits, as a step or as a rate: 0.033, 0.067, 0.100 give 30 rows per second.
/// Nothing if the second time is not later. `resolution`: see resolution_of(); `seconds`: seconds per unit of time.
/// Precondition: two times or more.
std::optional<TimeStep> step_of(const std::vector<double>& times, double resolution, double seconds);

/// Returns the place value of a number's last digit, 0.001 for 0.033; 0 if the number has an exponent.
double resolution_of(std::string_view number);

}  // namespace wisp::csv
