#include "learn/flame/extinction.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/statistics.hpp"

namespace wisp {
namespace {

// ---- Lives of flames in recordings, and the gusts that they survived ----

/// Rows [begin, end) of a life, or of a gust, in the samples of one recording.
struct WindSpan {
  const double* wind = nullptr;  ///< strengths in the model's units from the recording's first row on, 0 where missing
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// A flame from its ignition to its extinction or to the recording's end.
struct FlameLife {
  WindSpan rows;  ///< ends at the row where the flame is gone
  double rate_hz = 0;
  bool died = false;
  std::size_t watched = 0;        ///< first row in which an extinction by the rule counts as reproduced
  std::size_t until = 0;          ///< one past the last row in which it counts, which may be after the life
  std::vector<WindSpan> gusts{};  ///< gusts that the flame survived
};

constexpr double kWatchedBefore = 0.5;  // seconds by which a rule's extinction may precede the recorded one
constexpr double kWatchedAfter = 0.5;   // seconds by which a rule may be late: capture loses a decaying flame early
constexpr double kAveraged = 0.15;      // seconds over which wind is averaged
constexpr double kGustShare = 0.5;      // least wind of a gust, as a share of the weakest extinguishing wind
constexpr double kOneGust = 0.15;       // seconds: shorter lulls do not divide a gust

std::vector<double> strengths(const ExtinctionEvidence& evidence) {
  std::vector<double> out;
  for (double value : evidence.recording->channels[*find_channel(*evidence.recording, evidence.input)].samples) {
    out.push_back(std::isnan(value) ? 0.0 : std::abs(value) / evidence.scale);
  }
  return out;
}

// Maximum mean over `window` successive rows of a span.
double strongest_mean(const WindSpan& span, std::size_t window) {
  double sum = 0, strongest = 0;
  for (std::size_t row = span.begin; row < span.end; ++row) {
    sum += span.wind[row];
    if (row >= span.begin + window) sum -= span.wind[row - window];
    strongest = std::max(strongest, sum / static_cast<double>(window));
  }
  return strongest;
}

class FlameLives {
 public:
  explicit FlameLives(std::span<const ExtinctionEvidence> evidence) {
    double strongest = 0;
    for (const ExtinctionEvidence& each : evidence) {
      winds_.push_back(strengths(each));
      strongest = std::max(strongest, *std::max_element(winds_.back().begin(), winds_.back().end()));
      for (const BlowOut& blow_out : each.blow_outs) {
        if (!blow_out.blown) continue;
        const double wind = blow_out.wind / each.scale;
        weakest_death_ = weakest_death_ == 0 ? wind : std::min(weakest_death_, wind);
      }
    }
    for (std::size_t k = 0; k < evidence.size(); ++k) add_lives(evidence[k], winds_[k]);
    const double least = kGustShare * (weakest_death_ > 0 ? weakest_death_ : strongest);
    for (FlameLife& life : lives_) find_gusts(life, least);
  }

  const std::vector<FlameLife>& lives() const { return lives_; }
  double weakest_death() const { return weakest_death_; }            ///< averaged wind; 0 where no flame was blown out
  double strongest_survived() const { return strongest_survived_; }  ///< averaged wind; 0 where there was no gust

  std::size_t deaths() const {
    return static_cast<std::size_t>(
        std::count_if(lives_.begin(), lives_.end(), [](const FlameLife& life) { return life.died; }));
  }
  std::size_t gusts() const {
    std::size_t count = 0;
    for (const FlameLife& life : lives_) count += life.gusts.size();
    return count;
  }

