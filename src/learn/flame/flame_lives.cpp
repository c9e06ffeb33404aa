#include "learn/flame/flame_lives.hpp"

#include <algorithm>
#include <cmath>

#include "learn/flame/blow_outs.hpp"

namespace wisp {
namespace {

constexpr double kWatchedBefore = 0.5;  // a death counts as the recorded one from so many seconds before that
constexpr double kWatchedAfter = 0.5;   // to so many after: capture loses a dying flame early
constexpr double kAveraged = 0.15;      // seconds
constexpr double kGustShare = 0.5;      // a gust has at least this share of the weakest wind that killed
constexpr double kOneGust = 0.15;       // seconds of calmer wind within a gust

// Rows in which a flame that has gone out is still seen, as a bank shows it: its first step of decay is a row.
std::size_t vanishing_rows(double seconds, double rate_hz) {
  constexpr double kRounding = 1e-9;
  return static_cast<std::size_t>(std::max(0.0, std::ceil(seconds * rate_hz - kRounding) - 1));
}

std::vector<double> strengths(const ExtinctionEvidence& evidence) {
  std::vector<double> out;
  for (double value : evidence.recording->channels[*find_channel(*evidence.recording, evidence.input)].samples) {
    out.push_back(std::isnan(value) ? 0.0 : std::abs(value) / evidence.scale);
  }
  return out;
}

// The strongest mean of `window` successive rows of a span.
double strongest_mean(const WindSpan& span, std::size_t window) {
  double sum = 0, strongest = 0;
  for (std::size_t row = span.begin; row < span.end; ++row) {
    sum += span.wind[row];
    if (row >= span.begin + window) sum -= span.wind[row - window];
    strongest = std::max(strongest, sum / static_cast<double>(window));
  }
  return strongest;
}

}  // namespace

FlameLives::FlameLives(std::span<const ExtinctionEvidence> evidence) {
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

void FlameLives::add_lives(const ExtinctionEvidence& evidence, const std::vector<double>& wind) {
  const double rate_hz = evidence.recording->rate_hz;
  std::size_t begin = 0;
  const auto add = [&](std::size_t end, std::size_t until, bool died) {
    const std::size_t before = rows_of(kWatchedBefore, rate_hz);
    const std::size_t watched = died ? std::max(begin, end - std::min(end, before)) : end;
    lives_.push_back({{wind.data(), begin, end}, rate_hz, died, watched, until});
  };
  const std::size_t vanishing = vanishing_rows(evidence.decay, rate_hz);
  for (const BlowOut& blow_out : evidence.blow_outs) {
    const std::size_t went_out = std::max(begin, blow_out.gone - std::min(blow_out.gone, vanishing));
    const std::size_t after = std::min(blow_out.back, blow_out.gone + rows_of(kWatchedAfter, rate_hz));
    add(blow_out.blown ? went_out : blow_out.gone, blow_out.blown ? after : blow_out.gone, blow_out.blown);
    begin = blow_out.back;
  }
  if (begin < wind.size()) add(wind.size(), wind.size(), false);
}

void FlameLives::find_gusts(FlameLife& life, double least) {
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
  // The killing gust began before it is watched: the flame did not live through it.
  if (life.died && !life.gusts.empty() && life.gusts.back().end + apart > life.watched) life.gusts.pop_back();
  for (const WindSpan& gust : life.gusts) {
    strongest_survived_ = std::max(strongest_survived_, strongest_mean(gust, rows_of(kAveraged, life.rate_hz)));
  }
}

std::size_t FlameLives::deaths() const {
  return static_cast<std::size_t>(
      std::count_if(lives_.begin(), lives_.end(), [](const FlameLife& life) { return life.died; }));
}

std::size_t FlameLives::gusts() const {
  std::size_t count = 0;
  for (const FlameLife& life : lives_) count += life.gusts.size();
  return count;
}

}  // namespace wisp
