// Sources: P. Caines and C. Chan, IEEE Trans. Automatic Control 20 (1975), for feedback (the outputs' past predicts the
// input); D. Dickey and W. Fuller, JASA 74 (1979), for the unit-root test (integrators.cpp); L. Ljung, System
// Identification (2nd ed.), sections 13.2 (persistent excitation) and 14 (preprocessing).

#include "wisp/learn/advice.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "base/statistics.hpp"
#include "learn/arx/learn_arx.hpp"
#include "learn/choose/order_search.hpp"
#include "learn/judge/held_out.hpp"
#include "learn/numeric/chi_squared.hpp"
#include "learn/report/report_values.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

using Series = std::vector<double>;

constexpr std::size_t kManyRows = 8192;  // rows used at most by redundant_channels() and to find feedback and delays
constexpr std::size_t kFewRows = 50;
constexpr const char* kRoles[] = {"input", "output", "motion"};  // role names, indexed by Role

// Recordings under inspection, and the names of their inputs and outputs.
struct Subject {
  std::span<const Recording> recordings;
  std::vector<std::string> inputs, outputs;

  const Series* find(const Recording& recording, const std::string& name) const {
    const auto channel = find_channel(recording, name);
    return channel ? &recording.channels[*channel].samples : nullptr;
  }

  // Concatenated samples of one channel over all recordings, less the `first` first and `last` last samples of each.
  Series all_of(const std::string& name, int first = 0, int last = 0) const {
    Series all;
    for (const Recording& one : recordings) {
      const Series* its = find(one, name);
      if (its && std::ssize(*its) > first + last) all.insert(all.end(), its->begin() + first, its->end() - last);
    }
    return all;
  }

  // Text of a row of all_of(name): its number in its recording, from 1, and the recording's name if there are several.
  std::string place_of(const std::string& name, std::size_t row) const {
    for (const Recording& one : recordings) {
      const std::size_t rows = find(one, name) ? one.rows() : 0;
      if (row < rows)
        return std::to_string(one.first_row + row + 1) + (recordings.size() > 1 ? " of " + one.source : "");
      row -= rows;
    }
    return {};
  }

  std::vector<std::string> names() const {
    std::vector<std::string> all = inputs;
    all.insert(all.end(), outputs.begin(), outputs.end());
    return all;
  }
};

// Returns the last decimal place that the first 500 samples use, from 1 to 1e-9; 0 where they use more decimals.
double last_digit(const Series& all) {
  const std::span<const double> some(all.data(), std::min<std::size_t>(500, all.size()));
  double unit = 1, most = 0;
  for (double x : some) most = std::max(most, std::abs(x));
  for (int digits = 0; digits <= 9; ++digits, unit /= 10) {
    const double slack = 1e-4 * std::min(1.0, most / unit);  // samples far below a unit are no multiples of it
    const bool whole = std::all_of(some.begin(), some.end(),
                                   [&](double x) { return std::abs(x / unit - std::round(x / unit)) <= slack; });
    if (whole) return unit;
  }
  return 0;
}

std::size_t distinct(const Series& all, std::size_t most) {
  std::set<double> seen;
  for (double x : all)
    if (seen.insert(x).second && seen.size() > most) break;
  return seen.size();
}

std::string quoted(const std::string& name) { return "'" + name + "'"; }

void look_for_sentinel(const std::string& name, const Series& all, std::vector<Remark>& out) {
  constexpr double kUsual[] = {-999, -9999, -99999, 999, 9999, 99999, -99, -999.9, -99.9, 999.9, 65535, 32767, -32768};
  for (const double value : {*std::min_element(all.begin(), all.end()), *std::max_element(all.begin(), all.end())}) {
    Series rest = all;
    const std::size_t count = std::erase(rest, value);
    if (rest.size() < 20 || distinct(rest, 3) <= 3 || count > rest.size() / 2) continue;
    const auto [low, high] = std::minmax_element(rest.begin(), rest.end());
    const double room = std::max(*low - value, value - *high), range = *high - *low;
    const bool usual = std::find(std::begin(kUsual), std::end(kUsual), value) != std::end(kUsual);
    if (!(room > (usual ? 0.5 : 3) * range) || (!usual && count < 3)) continue;
    out.push_back({RemarkKind::kSentinel, name,
                   quoted(name) + " is " + number_text(value, 6) + " in " + std::to_string(count) +
                       (count == 1 ? " row" : " rows") + ", far from all others (" + number_text(*low, 4) + " to " +
                       number_text(*high, 4) + "): it stands for a missing sample",
                   "leave these cells empty"});
    return;
  }
}