 private:
  void add_lives(const ExtinctionEvidence& evidence, const std::vector<double>& wind) {
    const double rate_hz = evidence.recording->rate_hz;
    std::size_t begin = 0;
    const auto add = [&](std::size_t end, std::size_t until, bool died) {
      const std::size_t before = rows_of(kWatchedBefore, rate_hz);
      const std::size_t watched = died ? std::max(begin, end - std::min(end, before)) : end;
      lives_.push_back({{wind.data(), begin, end}, rate_hz, died, watched, until});
    };
    const auto vanishing = static_cast<std::size_t>(std::lround(evidence.vanishing * rate_hz));
    for (const BlowOut& blow_out : evidence.blow_outs) {
      const std::size_t went_out = std::max(begin, blow_out.gone - std::min(blow_out.gone, vanishing));
      const std::size_t after = std::min(blow_out.back, blow_out.gone + rows_of(kWatchedAfter, rate_hz));
      add(blow_out.blown ? went_out : blow_out.gone, blow_out.blown ? after : blow_out.gone, blow_out.blown);
      begin = blow_out.back;
    }
    if (begin < wind.size()) add(wind.size(), wind.size(), false);
  }

  void find_gusts(FlameLife& life, double least) {
    const std::size_t apart = rows_of(kOneGust, life.rate_hz);
    const std::size_t end = life.died ? life.watched : life.rows.end;
    for (std::size_t row = life.rows.begin; row < end; ++row) {
      if (!(least > 0) || life.rows.wind[row] < least) continue;
      if (!life.gusts.empty() && row < life.gusts.back().end + apart) {
        life.gusts.back().end = row + 1;
      } else {
        life.gusts.push_back({life.rows.wind, row, row + 1});
      }
    }
    // The extinguishing gust begins before the watched rows; it was not survived.
    if (life.died && !life.gusts.empty() && life.gusts.back().end + apart > life.watched) life.gusts.pop_back();
    for (const WindSpan& gust : life.gusts) {
      strongest_survived_ = std::max(strongest_survived_, strongest_mean(gust, rows_of(kAveraged, life.rate_hz)));
    }
  }

  std::vector<std::vector<double>> winds_;
  std::vector<FlameLife> lives_;
  double weakest_death_ = 0;
  double strongest_survived_ = 0;
};

// Search grid. Steps of 5 % (level) and 15 % (duration) are finer than recordings resolve.
constexpr int kLevels = 40;
constexpr int kDurations = 40;
constexpr double kShortest = 0.02;  // seconds, shortest duration tried
constexpr double kLongest = 4;      // seconds, longest duration tried
constexpr double kHastes[] = {0, 0.5, 1, 2, 3, 5, 8};
constexpr double kRecoveries[] = {0.25, 0.5, 0.7, 1, 2};  // decrease of harm per second below the level

// Costs: 1 per survived gust that extinguishes, 1 per extinction missed, min(1, 0.3 (t / 0.1 s)²) per time error t.
constexpr double kOff = 0.1;
constexpr double kOffCost = 0.3;
// Rules are equally good if they cost at most kAsWell more than the best one, plus kAsWellEach per gust and extinction:
// the grid does not contain the true rule, and no sensor measures the true wind.
constexpr double kAsWell = 0.25;
constexpr double kAsWellEach = 0.02;

// A rule without its duration. Harm is accumulated exposure, in seconds of wind at the level.
struct Shape {
  double level = 1;
  double haste = 0;
  double recovery = 1;

