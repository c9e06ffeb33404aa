// A flame that is blown out and lit again, two ways: a rule of extinction with decay and re_ignition as ramps, and
// switched ARX modes over the flame's size, the wind and the tap that lights it, with and without the rule's harm among
// what the regions see.
//
//   wisp_verify_blow_out LEARNED.csv… -- UNSEEN.csv…
//
// The files are captures of clips such as `wisp simulate candle --puffs 5` makes. Prints a table of deaths and gusts
// that each model gets right on the unseen clips, and of how far its sizes are off while a flame dies and catches; exit
// status 1 where the rule misses a bound.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "learn/arx/rows/arx_orders.hpp"
#include "learn/flame/extinction.hpp"
#include "learn/flame/flame_sizes.hpp"
#include "learn/outline/outline_inputs.hpp"
#include "learn/switched/switched_fit.hpp"
#include "learn/switched/switched_prediction.hpp"
#include "studies/verify_bounds.hpp"
#include "wisp/record/csv.hpp"

namespace {

using namespace wisp;

constexpr double kWatched = 0.5;   // seconds either side of where it was gone in which a death counts as that one
constexpr double kSettled = 1;     // seconds after a lighting from which a life is followed
constexpr double kStaysOut = 0.5;  // seconds below half of its size: it is out

struct Clip {
  Recording recording;
  std::vector<BlowOut> blow_outs;
  std::vector<double> sizes;
  double scale = 1;  // of its own microphone: a wind of 1 is the 95th percentile of the wind in which the flame burned
};

const std::vector<double>& wind_of(const Recording& recording) {
  return recording.channels[*find_channel(recording, "wind")].samples;
}

Clip clip_of(const std::string& path) {
  auto recording = read_csv(path);
  if (!recording) {
    std::fprintf(stderr, "%s\n", recording.error().message.c_str());
    std::exit(1);
  }
  Clip clip{*std::move(recording), {}, {}, 1};
  clip.blow_outs = *find_blow_outs(clip.recording, "wind");
  clip.sizes = *flame_sizes(clip.recording, clip.blow_outs);
  const Recording burning = without_blow_outs(clip.recording, clip.blow_outs);
  clip.scale = scaled_input(std::span(&burning, 1), "wind")->scale;
  return clip;
}

std::vector<ExtinctionEvidence> evidence_of(const std::vector<Clip>& clips, double decay) {
  std::vector<ExtinctionEvidence> out;
  for (const Clip& clip : clips) out.push_back({&clip.recording, "wind", clip.scale, clip.blow_outs, decay});
  return out;
}

std::vector<SizeCurve> curves_of(const std::vector<Clip>& clips, SizeChange change) {
  std::vector<SizeCurve> out;
  for (const Clip& clip : clips) {
    for (SizeCurve& curve : size_curves(clip.recording, clip.sizes, clip.blow_outs, change)) out.push_back(curve);
  }
  return out;
}

// Harm of the next row by the rule's definition.
double harmed(const Extinction& rule, double harm, double wind, double rate_hz) {
  const double counted = std::min(wind, Extinction::kMaxWind * rule.level) / rule.level;
  return harm + (counted >= 1 ? (1 + rule.haste * (counted - 1)) / rule.seconds : -1 / rule.recovery) / rate_hz;
}

// What a clip is to switched modes: size from wind, from the tap that lights it and, where asked for, from the harm
// that a rule counts since.
Recording as_switched(const Clip& clip, const Extinction& rule) {
  Recording out{.source = clip.recording.source, .rate_hz = clip.recording.rate_hz};
  Channel wind{"wind", "", Role::kInput, {}}, tap{"tap", "", Role::kInput, {}}, harm{"harm", "", Role::kInput, {}};
  Channel size{"size", "", Role::kOutput, clip.sizes};
  std::vector<std::size_t> lit;
  for (const BlowOut& blow_out : clip.blow_outs) {
    if (blow_out.blown && blow_out.back < clip.recording.rows()) lit.push_back(blow_out.back - 1);
  }
  double done = 0;
  for (std::size_t row = 0; row < clip.recording.rows(); ++row) {
    const bool lights = std::find(lit.begin(), lit.end(), row) != lit.end();
    done = lights     ? 0
           : done < 1 ? std::clamp(harmed(rule, done, wind_of(clip.recording)[row] / clip.scale, out.rate_hz), 0.0, 1.0)
                      : 1;
    wind.samples.push_back(wind_of(clip.recording)[row] / clip.scale);
    harm.samples.push_back(done);
    tap.samples.push_back(lights ? 1 : 0);
  }
  for (const BlowOut& blow_out : clip.blow_outs) {
    const auto at = [](std::vector<double>& samples, std::size_t row) {
      return samples.begin() + static_cast<std::ptrdiff_t>(row);
    };
    if (!blow_out.blown) continue;
    std::fill(at(size.samples, blow_out.gone), at(size.samples, blow_out.back), 0.0);
  }
  out.channels = {std::move(size), std::move(wind), std::move(tap), std::move(harm)};
  return out;
}

// Sizes that a switched model gives to rows [begin, end), from the measured samples before them.
std::vector<double> played(const SwitchedArxModel& model, const Recording& clip, const ChannelChoice& channels,
                           std::size_t begin, std::size_t end) {
  const auto found = predict_switched(model, slice(clip, begin, end), channels, kFreeRun);
  return found ? found->front() : std::vector<double>(end - begin, 1.0);
}

// The first row from which a size stays below a half, or the number of rows.
std::size_t death_in(const std::vector<double>& sizes, double rate_hz) {
  const auto least = static_cast<std::size_t>(kStaysOut * rate_hz);
  std::size_t low = 0;
  for (std::size_t row = 0; row < sizes.size(); ++row) {
    low = sizes[row] < 0.5 ? low + 1 : 0;
    if (low >= least) return row + 1 - low;
  }
  return low > 0 ? sizes.size() - low : sizes.size();
}

struct Tally {
  int died = 0;
  int killed = 0;  // in a gust that was survived
  std::vector<double> late_ms;
};

// One life, begun again a second after each death that was none.
void follow_life(const SwitchedArxModel& model, const Recording& clip, const ChannelChoice& channels, std::size_t begin,
                 const BlowOut* death, Tally& tally) {
  const auto rows = [&](double seconds) { return static_cast<std::size_t>(seconds * clip.rate_hz); };
  const std::size_t end = death ? std::min(death->back, death->gone + rows(kWatched + kStaysOut)) : clip.rows();
  while (begin + rows(kStaysOut) < end) {
    const std::size_t dies = begin + death_in(played(model, clip, channels, begin, end), clip.rate_hz);
    if (dies >= end) return;
    if (death && dies + rows(kWatched) >= death->gone) {
      ++tally.died;
      tally.late_ms.push_back(1000 * (static_cast<double>(dies) - static_cast<double>(death->gone)) / clip.rate_hz);
      return;
    }
    ++tally.killed;
    begin = dies + rows(kSettled);
    if (death && begin + rows(kWatched) > death->gone) return;
  }
}

double rms(const std::vector<double>& errors) {
  double sum = 0;
  for (double error : errors) sum += error * error;
  return errors.empty() ? 0 : std::sqrt(sum / static_cast<double>(errors.size()));
}

// Size errors over the windows of size_curves(), played from a second before them.
double window_error(const SwitchedArxModel& model, const std::vector<Clip>& clips, const std::vector<Recording>& data,
                    const ChannelChoice& channels, SizeChange change) {
  std::vector<double> errors;
  for (std::size_t k = 0; k < clips.size(); ++k) {
    const double rate = data[k].rate_hz;
    const auto rows = [&](double seconds) { return static_cast<std::size_t>(seconds * rate); };
    for (const BlowOut& blow_out : clips[k].blow_outs) {
      if (!blow_out.blown) continue;
      const bool decay = change == SizeChange::kDecay;
      const std::size_t first = decay ? blow_out.gone - rows(0.6) : blow_out.back;
      const std::size_t last = decay ? blow_out.gone : std::min(data[k].rows(), blow_out.back + rows(2));
      if (first >= last || first < rows(0.5)) continue;
      const std::size_t begin = first - rows(0.5);
      const auto sizes = played(model, data[k], channels, begin, last);
      for (std::size_t row = first; row < last; ++row) {
        const double off = sizes[row - begin] - data[k].channels[0].samples[row];
        if (!std::isnan(off)) errors.push_back(std::clamp(off, -2.0, 2.0));
      }
    }
  }
  return rms(errors);
}

double median_size(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

void print_row(const std::string& name, int died, int deaths, int spared, int gusts, double off_ms, double decay,
               double re_ignition, const std::string& verdict) {
  std::printf("%-34s %3d of %-3d %3d of %-3d %6.0f %8.3f %8.3f  %s\n", name.c_str(), died, deaths, spared, gusts,
              off_ms, decay, re_ignition, verdict.c_str());
}

void judge_switched(const std::string& name, const ChannelChoice& channels, int modes,
                    const std::vector<Recording>& seen, const std::vector<Clip>& clips,
                    const std::vector<Recording>& unseen, const ExtinctionAgreement& all) {
  const int inputs = static_cast<int>(channels.inputs.size());
  const ArxOrders orders{OrderMatrix(1, 1, 1), OrderMatrix(1, inputs, 2), OrderMatrix(1, inputs, 0)};
  const auto fit = fit_switched(
      seen, channels, {.orders = orders, .modes = modes, .subtract_means = false, .starts = 6, .max_iterations = 100});
  if (!fit) {
    std::printf("%-34s %s\n", name.c_str(), fit.error().message.c_str());
    return;
  }
  Tally tally;
  for (std::size_t k = 0; k < clips.size(); ++k) {
    std::size_t begin = 0;
    for (const BlowOut& blow_out : clips[k].blow_outs) {
      follow_life(fit->model, unseen[k], channels, begin, blow_out.blown ? &blow_out : nullptr, tally);
      begin = blow_out.back + static_cast<std::size_t>(kSettled * unseen[k].rate_hz);
    }
    if (begin < unseen[k].rows()) follow_life(fit->model, unseen[k], channels, begin, nullptr, tally);
  }
  const int gusts = static_cast<int>(all.gusts);
  print_row(name, tally.died, static_cast<int>(all.deaths), std::max(0, gusts - tally.killed), gusts,
            median_size(tally.late_ms), window_error(fit->model, clips, unseen, channels, SizeChange::kDecay),
            window_error(fit->model, clips, unseen, channels, SizeChange::kReIgnition),
            fit->summary.usable.verdict ? "" : "not usable");
}

}  // namespace

int main(int count, char** words) {
  std::vector<Clip> seen, unseen;
  bool after = false;
  for (int k = 1; k < count; ++k) {
    if (std::string(words[k]) == "--") {
      after = true;
      continue;
    }
    (after ? unseen : seen).push_back(clip_of(words[k]));
  }
  if (seen.empty() || unseen.empty()) {
    std::fprintf(stderr, "usage: wisp_verify_blow_out LEARNED.csv... -- UNSEEN.csv...\n");
    return 2;
  }
  const auto decay = learn_ramp(SizeChange::kDecay, curves_of(seen, SizeChange::kDecay));
  const auto re_ignition = learn_ramp(SizeChange::kReIgnition, curves_of(seen, SizeChange::kReIgnition));
  if (!decay || !re_ignition) {
    std::fprintf(stderr, "the clips to learn from have no death that is lit again\n");
    return 1;
  }
  const auto fit = learn_extinction(evidence_of(seen, decay->seconds));
  if (!fit) {
    std::fprintf(stderr, "%s\n", fit.error().message.c_str());
    return 1;
  }
  const Extinction& rule = fit->rule;
  std::printf(
      "learned from %zu deaths: level %.2f, %.3f s, haste %.1f, recovery %.2f s; decay %.3f s (%.3f to %.3f), "
      "catching %.3f s (%.3f to %.3f)\n\n",
      fit->agreement.deaths, rule.level, rule.seconds, rule.haste, rule.recovery, decay->seconds,
      decay->seconds_ci95[0], decay->seconds_ci95[1], re_ignition->seconds, re_ignition->seconds_ci95[0],
      re_ignition->seconds_ci95[1]);
  std::printf("%-34s %10s %10s %6s %8s %8s\n", "unseen clips", "deaths", "gusts", "off ms", "dying", "catching");
  const auto judged = agreement(rule, evidence_of(unseen, decay->seconds));
  const auto decay_unseen = curves_of(unseen, SizeChange::kDecay),
             re_ignition_unseen = curves_of(unseen, SizeChange::kReIgnition);
  const auto rule_row = [&](const std::string& name, double out, double in) {
    print_row(name, static_cast<int>(judged.died), static_cast<int>(judged.deaths), static_cast<int>(judged.spared),
              static_cast<int>(judged.gusts), 1000 * judged.median_off(),
              ramp_error(SizeChange::kDecay, out, decay_unseen),
              ramp_error(SizeChange::kReIgnition, in, re_ignition_unseen), "");
  };
  rule_row("rule, ramps of the default", Extinction{}.decay, Extinction{}.re_ignition);
  rule_row("rule, ramps learned", decay->seconds, re_ignition->seconds);
  std::vector<Recording> to_learn, to_judge;
  for (const Clip& clip : seen) to_learn.push_back(as_switched(clip, rule));
  for (const Clip& clip : unseen) to_judge.push_back(as_switched(clip, rule));
  for (int modes : {1, 2, 3, 4}) {
    const std::string name = std::to_string(modes) + (modes == 1 ? " mode" : " modes");
    judge_switched(name + ": size, wind, tap", {{"wind", "tap"}, {"size"}}, modes, to_learn, unseen, to_judge, judged);
    judge_switched(name + ": and harm", {{"wind", "tap", "harm"}, {"size"}}, modes, to_learn, unseen, to_judge, judged);
    std::fflush(stdout);
  }
  std::printf("\n");
  verify::Bounds bounds;
  const auto share = [](std::size_t right, std::size_t of) {
    return static_cast<double>(right) / static_cast<double>(of);
  };
  bounds.at_least("share of unseen deaths that the rule gets right", share(judged.died, judged.deaths), 0.9);
  bounds.at_least("share of unseen gusts that it lets the flame come through", share(judged.spared, judged.gusts),
                  0.95);
  bounds.at_most("how far off in time its deaths are, median, s", judged.median_off(), 0.05);
  bounds.at_most("how far a dying flame's size is off", ramp_error(SizeChange::kDecay, decay->seconds, decay_unseen),
                 0.1);
  bounds.at_most("how far a catching flame's size is off",
                 ramp_error(SizeChange::kReIgnition, re_ignition->seconds, re_ignition_unseen), 0.1);
  return bounds.missed() == 0 ? 0 : 1;
}