// Indices of samples far from the median of the five samples centred on them.
std::vector<std::size_t> outliers_in(const Series& all) {
  constexpr double kFar = 12;
  std::vector<std::size_t> rows;
  Series apart, values = present(all);
  if (values.size() < 50 || distinct(values, 10) <= 10) return rows;
  for (std::size_t t = 2; t + 2 < all.size(); ++t) {
    Series near = present({all.begin() + std::ptrdiff_t(t) - 2, all.begin() + std::ptrdiff_t(t) + 3});
    apart.push_back(near.size() < 3 || std::isnan(all[t]) ? 0 : std::abs(all[t] - median(near)));
  }
  const double usual = 1.4826 * median(apart), spread = quantile(values, 0.95) - quantile(values, 0.05);
  for (std::size_t k = 0; k < apart.size(); ++k) {
    if (apart[k] > kFar * usual && apart[k] > 0.5 * spread) rows.push_back(k + 2);
  }
  if (rows.size() * 20 > all.size()) rows.clear();  // more than 5 % are no outliers: the channel jumps by nature
  return rows;
}

void look_for_outliers(const Subject& subject, const std::string& name, std::vector<Remark>& out) {
  const auto rows = outliers_in(subject.all_of(name));
  if (rows.empty()) return;
  std::string list;
  for (std::size_t k = 0; k < std::min<std::size_t>(rows.size(), 5); ++k)
    list += (k > 0 ? ", " : "") + subject.place_of(name, rows[k]);
  if (rows.size() > 5) list += ", …";
  out.push_back({RemarkKind::kOutliers, name,
                 quoted(name) + " has " + std::to_string(rows.size()) + (rows.size() == 1 ? " outlier" : " outliers") +
                     " (" + (rows.size() == 1 ? "row " : "rows ") + list + "), far from the samples beside them",
                 "leave these cells empty, they are missing samples then"});
}

void look_at_samples(const Subject& subject, std::vector<Remark>& out) {
  for (const std::string& name : subject.names()) {
    const Series all = subject.all_of(name), there = present(all);
    if (there.empty()) continue;
    if (there.size() * 10 < all.size() * 9) {
      out.push_back({RemarkKind::kMissing, name,
                     number_text(100 - 100.0 * double(there.size()) / double(all.size()), 3) + " % of " + quoted(name) +
                         " is missing, and every row that a missing sample enters is left out",
                     "record it again, or leave the channel out"});
    }
    if (*std::min_element(there.begin(), there.end()) == *std::max_element(there.begin(), there.end())) {
      out.push_back({RemarkKind::kConstant, name, quoted(name) + " never changes", "leave it out"});
      continue;
    }
    look_for_sentinel(name, there, out);
    if (std::find(subject.outputs.begin(), subject.outputs.end(), name) != subject.outputs.end()) {
      look_for_outliers(subject, name, out);
    }
  }
}

// Line y ≈ slope · x + level over rows with both samples; `rest`: RMS of its residual, `size`: deviation of y.
struct Line {
  double slope = 0, level = 0, rest = 0, size = 0;
};

Line line_of(const Series& x, const Series& y) {
  Series a, b;
  for (std::size_t t = 0; t < std::min(x.size(), y.size()); ++t) {
    if (!std::isnan(x[t] + y[t])) a.push_back(x[t]), b.push_back(y[t]);
  }
  if (a.size() < 10) return {};
  const double ma = mean(a), mb = mean(b);
  double aa = 0, ab = 0;
  for (std::size_t t = 0; t < a.size(); ++t) aa += (a[t] - ma) * (a[t] - ma), ab += (a[t] - ma) * (b[t] - mb);
  Line line{aa > 0 ? ab / aa : 0, 0, 0, deviation(b)};
  line.level = mb - line.slope * ma;
  for (std::size_t t = 0; t < a.size(); ++t) line.rest += std::pow(b[t] - line.level - line.slope * a[t], 2);
  line.rest = std::sqrt(line.rest / static_cast<double>(a.size()));
  return line;
}

