// Plain RMS or a power of it: which goes with the wind? From two microphones beside an anemometer, 334 s.
//
// The record holds raw microphone values at about 250 a second, so only its plain RMS a second can be had, not the
// estimator's band; what is tested is the law that turns a level into a wind speed. The anemometer is slow and late.

#include <array>
#include <fstream>
#include <functional>
#include <optional>
#include <random>
#include <sstream>

#include "studies/wind/verify_wind.hpp"

namespace wisp::verify {
namespace {

using Series = std::vector<double>;

constexpr double kSkippedSeconds = 20;  // the microphones settle
constexpr std::size_t kBlock = 20;      // seconds: longer than the wind's memory of about 10 s
constexpr int kResamples = 4000;
constexpr double kExponent = 0.5;  // WindOptions' default

/// Per second: the anemometer's wind and the microphones' RMS about their means.
struct Record {
  Series wind;
  Series first;
  Series second;
  Series both;  ///< root of the mean power
};

double deviation(std::span<const double> values) {
  const double middle = mean(values);
  double sum = 0;
  for (const double x : values) sum += (x - middle) * (x - middle);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

std::optional<Record> read_record(const std::filesystem::path& path) {
  std::ifstream stream(path);
  if (!stream) return std::nullopt;
  std::string line;
  std::getline(stream, line);
  Record record;
  std::array<Series, 3> second;
  std::optional<double> begin;
  long now = 0;
  const auto end_second = [&] {
    if (second[0].size() > 100) {
      record.wind.push_back(mean(second[0]));
      record.first.push_back(deviation(second[1]));
      record.second.push_back(deviation(second[2]));
      record.both.push_back(std::hypot(record.first.back(), record.second.back()) / std::sqrt(2.0));
    }
    for (Series& values : second) values.clear();
  };
  while (std::getline(stream, line)) {
    double milliseconds = 0;
    std::array<double, 5> row{};
    if (std::sscanf(line.c_str(), "%lf %lf,%lf,%lf,%lf,%lf", &milliseconds, &row[0], &row[1], &row[2], &row[3],
                    &row[4]) != 6) {
      continue;
    }
    if (!begin) begin = milliseconds;
    const double seconds = (milliseconds - *begin) / 1000 - kSkippedSeconds;
    if (seconds < 0) continue;
    if (static_cast<long>(seconds) != now) end_second();
    now = static_cast<long>(seconds);
    second[0].push_back(row[0]);
    second[1].push_back(row[3]);
    second[2].push_back(row[4]);
  }
  return record;
}

double correlation(std::span<const double> a, std::span<const double> b) {
  const double ma = mean(a);
  const double mb = mean(b);
  double ab = 0;
  double aa = 0;
  double bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

Series power_of(std::span<const double> values, double exponent) {
  Series out;
  for (const double x : values) out.push_back(std::pow(x, exponent));
  return out;
}

Series logarithm(std::span<const double> values) {
  Series out;
  for (const double x : values) out.push_back(std::log(x));
  return out;
}

/// Pairs of level and wind, the wind so many seconds later.
struct Pairs {
  Series level;
  Series wind;

  std::size_t size() const { return level.size(); }
  Pairs part(std::size_t from, std::size_t to) const {
    return {Series(level.begin() + static_cast<std::ptrdiff_t>(from), level.begin() + static_cast<std::ptrdiff_t>(to)),
            Series(wind.begin() + static_cast<std::ptrdiff_t>(from), wind.begin() + static_cast<std::ptrdiff_t>(to))};
  }
  Pairs half(int which) const { return which == 0 ? part(0, size() / 2) : part(size() / 2, size()); }
};

Pairs paired(const Record& record, const Series& level, std::size_t lag) {
  const std::size_t n = record.wind.size() - lag;
  return {Series(level.begin(), level.begin() + static_cast<std::ptrdiff_t>(n)),
          Series(record.wind.begin() + static_cast<std::ptrdiff_t>(lag), record.wind.end())};
}

/// A moving-block resample: blocks of kBlock seconds from anywhere.
Pairs resample(const Pairs& pairs, std::mt19937_64& random) {
  Pairs out;
  while (out.size() < pairs.size()) {
    const std::size_t from = random() % (pairs.size() - kBlock + 1);
    for (std::size_t i = from; i < from + kBlock && out.size() < pairs.size(); ++i) {
      out.level.push_back(pairs.level[i]);
      out.wind.push_back(pairs.wind[i]);
    }
  }
  return out;
}

struct Estimate {
  double value = 0;
  double low = 0;
  double high = 0;
};

std::string shown(const Estimate& e) {
  char text[64];
  std::snprintf(text, sizeof text, "%5.2f [%5.2f, %5.2f]", e.value, e.low, e.high);
  return text;
}

using Statistic = std::function<double(const Pairs&)>;

Estimate interval(double value, Series& replicas) {
  std::sort(replicas.begin(), replicas.end());
  const auto at = [&](double share) { return replicas[static_cast<std::size_t>(share * (kResamples - 1))]; };
  return {value, at(0.025), at(0.975)};
}

Estimate bootstrap(const Pairs& pairs, const Statistic& statistic) {
  std::mt19937_64 random(1);
  Series replicas;
  for (int i = 0; i < kResamples; ++i) replicas.push_back(statistic(resample(pairs, random)));
  return interval(statistic(pairs), replicas);
}

/// RMS error, m/s, of wind = k · level^exponent on `test`, with k from `calibration`.
double carried_error(const Pairs& calibration, const Pairs& test, double exponent) {
  double uv = 0;
  double vv = 0;
  for (std::size_t i = 0; i < calibration.size(); ++i) {
    const double v = std::pow(calibration.level[i], exponent);
    uv += calibration.wind[i] * v;
    vv += v * v;
  }
  double sum = 0;
  for (std::size_t i = 0; i < test.size(); ++i) {
    const double error = test.wind[i] - uv / vv * std::pow(test.level[i], exponent);
    sum += error * error;
  }
  return std::sqrt(sum / static_cast<double>(test.size()));
}

/// Of carried_error, plain over speed: above 1 the speed measure carries better from one half to the other.
Estimate carried_ratio(const Pairs& pairs, int calibration) {
  const Pairs from = pairs.half(calibration);
  const Pairs to = pairs.half(1 - calibration);
  const auto ratio = [](const Pairs& a, const Pairs& b) {
    return carried_error(a, b, 1) / carried_error(a, b, kExponent);
  };
  std::mt19937_64 random(2);
  Series replicas;
  for (int i = 0; i < kResamples; ++i) {
    const Pairs a = resample(from, random);
    const Pairs b = resample(to, random);
    replicas.push_back(ratio(a, b));
  }
  return interval(ratio(from, to), replicas);
}

/// Exponent of level ∝ wind^q, fitted on logarithms; the line's error lies in the level, the wind, or in both alike.
enum class ErrorIn { kLevel, kWind, kBoth };

double law(const Pairs& pairs, ErrorIn error) {
  const Series u = logarithm(pairs.wind);
  const Series v = logarithm(pairs.level);
  const double r = correlation(u, v);
  const double ratio = deviation(v) / deviation(u);
  return error == ErrorIn::kLevel ? r * ratio : error == ErrorIn::kWind ? ratio / r : ratio;
}

/// Wind per unit of the measure's mean, and the spread about that line, m/s.
struct Line {
  double slope = 0;
  double scatter = 0;
};

Line line(const Pairs& pairs, double exponent) {
  const Series v = power_of(pairs.level, exponent);
  const double r = correlation(v, pairs.wind);
  return {r * deviation(pairs.wind) / deviation(v) * mean(v), deviation(pairs.wind) * std::sqrt(1 - r * r)};
}

void print_parts(const Pairs& pairs, const char* lag) {
  const struct {
    const char* name;
    Pairs pairs;
  } parts[] = {{"whole", pairs}, {"first half", pairs.half(0)}, {"second half", pairs.half(1)}};
  for (const auto& part : parts) {
    for (const double exponent : {1.0, kExponent}) {
      const Estimate r =
          bootstrap(part.pairs, [&](const Pairs& p) { return correlation(power_of(p.level, exponent), p.wind); });
      const Line fit = line(part.pairs, exponent);
      std::printf("  %-12s %-5s %-12s %s  %5.2f   %5.2f\n", part.name, lag, exponent == 1 ? "plain RMS" : "speed",
                  shown(r).c_str(), fit.slope, fit.scatter);
    }
    const Estimate more = bootstrap(part.pairs, [&](const Pairs& p) {
      return correlation(power_of(p.level, kExponent), p.wind) - correlation(p.level, p.wind);
    });
    std::printf("  %-12s %-5s %-12s %s\n", part.name, lag, "difference", shown(more).c_str());
  }
}

std::size_t best_lag(const Record& record, const Series& level) {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t lag = 0; lag <= 12; ++lag) {
    const Pairs pairs = paired(record, level, lag);
    const double r = correlation(power_of(pairs.level, kExponent), pairs.wind);
    if (r > most) best = lag;
    most = std::max(most, r);
  }
  return best;
}

}  // namespace

void anemometer(Bounds& bounds) {
  std::printf("== Wind level against an anemometer\n");
  const std::filesystem::path path = data_folder() / "sound" / "mic_and_anemometer.txt";
  const auto record = read_record(path);
  if (!record) {
    std::printf("  skipped: no %s\n", path.string().c_str());
    return;
  }
  const std::size_t lag = best_lag(*record, record->both);
  std::printf(
      "  %zu s. The anemometer comes %zu s after the microphones (largest correlation; A alone %zu, B alone %zu).\n",
      record->wind.size(), lag, best_lag(*record, record->first), best_lag(*record, record->second));
  std::printf(
      "  Correlations with 95 %% intervals (bootstrap over blocks of 20 s); slope: m/s per mean of the measure;\n"
      "  scatter: standard deviation about the line, m/s. Both microphones, mean power.\n");
  std::printf("  part         lag   measure      correlation            slope   scatter\n");
  print_parts(paired(*record, record->both, 0), "0 s");
  const Pairs pairs = paired(*record, record->both, lag);
  print_parts(pairs, (std::to_string(lag) + " s").c_str());

  std::printf("\n  RMS ~ wind^q on logarithms: error in the RMS alone %s, in the wind alone %s, in both %s\n",
              shown(bootstrap(pairs, [](const Pairs& p) { return law(p, ErrorIn::kLevel); })).c_str(),
              shown(bootstrap(pairs, [](const Pairs& p) { return law(p, ErrorIn::kWind); })).c_str(),
              shown(bootstrap(pairs, [](const Pairs& p) { return law(p, ErrorIn::kBoth); })).c_str());
  std::printf("  wind = k RMS^e, k from one half, error on the other (m/s):\n    e     1st on 2nd   2nd on 1st\n");
  for (const double e : {0.4, 0.5, 0.55, 0.6, 2.0 / 3, 0.8, 1.0}) {
    std::printf("    %.2f  %8.2f  %10.2f\n", e, carried_error(pairs.half(0), pairs.half(1), e),
                carried_error(pairs.half(1), pairs.half(0), e));
  }
  const Estimate up = carried_ratio(pairs, 0);
  const Estimate down = carried_ratio(pairs, 1);
  std::printf("  plain RMS errs so many times more: from the first half %s, from the second %s\n", shown(up).c_str(),
              shown(down).c_str());
  std::printf(
      "  Verdict: by correlation alone the record cannot tell plain RMS from speed (every difference of the whole\n"
      "  record is small); as a measure proportional to wind, carried to another wind, speed is better.\n\n");

  const Pairs now = paired(*record, record->both, 0);
  bounds.at_least("correlation of speed with wind, whole record, no lag",
                  correlation(power_of(now.level, kExponent), now.wind), 0.75);
  bounds.at_least("the same, anemometer's lag taken out", correlation(power_of(pairs.level, kExponent), pairs.wind),
                  0.78);
  bounds.at_least("plain RMS's carried error over speed's, first half to second, low end", up.low, 1);
  bounds.at_least("plain RMS's carried error over speed's, second half to first, low end", down.low, 1);
  const double q = law(pairs, ErrorIn::kBoth);
  bounds.at_most("the default exponent's distance from the record's own", std::abs(kExponent - 1 / q), 0.1);
}

}  // namespace wisp::verify
