#pragma once
// Time column of a table: the step between its rows, and whether it is constant.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::csv {

/// Returns whether a column's name denotes time: t, time, seconds, timestamp, in any case, with or without a unit after
/// it (`t_ms`, `Time (s)`).
bool names_time(std::string_view name);

/// Returns the unit in such a name; empty if it has none.
std::string unit_in_time_name(std::string_view name);

/// Returns the seconds per unit (s, ms, us, min, h and their words); nothing for an unknown one.
std::optional<double> seconds_of(std::string_view unit);

/// Returns the seconds since 1970 of a date with a time of day, such as 2024-01-31 13:05:00.25, 2024/01/31T13:05Z or
/// 31.01.2024 13:05:00, or since midnight of a time of day alone; nothing for other text.
std::optional<double> seconds_of_date(std::string_view text);

/// Resamples a recording with rows at `times` to even steps of their median by linear interpolation, or by the last
/// sample where a channel moves in steps; rate_note reports the unevenness of the clock and the interpolation error.
/// Gaps of more than 1.5 steps are missing samples. Errors: time decreases, or half of the steps are not typical.
Result<Recording> resampled(const Recording& recording, const std::vector<double>& times);

/// Step of time, in the column's unit.
struct TimeStep {
  double step = 0;       ///< between rows
  double tolerance = 0;  ///< tolerance: a hundredth, or the rounding error of the written digits, at most half a step
};

/// Determines the step of the first rows, as long as they are even: of the steps compatible with the written digits,
/// the one with the shortest number of rows per second, or of seconds: 0.033, 0.067, 0.100 are thirty rows per second.
/// Nothing if time does not increase from the first row to the second. `resolution`: of the last written digit.
///
/// Precondition: two times or more.
std::optional<TimeStep> step_of(const std::vector<double>& times, double resolution, double seconds);

/// Returns the value of the last written digit of a number; 0 with an exponent.
double resolution_of(std::string_view number);

}  // namespace wisp::csv