// Adds a remark where `later` is a linear function of `earlier`, `lag` samples before; returns whether it is.
bool repeats(const Subject& subject, const std::string& later, const std::string& earlier, int lag,
             std::vector<Remark>& out) {
  constexpr double kSame = 1e-5;  // maximum residual RMS / deviation of a repeated channel; covers float rounding
  const Series y = subject.all_of(later, lag), x = subject.all_of(earlier, 0, lag);
  const Line line = line_of(x, y);
  if (!(line.size > 0) || line.slope == 0) return false;
  const double rounding = std::hypot(last_digit(present(y)), line.slope * last_digit(present(x))) / std::sqrt(12.0);
  if (line.rest > std::max(kSame * line.size, std::min(1.5 * rounding, 0.05 * line.size))) return false;
  const std::string scaled = (line.slope == 1 ? "" : number_text(line.slope, 5) + " ") + quoted(earlier);
  const bool level = std::abs(line.level) > 1e-6 * line.size;
  out.push_back({RemarkKind::kRedundant, later,
                 quoted(later) + " is " + scaled +
                     (level ? (line.level < 0 ? " - " : " + ") + number_text(std::abs(line.level), 5) : "") +
                     (lag > 0 ? ", " + std::to_string(lag) + (lag > 1 ? " samples later" : " sample later") : "") +
                     ", within " + number_text(line.rest, 2) + ": it tells nothing new",
                 "leave one of them out"});
  return true;
}

// Finds channels that are linear functions of others; inputs also at lags, where a model would repeat a regressor.
void look_for_redundancy(const Subject& subject, int lags, std::vector<Remark>& out) {
  const auto names = subject.names();
  for (std::size_t l = 1; l < names.size(); ++l) {
    for (std::size_t k = 0; k < l; ++k) {
      bool found = repeats(subject, names[l], names[k], 0, out);
      for (int lag = 1; !found && lag <= lags && l < subject.inputs.size(); ++lag)
        found = repeats(subject, names[l], names[k], lag, out) || repeats(subject, names[k], names[l], lag, out);
      if (found) break;
    }
  }
}

void look_at_excitation(const Subject& subject, std::vector<Remark>& out) {
  constexpr std::size_t kFewMoves = 4;
  constexpr const char* kTimes[kFewMoves] = {"", "once", "twice", "three times"};
  for (const std::string& name : subject.inputs) {
    const Series all = present(subject.all_of(name));
    std::size_t moves = 0;
    for (std::size_t t = 1; t < all.size(); ++t) moves += all[t] != all[t - 1];
    if (all.size() < 40 || moves == 0 || moves >= kFewMoves) continue;
    out.push_back(
        {RemarkKind::kExcitation, name,
         "input " + quoted(name) + " moves only " + kTimes[moves] + ": that shows one response, not how sure it is",
         "record with an input that moves often, at uneven intervals"});
  }
}

// Adds a remark where, in the first recording, an output's past improves the prediction of an input from the input's
// own past.
void look_for_feedback(const Subject& subject, std::vector<Remark>& out) {
  constexpr int kLags = 5;
  constexpr double kShare = 0.05, kChance = 1e-6, kMinRows = 150;
  const Recording& whole = subject.recordings.front();
  const Recording first = slice(whole, 0, std::min(whole.rows(), kManyRows));
  std::vector<LaggedChannel> lags;
  for (int lag = 1; lag <= kLags; ++lag) lags.push_back({1, lag});
  for (const std::string& input : subject.inputs) {
    for (const std::string& output : subject.outputs) {
      const auto effect = arx::effect_of_past({&first, 1}, {{output}, {input}}, {lags});
      if (!effect || effect->rows < kMinRows || !(effect->own > 1e-8 * effect->size)) continue;
      // Rows in which the input does not change carry no information.
      const Series& u = *subject.find(first, input);
      double moves = 0;
      for (std::size_t t = 1; t < u.size(); ++t) moves += std::abs(u[t] - u[t - 1]) > 0;
      moves *= effect->rows / double(u.size());
      if (effect->percent() < 100 * kShare) continue;
      if (moves * std::log(effect->own / effect->both.front()) < chi_squared_quantile(1 - kChance, kLags)) continue;
      out.push_back({RemarkKind::kFeedback, input,
                     "input " + quoted(input) + " is set by " + quoted(output) + " (its past explains " +
                         number_text(effect->percent(), 3) +
                         " % of what the input's own past leaves): a controller closes the loop",
                     "record with the controller off, or with a change of set point that moves the input by itself",
                     effect->percent()});
      break;
    }
  }
}

