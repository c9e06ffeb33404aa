#include "outline_growth.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "wisp/learn/prediction.hpp"

namespace wisp {
namespace {

constexpr double kMostGrowth = 30;       // at wind 1: beyond it there is no calm to grow from
constexpr double kLeastGrowth = 0.05;    // below it nobody could tell
constexpr double kSureBy = 2;            // standard errors of the held-out gain
constexpr double kBlockSeconds = 1;      // neighbouring frames are not independent; blocks of a second nearly are
constexpr std::size_t kLeastBlocks = 5;  // to tell a standard error from

// Residuals of one row and the strength of every input then.
struct Sample {
  std::vector<double> residual;  // per output
  std::vector<double> strength;  // per input, >= 0
  std::size_t block;
};

// An input's strength: its part of either sign, of which one is 0.
std::vector<double> strengths(const Recording& recording, const PreparedOutlines& prepared, std::size_t row) {
  const auto value = [&](const std::string& name) {
    return recording.channels[*find_channel(recording, name)].samples[row];
  };
  std::vector<double> out;
  for (const OutlineInput& input : prepared.inputs) {
    out.push_back(prepared.shape.split_sign ? value(input.name + "+") + value(input.name + "-") : value(input.name));
  }
  return out;
}

Result<std::vector<Sample>> samples_of(const ArxModel& model, std::span<const Recording> recordings,
                                       const PreparedOutlines& prepared) {
  std::vector<Sample> samples;
  std::size_t first_block = 0;
  for (const Recording& recording : recordings) {
    const auto predicted = predict(model, recording, prepared.channels, {.steps = 1});
    if (!predicted) return predicted.error();
    const double rows_a_block = std::max(1.0, kBlockSeconds * recording.rate_hz);
    for (std::size_t row = 0; row < recording.rows(); ++row) {
      Sample sample{{}, strengths(recording, prepared, row), first_block};
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

// Every output's variance at calm, at its maximum of likelihood for a growth; 0 for outputs that leave no residual.
std::vector<double> calm_variances(const std::vector<Sample>& samples, const std::vector<double>& growth) {
  std::vector<double> sums(samples.front().residual.size(), 0.0);
  for (const Sample& sample : samples) {
    const double size = size_at(growth, sample.strength);
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += sample.residual[i] * sample.residual[i] / (size * size);
  }
  for (double& sum : sums) sum /= static_cast<double>(samples.size());
  return sums;
}

// Residuals that rounding left are no noise.
constexpr double kNothing = 1e-18;

// Twice the negative profile log-likelihood a row, up to a constant.
double deviance(const std::vector<Sample>& samples, const std::vector<double>& growth) {
  double sum = 0;
  double outputs = 0;
  for (double variance : calm_variances(samples, growth)) {
    if (variance < kNothing) continue;
    sum += std::log(variance);
    ++outputs;
  }
  double sizes = 0;
  for (const Sample& sample : samples) sizes += std::log(size_at(growth, sample.strength));
  return sum + 2 * outputs * sizes / static_cast<double>(samples.size());
}

// The best growth of input k with the others as they are: a grid, then golden sections about its best.
double best_growth(const std::vector<Sample>& samples, std::vector<double> growth, std::size_t k) {
  const auto at = [&](double logarithm) {
    growth[k] = std::expm1(logarithm);
    return deviance(samples, growth);
  };
  constexpr int kGrid = 24;
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
  for (int pass = 0; pass < 20; ++pass) {
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
  const std::vector<double> growing = calm_variances(learned, out.per_input);
  const std::vector<double> constant = calm_variances(learned, none);
  std::vector<double> sums(held_out.back().block + 1, 0.0);
  std::vector<double> rows(sums.size(), 0.0);
  for (const Sample& sample : held_out) {
    const double size = size_at(out.per_input, sample.strength);
    for (std::size_t i = 0; i < constant.size(); ++i) {
      if (constant[i] < kNothing) continue;
      const double square = sample.residual[i] * sample.residual[i];
      const double variance = growing[i] * size * size;
      sums[sample.block] +=
          0.5 * (square / constant[i] + std::log(constant[i]) - square / variance - std::log(variance));
    }
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
    const std::size_t parts = prepared.shape.split_sign ? 2 : 1;
    out.insert(out.end(), parts, one);
    if (prepared.shape.square) out.insert(out.end(), parts, 0.0);
  }
  return out;
}

double mean_square_growth(const OutlineNoiseGrowth& growth, std::span<const Recording> recordings,
                          const PreparedOutlines& prepared) {
  double sum = 0;
  double rows = 0;
  for (const Recording& recording : recordings) {
    for (std::size_t row = 0; row < recording.rows(); ++row) {
      const double size = size_at(growth.per_input, strengths(recording, prepared, row));
      if (!std::isfinite(size)) continue;
      sum += size * size;
      ++rows;
    }
  }
  return growth.kept && rows > 0 ? sum / rows : 1;
}

}  // namespace wisp