  double next(double harm, double wind, double step) const {
    if (wind < level) return std::max(0.0, harm - recovery * step);
    return harm + step * (1 + haste * (std::min(wind, Extinction::kMaxWind * level) / level - 1));
  }
};

// Harm accumulated under a shape in the recordings, before a duration is chosen.
struct Harms {
  std::vector<double> gusts;                // maximum harm in each gust that was survived
  std::vector<std::vector<double>> deaths;  // harm per watched row of each extinction
  std::vector<double> first;                // for each extinction: recorded time, seconds after the first watched row
  std::vector<double> step;                 // for each extinction: seconds per row
};

Harms harms_of(const Shape& shape, const FlameLives& lives) {
  Harms out;
  for (const FlameLife& life : lives.lives()) {
    const double step = 1 / life.rate_hz;
    double harm = 0;
    std::size_t gust = 0;
    std::vector<double> watched;
    const std::size_t end = life.died ? life.until : life.rows.end;
    std::vector<double> most(life.gusts.size(), 0.0);
    for (std::size_t row = life.rows.begin; row < end; ++row) {
      harm = shape.next(harm, life.rows.wind[row], step);
      while (gust < most.size() && row >= life.gusts[gust].end) ++gust;
      if (gust < most.size() && row >= life.gusts[gust].begin) most[gust] = std::max(most[gust], harm);
      if (life.died && row >= life.watched) watched.push_back(harm);
    }
    out.gusts.insert(out.gusts.end(), most.begin(), most.end());
    if (!life.died) continue;
    out.deaths.push_back(std::move(watched));
    out.first.push_back(static_cast<double>(life.rows.end - life.watched) * step);
    out.step.push_back(step);
  }
  std::sort(out.gusts.begin(), out.gusts.end());
  return out;
}

double cost_of(const Harms& harms, double seconds) {
  const auto killed = harms.gusts.end() - std::lower_bound(harms.gusts.begin(), harms.gusts.end(), seconds);
  double cost = static_cast<double>(killed);
  for (std::size_t k = 0; k < harms.deaths.size(); ++k) {
    const auto& harm = harms.deaths[k];
    const auto dies = std::find_if(harm.begin(), harm.end(), [&](double value) { return value >= seconds; });
    if (dies == harm.end()) {
      cost += 1;
      continue;
    }
    // An extinction is visible one row after the harm reached the duration.
    const double late = static_cast<double>(dies - harm.begin() + 1) * harms.step[k] - harms.first[k];
    cost += std::min(1.0, kOffCost * (late / kOff) * (late / kOff));
  }
  return cost;
}

// Returns a weak prior's penalty of a rule, small against the cost of one error.
double remarkable(const Shape& shape, double middle) {
  const Extinction usual;
  const auto square = [](double x) { return x * x; };
  return 0.03 * square(std::log((1 + shape.haste) / (1 + usual.haste))) +
         0.03 * square(std::log(shape.recovery * usual.recovery / usual.seconds)) +
         0.05 * square(std::log(shape.level / middle));
}

struct Trial {
  Shape shape;
  double seconds = 0;
  double cost = 0;  // cost of errors
  double remarkable = 0;
};

std::vector<double> steps_between(double low, double high, int count) {
  std::vector<double> out(count);
  for (int k = 0; k < count; ++k) out[k] = low * std::pow(high / low, static_cast<double>(k) / (count - 1));
  return out;
}

std::vector<Trial> trials_of(const FlameLives& lives) {
  const double weakest = lives.weakest_death();
  const double survived = std::clamp(lives.strongest_survived(), 0.25 * weakest, weakest);
  const double middle = std::sqrt(survived * weakest);
  const auto durations = steps_between(kShortest, kLongest, kDurations);
  std::vector<Trial> trials;
  for (double level : steps_between(0.25 * weakest, 1.5 * weakest, kLevels)) {
    for (double haste : kHastes) {
      for (double recovery : kRecoveries) {
        const Shape shape{level, haste, recovery};
        const Harms harms = harms_of(shape, lives);
        const double against = remarkable(shape, middle);
        for (double seconds : durations) trials.push_back({shape, seconds, cost_of(harms, seconds), against});
      }
    }
  }
  return trials;
}

Extinction rule_of(const Trial& trial) {
  Extinction rule;
  rule.level = trial.shape.level;
  rule.seconds = trial.seconds;
  rule.haste = trial.shape.haste;
  rule.recovery = trial.seconds / trial.shape.recovery;
  return rule;
}

// Returns the harm after one more row under a complete rule, as a share of the harm that extinguishes.
double harmed(const Extinction& rule, double harm, double wind, double step) {
  const Shape shape{rule.level, rule.haste, rule.seconds / rule.recovery};
  constexpr double kMaxHarm = 0.5;  // maximum harm per step, as in Bank
  return std::min(shape.next(harm * rule.seconds, wind, step) / rule.seconds, harm + kMaxHarm);
}

void follow(const Extinction& rule, const FlameLife& life, ExtinctionAgreement& out) {
  const double step = 1 / life.rate_hz;
  std::vector<bool> killed(life.gusts.size(), false);
  std::size_t gust = 0;
  bool died = false;
  double harm = 0;
  for (std::size_t row = life.rows.begin; row < (life.died ? life.until : life.rows.end) && !died; ++row) {
    harm = harmed(rule, harm, life.rows.wind[row], step);
    while (gust < killed.size() && row >= life.gusts[gust].end) ++gust;
    if (harm < 1) continue;
    died = life.died && row >= life.watched;
    if (died) {
      const double now = static_cast<double>(row) + 1;  // an extinction is visible one row after harm reached 1
      out.late_seconds.push_back((now - static_cast<double>(life.rows.end)) * step);
    } else if (gust < killed.size() && row >= life.gusts[gust].begin) {
      killed[gust] = true;
      harm = 0;
    } else {
      harm = 1;  // a flame extinguished by the rise of a gust does not survive the gust
    }
  }
  out.died += died ? 1 : 0;
  out.spared += static_cast<std::size_t>(std::count(killed.begin(), killed.end(), false));
}

}  // namespace

double ExtinctionAgreement::median_off() const {
  std::vector<double> off;
  for (double late : late_seconds) off.push_back(std::abs(late));
  return median(std::move(off));
}

ExtinctionAgreement agreement(const Extinction& rule, std::span<const ExtinctionEvidence> evidence) {
  const FlameLives lives(evidence);
  ExtinctionAgreement out;
  out.deaths = lives.deaths();
  out.gusts = lives.gusts();
  out.strongest_survived = lives.strongest_survived();
  for (const FlameLife& life : lives.lives()) follow(rule, life, out);
  return out;
}

Result<ExtinctionFit> learn_extinction(std::span<const ExtinctionEvidence> evidence) {
  const FlameLives lives(evidence);
  if (lives.deaths() == 0) return Error{"no flame was blown out in the recordings; give the level and the seconds"};
  const std::vector<Trial> trials = trials_of(lives);
  const Trial& best = *std::min_element(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) {
    return a.cost + a.remarkable < b.cost + b.remarkable;
  });
  ExtinctionFit fit;
  fit.rule = rule_of(best);
  fit.level_range = {std::numeric_limits<double>::infinity(), 0};
  const double as_well = best.cost + kAsWell + kAsWellEach * static_cast<double>(lives.deaths() + lives.gusts());
  for (const Trial& trial : trials) {
    if (trial.cost > as_well) continue;
    fit.level_range = {std::min(fit.level_range[0], trial.shape.level),
                       std::max(fit.level_range[1], trial.shape.level)};
  }
  fit.agreement = agreement(fit.rule, evidence);
  if (2 * fit.agreement.died <= fit.agreement.deaths) {
    return Error{"wind does not explain when the flame was extinguished: the best rule reproduces " +
                 std::to_string(fit.agreement.died) + " of " + std::to_string(fit.agreement.deaths) +
                 " deaths; give the level and the seconds"};
  }
  return fit;
}

Extinction extinction_beyond(std::span<const ExtinctionEvidence> evidence) {
  constexpr double kRaised = 1.05;
  constexpr double kToSpare = 1.25;
  constexpr int kMaxSteps = 200;  // limits the level to about 20,000 times the default
  Extinction rule;
  const FlameLives lives(evidence);
  for (int k = 0; k < kMaxSteps; ++k) {
    ExtinctionAgreement found;
    for (const FlameLife& life : lives.lives()) follow(rule, life, found);
    if (found.spared == lives.gusts()) {
      if (k > 0) rule.level *= kToSpare;
      break;
    }
    rule.level *= kRaised;
  }
  return rule;
}

}  // namespace wisp