void look_for_delays(const Subject& subject, std::vector<Remark>& out) {
  constexpr int kLong = 4;
  const ChannelChoice channels{subject.inputs, subject.outputs};
  const auto delays = estimate_delays(arx::middles_of(subject.recordings, kManyRows), channels);
  if (!delays) return;
  for (int i = 0; i < delays->nk.rows(); ++i) {
    for (int k = 0; k < delays->nk.columns(); ++k) {
      if (delays->supported(i, k) == 0 || delays->nk(i, k) < kLong) continue;
      const std::string samples = std::to_string(delays->nk(i, k));
      out.push_back({RemarkKind::kDelay, subject.inputs[std::size_t(k)],
                     quoted(subject.inputs[std::size_t(k)]) + " acts on " + quoted(subject.outputs[std::size_t(i)]) +
                         " after " + samples + " samples (0 to " + std::to_string(delays->most) + " were tried)",
                     "--nk auto, or --nk " + samples, double(delays->nk(i, k))});
    }
  }
}

// The first recording without the output's linear trend; `drift` receives the change of that trend over all rows. Empty
// where the trend is small, an input has a trend too, or there are fewer than 50 rows.
std::optional<Recording> without_drift(const Subject& subject, const std::string& output, double& drift) {
  constexpr double kMuch = 0.6, kLittle = 0.1;  // share of variance by a trend: minimum in outputs, maximum in inputs
  Recording recording = subject.recordings.front();
  Series time(recording.rows());
  for (std::size_t t = 0; t < time.size(); ++t) time[t] = double(t);
  const auto share = [&](const Line& line) { return line.size > 0 ? 1 - std::pow(line.rest / line.size, 2) : 0.0; };
  for (const std::string& name : subject.inputs) {
    const Series* its = subject.find(recording, name);
    if (its && share(line_of(time, *its)) > kLittle) return std::nullopt;
  }
  const auto channel = find_channel(recording, output);
  if (!channel || time.size() < 50) return std::nullopt;
  const Line line = line_of(time, recording.channels[*channel].samples);
  if (share(line) < kMuch) return std::nullopt;
  drift = line.slope * double(time.size());
  for (std::size_t t = 0; t < time.size(); ++t) recording.channels[*channel].samples[t] -= line.slope * time[t];
  return recording;
}

// Adds remarks on outputs that integrate or drift. After detrending, only outputs that integrate have poles at 1.
void look_for_wandering(const Subject& subject, std::vector<Remark>& out) {
  for (const std::string& output : subject.outputs) {
    double drift = 0;
    const auto level = without_drift(subject, output, drift);
    const auto seen = level ? std::span(&*level, 1) : subject.recordings;
    const int count = arx::integrators_in(seen, subject.inputs, output);
    if (count > 0) {
      out.push_back({RemarkKind::kIntegrates, output,
                     quoted(output) + " integrates" + (count > 1 ? " twice" : "") +
                         ": it sums what goes in, and has no level of its own",
                     "--coupling diagonal keeps the integrator in the model"});
    } else if (level) {
      out.push_back(
          {RemarkKind::kDrift, output,
           quoted(output) + " drifts by " + number_text(drift, 3) +
               " from the first row to the last, and no input does",
           "--prepare detrend takes the straight line off; or add a channel that tells what drifts, or learn from a "
           "stretch with --range"});
    }
  }
}

void look_at_table(const Subject& subject, std::vector<Remark>& out) {
  for (const Recording& one : subject.recordings) {
    if (one.rows() < kFewRows) {
      out.push_back({RemarkKind::kShort, "", one.source + ": has only " + std::to_string(one.rows()) + " rows",
                     "record some hundred, or ten for every coefficient"});
    }
    for (const Attribute& attribute : one.attributes) {
      if (attribute.name != kNotNumbers) continue;
      out.push_back({RemarkKind::kText, attribute.value, quoted(attribute.value) + " is not a column of numbers",
                     "correct its cells, or leave it out"});
    }
    if (!one.rate_note.guessed) continue;
    out.push_back({RemarkKind::kClock, "", one.source + ": " + one.rate_note.text,
                   "say --rate HZ or --dt S where that is wrong"});
  }
}

