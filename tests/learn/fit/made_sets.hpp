#pragma once
// The recordings of tools/arx_reference.py, made of whole numbers and a recursion, so that both make the same ones.

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "wisp/record/recording.hpp"

namespace wisp::made {

/// A linear congruence modulo 2^32; the upper 24 bits of a word are a number in [−0.5, 0.5).
class Words {
 public:
  explicit Words(std::uint32_t seed) : word_(seed) {}
  double uniform() {
    word_ = 1664525 * word_ + 1013904223;
    return (word_ >> 8) / 16777216.0 - 0.5;
  }
  double normal() {
    double total = 0;
    for (int k = 0; k < 12; ++k) total += uniform();
    return total;
  }

 private:
  std::uint32_t word_;
};

/// An output: A[j] from lag 1 on in the equation's own sign, B[k] from lag `delay` on, its shock, and where its numbers
/// lie.
struct SetOutput {
  std::vector<std::vector<double>> a, b;
  std::size_t delay = 1;
  double shock = 0, mean = 0, unit = 1;
};

struct Set {
  std::size_t rows = 0;
  std::uint32_t seed = 0;
  std::size_t inputs = 1;
  bool binary = false;      ///< inputs jump between two values; else they are white
  std::size_t missing = 0;  ///< every so many rows the first output has no sample; 0: never
  std::vector<SetOutput> outputs;
};

inline const std::map<std::string, Set>& sets() {
  static const std::map<std::string, Set> table{
      {"dryer", {1000, 11, 1, true, 0, {{{{-1.274, 0.3935}}, {{0.0666, 0.0445}}, 3, 0.04, 4.9, 1}}}},
      {"resonant",
       {2000, 12, 1, false, 0, {{{{-3.80, 5.51, -3.61, 0.9025}}, {{0.01, 0.02, -0.01, 0.005}}, 1, 0.002, 0, 1}}}},
      {"coupled",
       {1500,
        13,
        2,
        false,
        0,
        {{{{-1.3, 0.6}, {0.2, 0.0}}, {{0.5, 0.25}, {-0.4, 0.1}}, 1, 0.3, 10, 1},
         {{{0.1, 0.05}, {-0.9, 0.3}}, {{0.7, -0.2}, {0.3, 0.6}}, 1, 0.2, -3, 1}}}},
      {"holes", {1200, 14, 1, false, 97, {{{{-0.8, 0.1}}, {{0.9, 0.3}}, 0, 0.5, 1000, 1e6}}}},
  };
  return table;
}

/// The recording: inputs u1 …, outputs y1 ….
inline Recording recording_of(const Set& set) {
  const std::size_t ny = set.outputs.size(), nu = set.inputs;
  Recording recording{.source = "made", .rate_hz = 1};
  for (std::size_t c = 0; c < nu + ny; ++c) {
    recording.channels.push_back({c < nu ? "u" + std::to_string(c + 1) : "y" + std::to_string(c - nu + 1), "",
                                  c < nu ? Role::kInput : Role::kOutput, std::vector<double>(set.rows)});
  }
  Words words(set.seed);
  std::vector<std::vector<double>> x(set.rows, std::vector<double>(ny));
  for (std::size_t t = 0; t < set.rows; ++t) {
    for (std::size_t k = 0; k < nu; ++k) {
      auto& u = recording.channels[k].samples;
      u[t] = words.uniform();
      if (set.binary) u[t] = t > 0 && u[t] < 0.25 ? u[t - 1] : words.uniform() < 0 ? 1 : -1;  // three times in four
    }
    for (std::size_t i = 0; i < ny; ++i) {
      const SetOutput& row = set.outputs[i];
      double value = row.shock * words.normal();
      for (std::size_t j = 0; j < ny; ++j) {
        for (std::size_t l = 0; l < row.a[j].size() && l + 1 <= t; ++l) value -= row.a[j][l] * x[t - l - 1][j];
      }
      for (std::size_t k = 0; k < nu; ++k) {
        const auto& u = recording.channels[k].samples;
        for (std::size_t l = 0; l < row.b[k].size() && l + row.delay <= t; ++l)
          value += row.b[k][l] * u[t - l - row.delay];
      }
      x[t][i] = value;
      recording.channels[nu + i].samples[t] = (value + row.mean) * row.unit;
    }
  }
  auto& first = recording.channels[nu].samples;
  for (std::size_t t = set.missing; set.missing > 0 && t <= set.rows; t += set.missing) {
    first[t - 1] = std::numeric_limits<double>::quiet_NaN();
  }
  return recording;
}

}  // namespace wisp::made
