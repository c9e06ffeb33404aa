#include "films/like_moments.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace wisp::cli {
namespace {

constexpr std::size_t kColumns = 12;

// Another wind makes another flame, however alike the outlines are for a moment.
constexpr double kWindCounts = 4;

// What is compared: the tip's place across and its height over the base, and the inputs. NaN where there is no outline.
using State = std::vector<double>;

State outline_state(const std::vector<std::array<double, 2>>& outline) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (outline.empty()) return {kNone, kNone};
  const auto& tip = outline[outline.size() / 2];
  return {tip[0] - (outline.front()[0] + outline.back()[0]) / 2, (outline.front()[1] + outline.back()[1]) / 2 - tip[1]};
}

std::vector<State> states_of(const Recording& recording, const OutlineRows& rows) {
  std::vector<State> states;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    State& state = states.emplace_back(outline_state(rows[row]));
    for (const Channel& channel : recording.channels) {
      if (channel.role == Role::kInput) state.push_back(row < channel.samples.size() ? channel.samples[row] : 0);
    }
  }
  return states;
}

// One over the variance of each number of a state: what makes them comparable.
std::vector<double> weights_of(const std::vector<State>& states) {
  std::vector<double> weights(states.empty() ? 0 : states[0].size());
  for (std::size_t c = 0; c < weights.size(); ++c) {
    double sum = 0, squares = 0, count = 0;
    for (const State& state : states) {
      if (!std::isfinite(state[c])) continue;
      sum += state[c];
      squares += state[c] * state[c];
      ++count;
    }
    const double variance = count > 0 ? squares / count - sum / count * (sum / count) : 0;
    weights[c] = variance > 0 ? (c < 2 ? 1 : kWindCounts) / variance : 0;
  }
  return weights;
}

double difference(const State& a, const State& b, const std::vector<double>& weights) {
  constexpr double kOneIsOut = 100;
  if (std::isfinite(a[0]) != std::isfinite(b[0])) return kOneIsOut;
  double sum = 0;
  for (std::size_t c = 0; c < weights.size(); ++c) {
    const double between = a[c] - b[c];
    if (std::isfinite(between)) sum += weights[c] * between * between;
  }
  return sum;
}

std::vector<std::size_t> rows_from(std::size_t first, std::size_t apart, std::size_t count) {
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < count; ++k) rows.push_back(first + k * apart);
  return rows;
}

// Where the tip moves most, among stretches with an outline in every row that is shown.
std::size_t liveliest(const std::vector<State>& states, std::size_t apart, std::size_t count) {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t begin = 0; begin + (count - 1) * apart < states.size(); begin += apart) {
    double motion = 0;
    for (std::size_t k = 1; k < count; ++k)
      motion += std::abs(states[begin + k * apart][0] - states[begin + (k - 1) * apart][0]);
    if (motion > most) best = begin, most = motion;  // NaN is not more
  }
  return best;
}

}  // namespace

LikeMoments like_moments(const Recording& recording, const OutlineRows& captured, const OutlineRows& played) {
  const auto apart = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(recording.rate_hz / 8)));
  const std::size_t count = std::min(kColumns, (captured.size() + apart - 1) / apart);
  if (count == 0) return {};
  const auto states = states_of(recording, captured), lived = states_of(recording, played);
  const auto weights = weights_of(states);
  LikeMoments moments{.recorded = rows_from(liveliest(states, apart, count), apart, count), .played = {}};
  std::size_t best = moments.recorded.front();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t begin = 0; begin + (count - 1) * apart < lived.size(); ++begin) {
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k)
      sum += difference(states[moments.recorded[k]], lived[begin + k * apart], weights);
    if (sum < least) best = begin, least = sum;
  }
  moments.played = rows_from(best, apart, count);
  return moments;
}

}  // namespace wisp::cli
