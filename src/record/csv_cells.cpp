#include "record/csv_cells.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "base/statistics.hpp"
#include "record/number_text.hpp"

namespace wisp::csv {
namespace {

// Like std::from_chars, but accepts a leading plus and numbers outside a double's range.
std::optional<double> parsed(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, code] = read_number(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if (code == std::errc::result_out_of_range)
    return text.find("e-") != text.npos || text.find("E-") != text.npos ? 0.0 : HUGE_VAL;
  return code == std::errc() ? std::optional(value) : std::nullopt;
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

bool is_utf8(std::string_view text) {
  int left = 0;  // bytes of a character to come
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (((byte & 0xC0) == 0x80) != (left > 0)) return false;
    left = left > 0 ? left - 1 : (byte >= 0xC0) + (byte >= 0xE0) + (byte >= 0xF0);
  }
  return left == 0;
}

}  // namespace

std::size_t quoted_length(std::string_view line, char separator) {
  std::size_t at = 1;
  for (;; at += 2) {
    at = line.find('"', at);
    if (at == std::string_view::npos) return 0;
    if (at + 1 == line.size() || line[at + 1] != '"') break;
  }
  ++at;
  const auto ends = [&](char c) { return c == separator || (separator == kBlanks && c == '\t'); };
  while (at < line.size() && !ends(line[at]) && (line[at] == ' ' || line[at] == '\t' || line[at] == '\r')) ++at;
  return at == line.size() || ends(line[at]) ? at : 0;
}

Cell cell_of(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    return {trimmed(text.substr(1, text.size() - 2)), true};
  }
  return {text, false};
}

std::string text_of(const Cell& cell) {
  std::string text(cell.text);
  for (std::size_t at = text.find("\"\""); cell.quoted && at != text.npos; at = text.find("\"\"", at + 1)) {
    text.erase(at, 1);
  }
  if (is_utf8(text)) return text;
  std::string out;
  for (const char c : text) {
    if ((c & 0x80) != 0) out += static_cast<char>(0xC0 | (c >> 6 & 3));
    out += (c & 0x80) != 0 ? static_cast<char>(c & 0xBF) : c;
  }
  return out;
}

