#include "record/csv_time.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include "record/csv_cells.hpp"
#include "record/number_text.hpp"

namespace wisp::csv {
namespace {

constexpr std::array<std::string_view, 6> kNames = {"t", "time", "seconds", "timestamp", "elapsed", "zeit"};

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

// A name and what follows it in round brackets, or behind an underscore.
std::pair<std::string, std::string> taken_apart(std::string_view name) {
  const std::string text = lower(trimmed(name));
  const std::size_t bracket = text.find('('), line = text.find('_');
  if (bracket != text.npos && text.back() == ')') {
    return {std::string(trimmed(std::string_view(text).substr(0, bracket))),
            text.substr(bracket + 1, text.size() - bracket - 2)};
  }
  if (line != text.npos) return {text.substr(0, line), text.substr(line + 1)};
  return {text, ""};
}

double rounded(double value, int digits) {
  double out = 0;
  const std::string text = number_text(value, digits);
  read_number(text.data(), text.data() + text.size(), out);
  return out;
}

}  // namespace

bool names_time(std::string_view name) {
  const auto [word, unit] = taken_apart(name);
  const bool time = std::find(kNames.begin(), kNames.end(), word) != kNames.end();
  return time && (unit.empty() || name.find('(') != name.npos || seconds_of(unit));
}

std::string unit_in_time_name(std::string_view name) {
  auto [word, unit] = taken_apart(name);
  return unit.empty() && word == "seconds" ? "s" : unit;
}

std::optional<double> seconds_of(std::string_view unit) {
  constexpr std::pair<double, std::array<std::string_view, 5>> kUnits[] = {
      {1, {"s", "sec", "secs", "second", "seconds"}},
      {1e-3, {"ms", "msec", "millis", "milliseconds", "millisecond"}},
      {1e-6, {"us", "\xc2\xb5s", "\xce\xbcs", "usec", "microseconds"}},
      {60, {"min", "mins", "minute", "minutes"}},
      {3600, {"h", "hr", "hour", "hours", "hrs"}}};
  const std::string word = lower(trimmed(unit));
  for (const auto& [seconds, words] : kUnits) {
    if (std::find(words.begin(), words.end(), word) != words.end()) return seconds;
  }
  return std::nullopt;
}

std::optional<TimeStep> step_of(const std::vector<double>& times, double resolution, double seconds) {
  constexpr double kMaxJitter = 0.01;
  const double first = times[1] - times[0];
  if (!(first > 0)) return std::nullopt;
  resolution = std::max(resolution, 1e-12 * std::max(std::abs(times.front()), std::abs(times.back())));
  const auto tolerance = [&](double step) {
    return std::max(kMaxJitter * step, std::min(1.01 * resolution, step / 2));
  };
  std::size_t even = 1;
  while (even + 1 < times.size() && std::abs(times[even + 1] - times[even] - first) <= tolerance(first)) ++even;
  const double rows = static_cast<double>(even), mean = (times[even] - times[0]) / rows;
  TimeStep out{mean, tolerance(mean)};
  for (int digits = 1; digits < 12; ++digits) {
    for (const double step : {rounded(mean, digits), 1 / (seconds * rounded(1 / (seconds * mean), digits))}) {
      if (std::abs(step - mean) * rows > resolution) continue;
      out.step = step;
      return out;
    }
  }
  return out;
}

double resolution_of(std::string_view number) {
  if (number.find_first_of("eEdD") != number.npos) return 0;
  const std::size_t mark = number.find_first_of(".,");
  return mark == number.npos ? 1 : std::pow(10.0, -static_cast<double>(number.size() - mark - 1));
}

}  // namespace wisp::csv
