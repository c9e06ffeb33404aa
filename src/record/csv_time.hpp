#pragma once
// A column of a table that says when its rows were: how far apart they are, and whether evenly.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::csv {

/// Whether a column's name is one of time's: t, time, seconds, timestamp, in any case, with or without a unit after it
/// (`t_ms`, `Time (s)`).
bool names_time(std::string_view name);

/// The unit in such a name; empty where it has none.
std::string unit_in_time_name(std::string_view name);

/// Seconds of one unit (s, ms, us, min, h and their words); nothing where it is not known.
std::optional<double> seconds_of(std::string_view unit);

/// Seconds of a date with a time of day, such as 2024-01-31 13:05:00.25, 2024/01/31T13:05Z or 31.01.2024 13:05:00, or
/// of a time of day alone, on a scale of their own; nothing where it is none.
std::optional<double> seconds_of_date(std::string_view text);

/// A recording whose rows were at `times`, at even steps of their median by straight lines between samples, or by the
/// last sample where a channel moves in steps; its rate_note says how uneven the clock was and what the straight lines
/// may be wrong by. Gaps of more than 1.5 steps are missing samples. Errors: time goes back, or half of the steps are
/// no usual one.
Result<Recording> resampled(const Recording& recording, const std::vector<double>& times);

/// Steps of time, in the column's unit.
struct TimeStep {
  double step = 0;  ///< between rows
  double tolerance =
      0;  ///< by which one may differ: a hundredth, or what rounding to the written digits does, at most half a step
};

/// How far apart rows are, from the first of them, as long as they are even. The shortest number of rows a second, or
/// of seconds, that the written digits allow: 0.033, 0.067, 0.100 are thirty rows a second. Nothing where time does not
/// go on from the first row to the second. `resolution`: of the last written digit.
///
/// Precondition: two times or more.
std::optional<TimeStep> step_of(const std::vector<double>& times, double resolution, double seconds);

/// What the last written digit of a number is worth; 0 with an exponent.
double resolution_of(std::string_view number);

}  // namespace wisp::csv