std::string as_named(const std::string& name) {
  if (name.find_first_of(",\"") == std::string::npos) return name;
  std::string out = "\"";
  for (char c : name) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

bool is_missing(const Cell& cell) {
  static constexpr std::array<std::string_view, 10> kWords = {"nan", "na",   "n/a",  "n.a.", "#n/a",
                                                              "#nv", "#n/d", "null", "none", "-nan"};
  if (cell.text.empty()) return true;
  // Most cells are numbers; the words begin with one of these characters, so others are not compared.
  const char first = cell.text.front();
  if (first != 'n' && first != 'N' && first != '#' && first != '-') return false;
  return std::find(kWords.begin(), kWords.end(), lower(cell.text)) != kWords.end();
}

std::optional<double> number_of(const Cell& cell, char separator) {
  if (const auto value = parsed(cell.text)) return value;
  constexpr std::size_t kLongest = 64;
  if (cell.text.size() > kLongest) return std::nullopt;
  std::string text(cell.text);
  const bool comma = separator != ',' || cell.quoted;
  const std::size_t at = text.find(',');
  if (at != text.npos && comma && text.find('.') == text.npos) text[at] = '.';
  // Fortran writes D for the exponent of double precision.
  const std::size_t exponent = text.find_first_of("dD");
  if (exponent != text.npos && exponent > 0) text[exponent] = 'e';
  return text == cell.text ? std::nullopt : parsed(text);
}

PlainNumber plain_number(std::string_view text) {
  // A double holds these powers of ten exactly, and integers up to 2^53.
  static constexpr double kTens[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                     1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  constexpr std::uint64_t kMaxExact = std::uint64_t{1} << 53;
  const char *at = text.data(), *const end = at + text.size();
  const bool minus = at != end && *at == '-';
  at += minus;
  std::uint64_t whole = 0;
  std::ptrdiff_t digits = 0;
  const char* point = nullptr;
  for (; at != end; ++at) {
    const auto digit = static_cast<unsigned>(*at - '0');
    if (digit <= 9) {
      whole = 10 * whole + digit, ++digits;
    } else if (*at == '.' && !point) {
      point = at + 1;
    } else {
      break;
    }
  }
  std::ptrdiff_t power = point ? point - at : 0;
  if (digits == 0 || digits > 18 || whole > kMaxExact) return {};
  if (at != end && (*at == 'e' || *at == 'E')) {
    int exponent = 0;
    const char* const first = at + 1 + (at + 1 != end && at[1] == '+' ? 1 : 0);
    const auto [last, code] = std::from_chars(first, end, exponent);
    if (code != std::errc() || (first == at + 2 && first != end && *first == '-')) return {};
    power += exponent, at = last;
  }
  if (power < -22 || power > 22) return {};
  const double size = static_cast<double>(whole);
  const double value = power < 0 ? size / kTens[-power] : size * kTens[power];
  return {minus ? -value : value, static_cast<std::size_t>(at - text.data()), point != nullptr};
}

namespace {

constexpr std::array<std::string_view, 8> kNames = {"t",       "time", "seconds", "timestamp",
                                                    "elapsed", "zeit", "date",    "datetime"};

// Splits a name, in lower case, into the word and the unit in round brackets or after an underscore.
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

double rounded(double value, int digits) { return parsed(number_text(value, digits)).value_or(0); }

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

double unit_since_1970(double time) {
  for (const double unit : {1e-3, 1e-6, 1e-9})
    if (time * unit >= 1e9 && time * unit < 1e10) return unit;
  return 0;
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

std::optional<double> seconds_of_date(std::string_view text, bool dotted) {
  const std::size_t letter = std::min(text.find_first_of("AaPp"), text.size());
  std::string half = lower(text.substr(letter));
  std::erase_if(half, [](char c) { return c < 'a' || c > 'z'; });  // "p. m."
  if (half == "am" || half == "pm") text = text.substr(0, text.find_last_of("0123456789", letter) + 1);
  std::array<double, 6> part{};  // numbers in written order: three of a date, three of the time of day
  std::array<char, 6> before{};  // the character before each
  std::size_t count = 0;
  const char *at = text.data(), *const end = at + text.size();
  while (at < end && count < part.size()) {
    const auto [rest, code] =
        read_number(at, std::find_if(at, end, [](char c) { return std::isdigit(static_cast<unsigned char>(c)) == 0; }),
                    part[count]);
    if (code != std::errc() || rest == at) return std::nullopt;
    ++count, at = rest;
    if (at == end || *at == 'Z') break;
    const bool mark = *at == '.' || *at == ',', of_day = (count == 2 || count == 3) && before[1] == ':';
    if (mark && (count == part.size() || of_day)) break;
    if ((*at == '+' && count >= 5) || (*at == '-' && count == part.size())) break;  // the zone
    if (std::string_view("-/.: T").find(*at) == std::string_view::npos) return std::nullopt;
    if (count < before.size()) before[count] = *at;
    ++at;
  }
  const bool marked = at < end && (*at == '.' || *at == ',');
  const std::string decimals = marked ? "." + std::string(at + 1, end) : "0";
  double fraction = 0;
  read_number(decimals.data(), decimals.data() + decimals.size(), fraction);
  if (count == 2 && before[1] == ':' && marked) return 60 * part[0] + part[1] + fraction;  // Excel's mm:ss.0
  const bool points = dotted && count == 3 && before[1] == '.' && part[0] < 24 && part[1] < 60 && part[2] < 60;
  const bool clock = points || (count >= 2 && before[1] == ':');
  double& hour = part[clock ? 0 : 3];
  if (half == "pm" && hour < 12) hour += 12;
  if (half == "am" && hour == 12) hour = 0;
  if (clock) return 3600 * part[0] + 60 * part[1] + part[2] + fraction;
  const bool dated =
      count >= 3 && before[1] == before[2] && std::string_view("-/.").find(before[1]) != std::string_view::npos;
  const bool year_first = part[0] > 31;
  if (!dated || (!year_first && before[1] != '.') || (count > 3 && count < 5)) return std::nullopt;
  const double year = year_first ? part[0] : part[2], day = year_first ? part[2] : part[0];
  if (year > 9999 || part[1] > 12 || day > 31) return std::nullopt;
  const auto date = std::chrono::year(static_cast<int>(year)) / static_cast<int>(part[1]) / static_cast<int>(day);
  if (!date.ok()) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return 86400.0 * static_cast<double>(days) + 3600 * part[3] + 60 * part[4] + part[5] + fraction;
}

namespace {

// Estimate of a channel's interpolation error relative to its standard deviation. The error of a point is half the
// second difference times f (1 − f), where f is the distance from the sample before as a share of a step.
class LineError {
 public:
  void add(std::span<const double> samples, std::size_t row, double share) {
    const double y = samples[row];
    if (std::isnan(y)) return;
    sum_ += y, square_ += y * y, ++rows_;
    if (row == 0 || row + 1 >= samples.size()) return;
    const double bend = samples[row + 1] - 2 * y + samples[row - 1];
    if (!std::isnan(bend)) error_ += std::pow(0.5 * bend * share * (1 - share), 2);
  }
  double share() const {
    const double variance = square_ - sum_ * sum_ / std::max(rows_, 1.0);
    return variance > 0 ? std::sqrt(error_ / variance) : 0;
  }

 private:
  double sum_ = 0, square_ = 0, error_ = 0, rows_ = 0;
};

// Returns whether most samples of a channel equal the previous one, as in an input that is set now and then. Linear
// interpolation would give its jumps intermediate values.
bool moves_in_steps(std::span<const double> samples) {
  std::size_t still = 0;
  for (std::size_t t = 1; t < samples.size(); ++t) still += samples[t] == samples[t - 1];
  return 2 * still > samples.size();
}

// Returns a step rounded, itself or its rate, to the fewest digits, up to three, that change it by less than 1 %.
double rounded_step(double step) {
  for (int digits = 1; digits < 4; ++digits) {
    for (const double near : {rounded(step, digits), 1 / rounded(1 / step, digits)}) {
      if (std::abs(near - step) < 0.01 * step) return near;
    }
  }
  return step;
}

}  // namespace

Result<Recording> resampled(const Recording& recording, const std::vector<double>& times) {
  constexpr double kGap = 1.5, kUsual = 0.5;  // in steps: longest interpolated gap; largest deviation of a usual step
  constexpr double kMaxGrowth = 1000;         // maximum number of resulting rows per given row, to bound memory
  constexpr double kRounding = 1e-5;          // in steps: deviation within which two times are equal
  std::vector<double> steps;
  for (std::size_t t = 1; t < times.size(); ++t) {
    steps.push_back(times[t] - times[t - 1]);
    if (!(steps.back() > 0)) {
      return Error{recording.source + ": time does not go on after its row " + std::to_string(t) +
                   " of numbers; sort the rows by time, or say --rate HZ or --dt S"};
    }
  }
  const double middle = median(steps);
  double square = 0, sum = 0, usual = 0;
  for (double step : steps) {
    if (std::abs(step - middle) > kUsual * middle) continue;
    square += (step / middle - 1) * (step / middle - 1), sum += step, ++usual;
  }
  if (usual < 0.5 * static_cast<double>(steps.size()))
    return Error{
        recording.source +
        ": time goes on by steps of no usual length; resample the table to one rate, or say --rate HZ or --dt S"};
  const double step = rounded_step(sum / usual);
  Recording out = slice(recording, 0, 0);
  out.rate_hz = 1 / step;
  const double length = std::floor((times.back() - times.front()) / step + kRounding);
  if (!(length <= kMaxGrowth * static_cast<double>(times.size()))) {
    return Error{recording.source +
                 ": time has gaps of 1000 times as many rows as there are; split the table there, or say --rate HZ or "
                 "--dt S"};
  }
  const auto rows = static_cast<std::size_t>(length) + 1;
  std::vector<LineError> errors(recording.channels.size());
  std::vector<bool> in_steps;
  for (const Channel& channel : recording.channels) in_steps.push_back(moves_in_steps(channel.samples));
  for (std::size_t row = 0, at = 0; row < rows; ++row) {
    const double now = times.front() + static_cast<double>(row) * step;
    while (at + 2 < times.size() && times[at + 1] <= now) ++at;
    const double gap = times[at + 1] - times[at], share = std::clamp((now - times[at]) / gap, 0.0, 1.0);
    const std::size_t nearest = share < 0.5 ? at : at + 1;
    for (std::size_t c = 0; c < out.channels.size(); ++c) {
      const auto& samples = recording.channels[c].samples;
      const bool there = gap <= kGap * step || share < kRounding || share > 1 - kRounding;
      const double past = in_steps[c] && share <= 1 - kRounding ? 0 : share, from = samples[at], to = samples[at + 1];
      const double value = past < kRounding ? from : past > 1 - kRounding ? to : from + past * (to - from);
      out.channels[c].samples.push_back(there ? value : std::numeric_limits<double>::quiet_NaN());
      if (there) errors[c].add(samples, nearest, past);
    }
    for (std::size_t f = 0; f < out.flags.size(); ++f) out.flags[f].rows.push_back(recording.flags[f].rows[nearest]);
  }
  double worst = 0;
  for (const LineError& one : errors) worst = std::max(worst, one.share());
  out.rate_note = {(out.rate_note.guessed ? out.rate_note.text + "; " : "") + "the clock is uneven by " +
                       number_text(100 * std::sqrt(square / usual), 2) +
                       " % of a step: resampled by straight lines, which may be wrong by " +
                       number_text(100 * worst, 2) + " % of a channel's deviation",
                   true};
  return out;
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
  const std::size_t second = number.find('.', number.find('.') + 1);  // points up to it are a date's, as before a colon
  const std::size_t mark = number.find_first_of(".,", std::max(number.find(':') + 1, second + 1));
  return mark == number.npos ? 1 : std::pow(10.0, -static_cast<double>(number.size() - mark - 1));
}

}  // namespace wisp::csv
