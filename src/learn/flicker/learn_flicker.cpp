// Markov-switched autoregressions for a light that is calm and restless by turns (J. D. Hamilton, "A new approach to
// the economic analysis of nonstationary time series and the business cycle", Econometrica 57, 1989). Departure: modes
// are inferred from the variation within half a second, since heavy-tailed residuals would make modes of single shocks.
// Least squares underfits such tails, so shocks are scaled until the play varies as much as the recording.

#include "learn/flicker/learn_flicker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "base/statistics.hpp"
#include "learn/arx/learn_arx.hpp"
#include "learn/markov/markov_rows.hpp"
#include "learn/numeric/clustering.hpp"
#include "learn/numeric/spectrum.hpp"
#include "learn/report/report_values.hpp"
#include "record/number_text.hpp"
#include "wisp/run/bank.hpp"

namespace wisp {
namespace flicker {
namespace {

using Traces = std::vector<std::vector<double>>;

constexpr double kMinSeconds = 20, kMaxRadius = 0.995;
constexpr double kHoldout = 0.3;                           // share of every stretch that is held out at its end
constexpr double kBands[] = {0.3, 1, 2, 4, 6, 8, 12, 20};  // Hz

// Standard deviation within half a second, relative to the mean, below which a light counts as calm: a few times the
// eye's threshold.
constexpr double kCalm = 0.02;

// Logarithm of the variation plus 1e-5: smaller variation is the photodiode's noise.
double level(double restless) { return std::log(restless + 1e-5); }

// Number of rows in half a second, at least 4.
std::size_t half_second(double rate_hz) { return static_cast<std::size_t>(std::max(4.0, std::round(rate_hz / 2))); }

// Standard deviation over `window` rows around each row. Precondition: the trace has at least `window` rows.
std::vector<double> restlessness(std::span<const double> trace, std::size_t window) {
  // Subtracting a value of the trace avoids cancellation in the sums.
  const double origin = trace.front();
  std::vector<double> sum{0}, square{0};
  for (const double value : trace) {
    sum.push_back(sum.back() + value - origin);
    square.push_back(square.back() + (value - origin) * (value - origin));
  }
  std::vector<double> out;
  const auto n = static_cast<double>(window);
  for (std::size_t row = 0; row < trace.size(); ++row) {
    const std::size_t begin = std::min(row - std::min(row, window / 2), trace.size() - window);
    const double mean = (sum[begin + window] - sum[begin]) / n;
    out.push_back(std::sqrt(std::max(0.0, (square[begin + window] - square[begin]) / n - mean * mean)));
  }
  return out;
}

struct Figures {
  double mean = 0;
  double sd = 0;
  double calm_share = 0;  // share of consecutive half seconds that are calmer than kCalm
};

Figures figures_of(const Traces& traces, double rate_hz) {
  const std::vector<double> all = joined(traces);
  Figures figures{mean(all), deviation(all)};
  const std::size_t window = half_second(rate_hz);
  double calm = 0, windows = 0;
  for (const auto& trace : traces) {
    if (trace.size() < window) continue;
    const auto restless = restlessness(trace, window);
    for (std::size_t middle = window / 2; middle + window - window / 2 <= trace.size(); middle += window) {
      calm += restless[middle] < kCalm * figures.mean;
      windows += 1;
    }
  }
  figures.calm_share = calm / windows;
  return figures;
}

// k-means centroids of the logarithm of restlessness, calmest first.
std::vector<double> levels_of(const Traces& restless, int modes, std::uint64_t seed) {
  std::vector<double> values = joined(restless);
  for (double& value : values) value = level(value);
  auto levels = k_means(values, 1, {.clusters = modes, .seed = seed})->centroids;
  std::sort(levels.begin(), levels.end());
  return levels;
}

std::vector<int> nearest_levels(std::span<const double> restless, std::span<const double> levels) {
  std::vector<int> out;
  for (const double value : restless) {
    const auto nearer = [own = level(value)](double a, double b) { return std::abs(own - a) < std::abs(own - b); };
    out.push_back(static_cast<int>(std::min_element(levels.begin(), levels.end(), nearer) - levels.begin()));
  }
  return out;
}

struct Light {
  double rate_hz = 0;
  Traces learned, held_out;  // normalised to a mean of 1 over both
};

// Returns the index of the named channel; without a name, of "brightness" or else of the only output.
Result<std::size_t> channel_of(const Recording& recording, const std::string& name) {
  if (const auto found = find_channel(recording, name.empty() ? "brightness" : name)) return *found;
  if (!name.empty()) return Error{recording.source + ": has no channel \"" + name + "\""};
  const auto outputs = channels_with_role(recording, Role::kOutput);
  if (outputs.size() == 1) return outputs.front();
  return Error{recording.source + ": has no channel \"brightness\", and " + std::to_string(outputs.size()) +
               " outputs, expected one; name the one that is light"};
}

// Appends the recording's gap-free stretches, each `every` rows averaged into one.
void add_stretches(const Recording& recording, std::size_t channel, std::size_t every, Traces& traces) {
  const auto& samples = recording.channels[channel].samples;
  for (const Episode& episode : episodes(recording)) {
    const auto own = std::span(samples).subspan(episode.begin, episode.end - episode.begin);
    for (const std::vector<double>& stretch : whole_stretches(own)) {
      std::vector<double> trace;
      for (std::size_t end = every; end <= stretch.size(); end += every) {
        trace.push_back(mean(std::span(stretch).subspan(end - every, every)));
      }
      if (!trace.empty()) traces.push_back(std::move(trace));
    }
  }
}

// Collects all stretches of the recordings at their common rate.
Result<Light> gathered(std::span<const Recording> recordings, const FlickerRecipe& recipe) {
  Light light;
  for (const Recording& recording : recordings) {
    const auto channel = channel_of(recording, recipe.output);
    if (!channel) return channel.error();
    const double every = std::max(1.0, std::round(recording.rate_hz / recipe.rate_hz));
    const double rate = recording.rate_hz / every;
    if (light.rate_hz == 0) light.rate_hz = rate;
    if (std::abs(rate - light.rate_hz) > 1e-3 * rate) {
      return Error{recording.source + ": comes to " + number_text(rate, 6) + " rows a second, the first recording to " +
                   number_text(light.rate_hz, 6) + "; learn from recordings of one rate"};
    }
    add_stretches(recording, *channel, static_cast<std::size_t>(every), light.learned);
  }
  return light;
}

// Holds out the last part of each stretch, with at least half a second on either side of the cut.
void hold_out(Light& light) {
  for (auto& trace : light.learned) {
    const auto kept = static_cast<std::ptrdiff_t>((1 - kHoldout) * static_cast<double>(trace.size()));
    light.held_out.emplace_back(trace.begin() + kept, trace.end());
    trace.resize(static_cast<std::size_t>(kept));
  }
}

Result<Light> light_of(std::span<const Recording> recordings, const FlickerRecipe& recipe) {
  auto light = gathered(recordings, recipe);
  if (!light) return light;
  const double shortest = 4 * static_cast<double>(half_second(light->rate_hz)) + 1;
  std::erase_if(light->learned, [&](const auto& trace) { return static_cast<double>(trace.size()) < shortest; });
  const std::vector<double> all = joined(light->learned);
  const double rows = static_cast<double>(all.size()), middle = mean(all);
  const std::string others = recordings.size() > 1 ? " and " + std::to_string(recordings.size() - 1) + " more" : "";
  const auto wrong = [&](const std::string& what) { return Error{recordings.front().source + others + ": " + what}; };
  if (rows < kMinSeconds * light->rate_hz) {
    return wrong("the light lasts " + number_text(rows / light->rate_hz, 3) + " s in stretches of at least " +
                 number_text(shortest / light->rate_hz, 2) + " s, expected at least 20 s; record for longer");
  }
  if (!(middle > 1e-6 * deviation(all)))
    return wrong("the light is not above 0 on average; is the channel right, and dark at 0?");
  for (auto& trace : light->learned) {
    for (double& value : trace) value /= middle;
  }
  hold_out(*light);
  if (mean(joined(light->held_out)) > 0) return light;
  return wrong("the light is out in the last 30 %, on which the model is judged; leave out the rows after it went out");
}

// Regression of one mode's rows on the rows before them, as deviations from 1; empty where there are too few rows.
std::optional<ArxMode> regress(const markov::Rows& rows, const std::vector<int>& modes, int mode) {
  Eigen::VectorXd weights(rows.rows());
  for (Eigen::Index t = 0; t < rows.rows(); ++t) {
    weights(t) = modes[rows.places[static_cast<std::size_t>(t)].row] == mode ? 1 : 0;
  }
  if (weights.sum() < 4.0 * static_cast<double>(rows.design.groups[0].columns.size())) return {};
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(1);
  markov::Mode found = markov::fit_mode(rows, weights, none);
  markov::limit_radius(kMaxRadius, rows, weights, none, found);
  return markov::model_mode(found, rows);
}

// Quantiles of a mode's shocks in its own rows, divided by their standard deviation.
std::vector<double> quantiles_of(const Light& light, const std::vector<std::vector<int>>& modes, int mode,
                                 const SwitchedArxModel& model) {
  const ArxModel arx = mode_model(model, static_cast<std::size_t>(mode));
  const auto a = arx.a(0, 0);
  std::vector<double> shocks, quantiles;
  for (std::size_t t = 0; t < light.learned.size(); ++t) {
    const auto& trace = light.learned[t];
    for (std::size_t row = a.size(); row < trace.size(); ++row) {
      double shock = trace[row] - 1 - arx.constant[0];
      for (std::size_t lag = 0; lag < a.size(); ++lag) shock += a[lag] * (trace[row - lag - 1] - 1);
      if (modes[t][row] == mode) shocks.push_back(shock);
    }
  }
  for (std::size_t k = 0; k < kShockQuantiles; ++k) {
    const double share = static_cast<double>(k) / (kShockQuantiles - 1);
    quantiles.push_back(quantile(shocks, share) / std::max(1e-12, deviation(shocks)));
  }
  return quantiles;
}

// All traces as one recording, with one episode per trace.
Recording recording_of(const Traces& traces, double rate_hz) {
  Recording recording{.source = "light", .rate_hz = rate_hz, .channels = {{"brightness", "", Role::kOutput, {}}}};
  for (std::size_t k = 0; k < traces.size(); ++k) {
    auto& samples = recording.channels[0].samples;
    samples.insert(samples.end(), traces[k].begin(), traces[k].end());
    recording.episode_ids.resize(samples.size(), static_cast<std::int64_t>(k));
  }
  return recording;
}

// Sets transition and initial probabilities to the frequencies of the observed modes.
void count_transitions(const std::vector<std::vector<int>>& modes, SwitchedArxModel& model) {
  const std::size_t count = model.modes.size();
  std::vector<double> seen(count * count, 0.0), share(count, 0.0);
  for (const auto& trace : modes) {
    for (std::size_t k = 0; k < trace.size(); ++k) {
      share[static_cast<std::size_t>(trace[k])] += 1;
      if (k > 0) seen[static_cast<std::size_t>(trace[k - 1]) * count + static_cast<std::size_t>(trace[k])] += 1;
    }
  }
  double rows = 0;
  for (const double each : share) rows += each;
  for (std::size_t from = 0; from < count; ++from) {
    double sum = 0;
    for (std::size_t to = 0; to < count; ++to) sum += seen[from * count + to];
    for (std::size_t to = 0; to < count; ++to) model.transitions.push_back(seen[from * count + to] / sum);
    model.initial.push_back(share[from] / rows);
  }
}

// Played light, and the mode of each row.
struct Play {
  Traces traces;
  std::vector<std::vector<int>> modes;
};

Play play_of(const Model& model, std::uint64_t seed) {
  constexpr int kInstances = 64;  // enough to determine the play's figures to a few per cent
  constexpr double kSeconds = 150, kSettle = 5;
  auto bank = Bank::create(model, {.capacity = kInstances, .seed = seed});
  Play play{Traces(kInstances), std::vector<std::vector<int>>(kInstances)};
  for (int k = 0; k < kInstances; ++k) bank->spawn();
  std::vector<float> outputs(kInstances);
  for (double t = 0; t < kSeconds * model.rate_hz; t += 1) {
    bank->step();
    bank->outputs(outputs);
    for (std::size_t k = 0; k < kInstances && t >= kSettle * model.rate_hz; ++k) {
      play.traces[k].push_back(outputs[k]);
      play.modes[k].push_back(*bank->mode(bank->at(static_cast<int>(k))));
    }
  }
  return play;
}

// Mean variance within half a second around the rows of each mode.
std::vector<double> variances(const Traces& traces, const std::vector<std::vector<int>>& modes, std::size_t count,
                              double rate_hz) {
  std::vector<double> sum(count, 0.0), rows(count, 0.0);
  for (std::size_t t = 0; t < traces.size(); ++t) {
    const auto restless = restlessness(traces[t], half_second(rate_hz));
    for (std::size_t k = 0; k < restless.size(); ++k) {
      sum[static_cast<std::size_t>(modes[t][k])] += restless[k] * restless[k];
      rows[static_cast<std::size_t>(modes[t][k])] += 1;
    }
  }
  for (std::size_t k = 0; k < count; ++k) sum[k] /= std::max(1.0, rows[k]);
  return sum;
}

void match_shocks(const Light& light, const std::vector<std::vector<int>>& modes, std::uint64_t seed, Model& model) {
  constexpr int kRounds = 10;
  auto& dynamics = std::get<SwitchedArxModel>(model.dynamics);
  const std::size_t count = dynamics.modes.size();
  const auto wanted = variances(light.learned, modes, count, light.rate_hz);
  const Figures whole = figures_of(light.learned, light.rate_hz);
  std::vector<double> fitted;
  for (const ArxMode& mode : dynamics.modes) fitted.push_back(mode.shock[0]);
  for (int round = 0; round < kRounds; ++round) {
    const Play play = play_of(model, seed);
    const auto found = variances(play.traces, play.modes, count, light.rate_hz);
    for (std::size_t k = 0; k < count; ++k) {
      double scale = std::sqrt(wanted[k] / std::max(found[k], 1e-12));
      // The most restless mode dominates the total variance.
      if (k + 1 == count) scale = whole.sd / figures_of(play.traces, light.rate_hz).sd;
      // A calm mode begins while restless motion still decays, which adds to its variance: its shocks are kept within a
      // factor of 2 of the fitted ones.
      const double most = k + 1 == count ? 16 : 2;
      dynamics.modes[k].shock[0] =
          std::clamp(dynamics.modes[k].shock[0] * std::clamp(scale, 0.5, 2.0), fitted[k] / most, fitted[k] * most);
    }
  }
}

Model plain(const Light& light, const FlickerRecipe& recipe, std::span<const Recording> recordings) {
  Model model{.name = recipe.name, .rate_hz = light.rate_hz};
  const std::vector<double> all = joined(light.learned);
  const auto [lowest, highest] = std::minmax_element(all.begin(), all.end());
  model.outputs = {{"brightness", "", std::min(1.0, *lowest), std::max(1.0, *highest)}};
  for (const Recording& recording : recordings) model.training.sources.push_back(recording.source);
  model.training.recipe = {{"modes", std::to_string(recipe.modes)}, {"order", std::to_string(recipe.order)}};
  return model;
}

// Band power of the play relative to the learned and to the held-out part, in decibels.
ReportTable bands_of(const Traces& play, const Light& light) {
  constexpr std::size_t kSegment = 128;
  ReportTable table{"spectrum",
                    "power in bands, play against recording",
                    {{"from", "from", "Hz"},
                     {"to", "to", "Hz"},
                     {"learned_db", "learned part", "dB"},
                     {"held_out_db", "held-out part", "dB"}},
                    {}};
  const auto played = welch(play, light.rate_hz, kSegment);
  const std::array spectra{welch(light.learned, light.rate_hz, kSegment),
                           welch(light.held_out, light.rate_hz, kSegment)};
  for (std::size_t band = 0; band + 1 < std::size(kBands); ++band) {
    const auto power = [&](const Spectrum& spectrum) {
      double sum = 0;
      for (std::size_t k = 0; k < spectrum.power.size(); ++k) {
        const double f = spectrum.frequency_hz[k];
        if (f >= kBands[band] && f < kBands[band + 1]) sum += spectrum.power[k];
      }
      return sum;
    };
    std::vector<ReportValue> row{kBands[band], kBands[band + 1]};
    for (const Spectrum& spectrum : spectra) row.push_back(10 * std::log10(power(played) / power(spectrum)));
    if (kBands[band + 1] <= light.rate_hz / 2) table.rows.push_back(std::move(row));
  }
  return table;
}

void judge(const Light& light, const FlickerRecipe& recipe, Fit& fit) {
  constexpr double kCalmPoints = 0.10, kSdShare = 0.15;
  const Play play = play_of(fit.model, recipe.seed + 1);
  const Figures learned = figures_of(light.learned, light.rate_hz), held = figures_of(light.held_out, light.rate_hz);
  const Figures played = figures_of(play.traces, light.rate_hz);
  ReportSection section{"Light"};
  const auto share = [&](const std::string& of, const Figures& figures, const std::string& words) {
    arx::add(section, of + ".calm_share", figures.calm_share, "calm half seconds, " + words);
    arx::add(section, of + ".sd", figures.sd / figures.mean, "standard deviation, " + words, "of the mean");
    fit.model.training.figures.push_back({of + "_calm_share", figures.calm_share});
    fit.model.training.figures.push_back({of + "_sd", figures.sd / figures.mean});
  };
  share("learned", learned, "learned part");
  share("held_out", held, "held-out part");
  share("played", played, "played");
  section.tables.push_back(bands_of(play.traces, light));
  fit.report.sections.push_back(std::move(section));
  const double calm = std::abs(played.calm_share - held.calm_share);
  const double sd = std::abs(played.sd / played.mean * held.mean / held.sd - 1);
  Usable usable{calm <= kCalmPoints && sd <= kSdShare, {}};
  usable.reason = "plays " + number_text(100 * played.calm_share, 3) + " % of half seconds calm, held out are " +
                  number_text(100 * held.calm_share, 3) + " %; its standard deviation is " +
                  number_text(100 * played.sd / played.mean, 3) + " % of the mean, held out " +
                  number_text(100 * held.sd / held.mean, 3) + " %";
  if (!usable.verdict) usable.reason += "; expected within 10 points and within 15 % of it: record for longer";
  fit.model.training.usable = usable;
  fit.report.verdict = ReportVerdict{usable.verdict, usable.reason};
}

ReportSection modes_section(const SwitchedArxModel& model, double rate_hz) {
  ReportSection section{"Modes"};
  ReportTable table{
      "modes",
      "from calm to restless",
      {{"share", "share of time"}, {"dwell_seconds", "stays", "s"}, {"radius", "spectral radius"}, {"shock", "shock"}},
      {}};
  const std::size_t count = model.modes.size();
  for (std::size_t k = 0; k < count; ++k) {
    const double leaves = 1 - model.transitions[k * count + k];
    table.rows.push_back({model.initial[k], leaves > 0 ? 1 / (leaves * rate_hz) : 0.0,
                          spectral_radius(mode_model(model, k)), model.modes[k].shock[0]});
  }
  section.tables.push_back(std::move(table));
  return section;
}

Result<Fit> fit_light(const Light& light, const FlickerRecipe& recipe, std::span<const Recording> recordings) {
  Traces restless;
  for (const auto& trace : light.learned) restless.push_back(restlessness(trace, half_second(light.rate_hz)));
  const auto levels = levels_of(restless, recipe.modes, recipe.seed);
  std::vector<std::vector<int>> modes;
  std::vector<int> all_modes;
  for (const auto& trace : restless) {
    modes.push_back(nearest_levels(trace, levels));
    all_modes.insert(all_modes.end(), modes.back().begin(), modes.back().end());
  }
  SwitchedArxModel dynamics{
      {OrderMatrix(1, 1, recipe.order), OrderMatrix(1, 0), OrderMatrix(1, 0)}, {1}, {}, {}, {}, {}};
  const Recording together = recording_of(light.learned, light.rate_hz);
  const auto rows = markov::make_rows({&together, 1}, {{}, {"brightness"}}, dynamics.orders, {1});
  if (!rows) return rows.error();
  for (int mode = 0; mode < recipe.modes; ++mode) {
    auto found = regress(*rows, all_modes, mode);
    if (!found) {
      return Error{recordings.front().source + ": the light has no " + std::to_string(recipe.modes) +
                   " degrees of restlessness to distinguish; ask for fewer modes, or record calm and draught"};
    }
    dynamics.modes.push_back(std::move(*found));
  }
  count_transitions(modes, dynamics);
  // Quantiles of the most restless mode, which makes the flares.
  dynamics.shock_quantiles = quantiles_of(light, modes, recipe.modes - 1, dynamics);
  Fit fit{plain(light, recipe, recordings), {}};
  fit.model.dynamics = std::move(dynamics);
  const auto& learned = std::get<SwitchedArxModel>(fit.model.dynamics);
  if (auto bank = Bank::create(fit.model); !bank) return bank.error();
  match_shocks(light, modes, recipe.seed, fit.model);
  fit.report.sections.push_back(modes_section(learned, light.rate_hz));
  return fit;
}

}  // namespace
}  // namespace flicker

Result<Fit> learn_flicker(std::span<const Recording> recordings, const FlickerRecipe& recipe,
                          const Progress& progress) {
  if (auto ok = check_fields(recipe); !ok) return ok.error();
  const auto light = flicker::light_of(recordings, recipe);
  if (!light) return light.error();
  if (auto ok = arx::check_progress(progress, "learning", 0); !ok) return ok.error();
  auto fit = flicker::fit_light(*light, recipe, recordings);
  if (!fit) return fit;
  if (auto ok = arx::check_progress(progress, "judging", 0.9); !ok) return ok.error();
  flicker::judge(*light, recipe, *fit);
  return fit;
}

}  // namespace wisp