ReportTable channel_table(const Recording& recording, bool roles_are_said) {
  ReportTable table{"channels",
                    "channels",
                    {{"name", "channel"},
                     {"role", "role"},
                     {"unit", "unit"},
                     {"lowest", "lowest"},
                     {"highest", "highest"},
                     {"mean", "mean"},
                     {"deviation", "deviation"},
                     {"missing", "missing"},
                     {"digit", "last digit"}},
                    {}};
  for (const Channel& channel : recording.channels) {
    const Series there = present(channel.samples);
    const char* role = roles_are_said ? kRoles[static_cast<std::size_t>(channel.role)] : "not said";
    auto& row = table.rows.emplace_back(std::vector<ReportValue>{channel.name, role, channel.unit});
    if (there.empty()) {
      row.resize(7);
    } else {
      const auto [low, high] = std::minmax_element(there.begin(), there.end());
      for (double figure : {*low, *high, mean(there), deviation(there)}) row.emplace_back(figure);
    }
    row.emplace_back(channel.samples.size() - there.size());
    const double digit = there.empty() ? 0 : last_digit(there);
    row.push_back(digit > 0 ? ReportValue(digit) : ReportValue());
  }
  return table;
}

}  // namespace

std::vector<Remark> remarks_on(std::span<const Recording> recordings, const std::vector<std::string>& inputs,
                               const std::vector<std::string>& outputs) {
  std::vector<Remark> out;
  if (recordings.empty()) return out;
  const Subject subject{recordings, inputs, outputs};
  look_at_samples(subject, out);
  look_for_redundancy(subject, std::get<int>(ArxRecipe().nb) - 1, out);  // at the lags of the default model
  look_at_table(subject, out);
  const bool spoiled =
      std::any_of(out.begin(), out.end(), [](const Remark& one) { return one.kind <= RemarkKind::kOutliers; });
  if (!inputs.empty() && !outputs.empty() && !spoiled) {
    look_at_excitation(subject, out);
    look_for_feedback(subject, out);
    look_for_delays(subject, out);
    look_for_wandering(subject, out);
  }
  std::stable_sort(out.begin(), out.end(), [](const Remark& a, const Remark& b) { return a.kind < b.kind; });
  return out;
}

std::vector<Remark> redundant_channels(std::span<const Recording> recordings, const std::vector<std::string>& names,
                                       int lags) {
  const std::vector<Recording> some = arx::middles_of(recordings, kManyRows);
  std::vector<Remark> out;
  if (names.size() > 1) look_for_redundancy({some, names, {}}, lags, out);
  return out;
}

std::vector<Remark> feedback_of(std::span<const Recording> recordings, const std::vector<std::string>& inputs,
                                const std::vector<std::string>& outputs) {
  std::vector<Remark> out;
  if (!recordings.empty()) look_for_feedback({recordings, inputs, outputs}, out);
  return out;
}

Report advise(const Recording& recording) {
  std::vector<std::string> inputs, outputs;
  for (const Channel& channel : recording.channels) {
    if (channel.role == Role::kInput) inputs.push_back(channel.name);
    if (channel.role == Role::kOutput) outputs.push_back(channel.name);
  }
  Report report;
  ReportSection& section = report.add("Recording");
  arx::add(section, "rate_hz", recording.rate_hz, "rate", "Hz",
           recording.rate_note.text.empty() ? "as the file or the flags say" : recording.rate_note.text);
  arx::add(section, "rows", recording.rows(), "rows", "",
           number_text(double(recording.rows()) / recording.rate_hz, 5) + " s");
  arx::add(section, "episodes", episodes(recording).size(), "episodes");
  section.tables.push_back(channel_table(recording, !inputs.empty()));
  ReportTable table{"remarks",
                    "what will spoil a model",
                    {{"kind", ""}, {"channel", ""}, {"cause", "what"}, {"cure", "what to do"}},
                    {}};
  for (const Remark& one : remarks_on({&recording, 1}, inputs, outputs)) {
    table.rows.push_back({static_cast<int>(one.kind), one.channel, one.cause, one.cure});
  }
  if (table.rows.empty()) table.label.clear();
  arx::add_line(section, "remarks", table.rows.size(),
                inputs.empty()       ? "of samples and clock; with --inputs and --outputs also of what drives what"
                : table.rows.empty() ? "nothing was found that spoils a model"
                                     : "");
  section.tables.push_back(std::move(table));
  for (const Channel& channel : recording.channels) {
    section.series.push_back({"channel." + arx::as_id(channel.name), channel.name, "time, s", channel.unit,
                              seconds_of(recording), channel.samples});
  }
  return report;
}

}  // namespace wisp
