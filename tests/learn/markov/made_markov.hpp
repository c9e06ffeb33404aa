#pragma once
// Recordings of switched systems of three modes whose coefficients are known, at 20 dB: the shocks' standard deviation
// is a tenth of the output's.

#include <cmath>
#include <random>
#include <vector>

#include "wisp/model/switched.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

struct MadeMode {
  double a, b, c;  // y(t) = a y(t−1) + b u(t−1) + c
};

struct MadeSwitched {
  Recording recording;
  std::vector<int> modes;  // per row; −1 for the first
};

inline ArxOrders first_order() { return {OrderMatrix(1, 1, 1), OrderMatrix(1, 1, 1), OrderMatrix(1, 1, 1)}; }

/// `next` says which mode acts, from the last mode, output and input, and a number drawn from 0 to 1.
template <class Next>
MadeSwitched record_switched(const std::vector<MadeMode>& modes, std::size_t rows, unsigned seed, double sd,
                             Next next) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::vector<double> y(rows), u(rows);
  std::vector<int> acted(rows, -1);
  int mode = 0;
  for (std::size_t t = 0; t < rows; ++t) {
    u[t] = -4 + 8 * uniform(generator);
    if (t == 0) continue;
    acted[t] = mode = next(mode, y[t - 1], u[t - 1], uniform(generator));
    y[t] = modes[mode].a * y[t - 1] + modes[mode].b * u[t - 1] + modes[mode].c + sd * normal(generator);
  }
  Recording recording{.source = "made", .rate_hz = 10};
  recording.channels = {{"u", "", Role::kInput, u}, {"y", "", Role::kOutput, y}};
  return {std::move(recording), std::move(acted)};
}

inline const std::vector<MadeMode> kMadeChain{{0.9, 1, 0}, {-0.5, 2, 1}, {0.2, -1, -1}};

/// A Markov chain that stays in its mode for twenty steps on average.
inline MadeSwitched made_chain(std::size_t rows, unsigned seed) {
  return record_switched(kMadeChain, rows, seed, 0.38, [](int mode, double, double, double chance) {
    return chance < 0.95 ? mode : chance < 0.98 ? (mode + 1) % 3 : (mode + 2) % 3;
  });
}

/// A single mode.
inline MadeSwitched made_linear(std::size_t rows, unsigned seed) {
  return record_switched({{0.7, 0.5, 0}}, rows, seed, 0.2, [](int, double, double, double) { return 0; });
}

}  // namespace wisp
