#include "learn/outline/outline_growth.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <numeric>

#include "wisp/learn/prediction.hpp"

namespace wisp {
namespace {

constexpr double kMostGrowth = 30;       // at wind 1: beyond it there is no calm to grow from
constexpr double kLeastGrowth = 0.05;    // below it nobody could tell
constexpr double kMemorySeconds = 0.25;  // of gusts past; shorter and longer ones explain held-out residuals less
constexpr double kFreedom = 5;           // of Student's distribution
constexpr int kReweightings = 8;         // each halves what is left to go, or better
constexpr double kSureBy = 2;            // standard errors of the held-out gain
constexpr double kBlockSeconds = 1;      // neighbouring frames are not independent; blocks of a second nearly are
constexpr std::size_t kLeastBlocks = 5;  // to tell a standard error from

// Residuals of one row and the strength of every input then.
struct Sample {
  std::vector<double> residual;  // per output
  std::vector<double> strength;  // per input, >= 0: its recent mean
  std::size_t block;
};

std::size_t steps_back(double rate_hz) {
  return static_cast<std::size_t>(std::max(1.0, std::round(kMemorySeconds * rate_hz)));
}

// Means over the last steps, NaN where there are not so many in the episode or one is missing.
std::vector<double> recent_means(const std::vector<double>& values, const Recording& recording) {
  const std::size_t steps = steps_back(recording.rate_hz);
  std::vector<double> means(values.size(), std::numeric_limits<double>::quiet_NaN());
  for (const Episode& episode : episodes(recording)) {
    for (std::size_t row = episode.begin + steps; row <= episode.end; ++row) {
      const auto end = values.begin() + static_cast<std::ptrdiff_t>(row);
      means[row - 1] = std::accumulate(end - static_cast<std::ptrdiff_t>(steps), end, 0.0) / static_cast<double>(steps);
    }
  }
  return means;
}

// The recent strength of every input, row by row: its parts of either sign, of which one is 0.
std::vector<std::vector<double>> recent_strengths(const Recording& recording, const PreparedOutlines& prepared) {
  const auto samples = [&](const std::string& name) {
    return recording.channels[*find_channel(recording, name)].samples;
  };
  std::vector<std::vector<double>> out;
  for (const OutlineInput& input : prepared.inputs) {
    std::vector<double> strength = samples(prepared.shape.split_sign ? input.name + "+" : input.name);
    if (prepared.shape.split_sign) {
      const std::vector<double> other = samples(input.name + "-");
      std::transform(strength.begin(), strength.end(), other.begin(), strength.begin(), std::plus<>());
    }
    out.push_back(recent_means(strength, recording));
  }
  return out;
}

std::vector<double> at_row(const std::vector<std::vector<double>>& series, std::size_t row) {
  std::vector<double> out;
  for (const auto& values : series) out.push_back(values[row]);
  return out;
}

Result<std::vector<Sample>> samples_of(const ArxModel& model, std::span<const Recording> recordings,
                                       const PreparedOutlines& prepared) {
  std::vector<Sample> samples;
  std::size_t first_block = 0;
  for (const Recording& recording : recordings) {
    const auto predicted = predict(model, recording, prepared.channels, {.steps = 1});
    if (!predicted) return predicted.error();
    const auto strength = recent_strengths(recording, prepared);
    const double rows_a_block = std::max(1.0, kBlockSeconds * recording.rate_hz);
    for (std::size_t row = 0; row < recording.rows(); ++row) {
      Sample sample{{}, at_row(strength, row), first_block};
      sample.block += static_cast<std::size_t>(static_cast<double>(row) / rows_a_block);
      for (std::size_t i = 0; i < prepared.channels.outputs.size(); ++i) {
        const auto measured = find_channel(recording, prepared.channels.outputs[i]);
        sample.residual.push_back(recording.channels[*measured].samples[row] - (*predicted)[i][row]);
      }
      const auto known = [](double x) { return std::isfinite(x); };
      if (!std::all_of(sample.residual.begin(), sample.residual.end(), known)) continue;
      if (!std::all_of(sample.strength.begin(), sample.strength.end(), known)) continue;
      samples.push_back(std::move(sample));
    }
    first_block += static_cast<std::size_t>(static_cast<double>(recording.rows()) / rows_a_block) + 1;
  }
  return samples;
}

double size_at(const std::vector<double>& growth, const std::vector<double>& strength) {
  return 1 + std::inner_product(growth.begin(), growth.end(), strength.begin(), 0.0);
}

// Residuals that rounding left are no noise.
constexpr double kNothing = 1e-18;

// Student's weight of a squared residual in units of its scale, and twice its negative log-likelihood but for the
// scale.
double weight_of(double square) { return (kFreedom + 1) / (kFreedom + square); }
double tail_of(double square) { return (kFreedom + 1) * std::log1p(square / kFreedom); }

// Every output's squared scale at calm, at its maximum of likelihood for a growth, by reweighting.
std::vector<double> calm_scales(const std::vector<Sample>& samples, const std::vector<double>& growth) {
  std::vector<double> sizes;
  for (const Sample& sample : samples) sizes.push_back(size_at(growth, sample.strength));
  std::vector<double> scales(samples.front().residual.size(), 0.0);
  for (std::size_t i = 0; i < scales.size(); ++i) {
    for (int pass = 0; pass <= kReweightings; ++pass) {
      double sum = 0;
      for (std::size_t t = 0; t < samples.size(); ++t) {
        const double square = samples[t].residual[i] * samples[t].residual[i] / (sizes[t] * sizes[t]);
        sum += scales[i] > kNothing ? square * weight_of(square / scales[i]) : square;
      }
      scales[i] = sum / static_cast<double>(samples.size());
    }
  }
  return scales;
}

// Twice the negative log-likelihood of a sample, up to a constant.
double deviance_of(const Sample& sample, const std::vector<double>& scales, const std::vector<double>& growth) {
  const double size = size_at(growth, sample.strength);
  double sum = 0;
  for (std::size_t i = 0; i < scales.size(); ++i) {
    if (scales[i] < kNothing) continue;
    const double variance = scales[i] * size * size;
    sum += tail_of(sample.residual[i] * sample.residual[i] / variance) + std::log(variance);
  }
  return sum;
}

double deviance(const std::vector<Sample>& samples, const std::vector<double>& growth) {
  const std::vector<double> scales = calm_scales(samples, growth);
  double sum = 0;
  for (const Sample& sample : samples) sum += deviance_of(sample, scales, growth);
  return sum;
}

// The best growth of input k with the others as they are: a grid, then golden sections about its best.
double best_growth(const std::vector<Sample>& samples, std::vector<double> growth, std::size_t k) {
  const auto at = [&](double logarithm) {
    growth[k] = std::expm1(logarithm);
    return deviance(samples, growth);
  };
  constexpr int kGrid = 16;
  const double step = std::log1p(kMostGrowth) / kGrid;
  int best = 0;
  double lowest = at(0);
  for (int g = 1; g <= kGrid; ++g) {
    const double here = at(g * step);
    if (here < lowest) lowest = here, best = g;
  }
  constexpr double kSection = 0.3819660112501051;
  double low = std::max(0, best - 1) * step;
  double high = std::min(kGrid, best + 1) * step;
  for (int pass = 0; pass < 12; ++pass) {
    const double a = low + kSection * (high - low);
    const double b = high - kSection * (high - low);
    if (at(a) < at(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return std::expm1((low + high) / 2);
}

std::vector<double> most_likely(const std::vector<Sample>& samples, std::size_t inputs) {
  std::vector<double> growth(inputs, 0.0);
  const int passes = inputs > 1 ? 5 : 1;
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t k = 0; k < inputs; ++k) growth[k] = best_growth(samples, growth, k);
  }
  return growth;
}

// How much more likely, in nats a row, the held-out residuals are with growth than without: mean and standard error
// over blocks.
void judge(const std::vector<Sample>& learned, const std::vector<Sample>& held_out, OutlineNoiseGrowth& out) {
  const std::vector<double> none(out.per_input.size(), 0.0);
  const std::vector<double> growing = calm_scales(learned, out.per_input);
  const std::vector<double> constant = calm_scales(learned, none);
  std::vector<double> sums(held_out.back().block + 1, 0.0);
  std::vector<double> rows(sums.size(), 0.0);
  for (const Sample& sample : held_out) {
    sums[sample.block] += 0.5 * (deviance_of(sample, constant, none) - deviance_of(sample, growing, out.per_input));
    rows[sample.block] += 1;
  }
  std::vector<double> gains;
  for (std::size_t b = 0; b < sums.size(); ++b) {
    if (rows[b] > 0) gains.push_back(sums[b] / rows[b]);
  }
  if (gains.size() < kLeastBlocks) return;
  const auto n = static_cast<double>(gains.size());
  out.gain = std::accumulate(gains.begin(), gains.end(), 0.0) / n;
  double square = 0;
  for (double gain : gains) square += (gain - out.gain) * (gain - out.gain);
  out.gain_error = std::sqrt(square / (n * (n - 1)));
  out.kept = out.gain > kSureBy * out.gain_error;
}

std::string reason_for(const OutlineNoiseGrowth& growth) {
  if (growth.gain_error == 0) return "too little is held out to tell whether the noise grows with the wind";
  char text[200];
  std::snprintf(text, sizeof text, "%s %.2f times that of calm: held-out residuals are %.2f ± %.2f nats a frame %s",
                growth.kept ? "the noise grows with the wind, at wind 1 it is"
                            : "the noise is the same in any wind, although at wind 1 it might be",
                1 + growth.per_input.front(), std::abs(growth.gain), growth.gain_error,
                growth.gain >= 0 ? "likelier by that" : "less likely by that");
  return text;
}

bool can_grow(const PreparedOutlines& prepared) {
  const auto negative = [](const OutlineInput& input) { return input.lowest < 0; };
  return !prepared.inputs.empty() &&
         (prepared.shape.split_sign || std::none_of(prepared.inputs.begin(), prepared.inputs.end(), negative));
}

}  // namespace

Result<OutlineNoiseGrowth> learn_noise_growth(const ArxModel& model, std::span<const Recording> learned,
                                              std::span<const Recording> held_out, const PreparedOutlines& prepared) {
  OutlineNoiseGrowth out;
  out.reason = "no input that the noise could grow with";
  if (!can_grow(prepared)) return out;
  const auto seen = samples_of(model, learned, prepared);
  if (!seen) return seen.error();
  const auto unseen = samples_of(model, held_out, prepared);
  if (!unseen) return unseen.error();
  if (seen->empty()) return out;
  out.per_input = most_likely(*seen, prepared.inputs.size());
  if (*std::max_element(out.per_input.begin(), out.per_input.end()) < kLeastGrowth) {
    out.reason = "the noise does not grow with the wind";
    return out;
  }
  if (!unseen->empty()) judge(*seen, *unseen, out);
  out.reason = reason_for(out);
  return out;
}

std::vector<double> growth_of_regressors(const OutlineNoiseGrowth& growth, const PreparedOutlines& prepared) {
  std::vector<double> out;
  if (!growth.kept) return out;
  for (double one : growth.per_input) {
    const std::size_t steps = steps_back(prepared.recordings.front().rate_hz);
    const std::size_t taps = steps * (prepared.shape.split_sign ? 2 : 1);
    out.insert(out.end(), taps, one / static_cast<double>(steps));
    if (prepared.shape.square) out.insert(out.end(), taps, 0.0);
  }
  return out;
}

double mean_square_growth(const OutlineNoiseGrowth& growth, std::span<const Recording> recordings,
                          const PreparedOutlines& prepared) {
  double sum = 0;
  double rows = 0;
  for (const Recording& recording : recordings) {
    const auto strength = recent_strengths(recording, prepared);
    for (std::size_t row = 0; row < recording.rows() && growth.kept; ++row) {
      const double size = size_at(growth.per_input, at_row(strength, row));
      if (!std::isfinite(size)) continue;
      sum += size * size;
      ++rows;
    }
  }
  return growth.kept && rows > 0 ? sum / rows : 1;
}

}  // namespace wisp
