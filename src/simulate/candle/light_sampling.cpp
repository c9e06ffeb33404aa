#include "simulate/candle/light_sampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace wisp::flow {
namespace {

std::array<double, 4> cubic_weights(double t) {
  const double s = 1 - t;
  return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6};
}

}  // namespace

SamplePlaces sample_places(int count, double start, double step, int cells) {
  SamplePlaces places;
  for (int k = 0; k < count; ++k) {
    const double x = start + step * k;
    const int lower = static_cast<int>(std::floor(x));
    const std::array<double, 4> kernel = cubic_weights(x - lower);
    const int first = std::clamp(lower - 1, 0, cells - 4);
    std::array<float, 4> weight{};
    for (int n = 0; n < 4; ++n) {
      const int slot = lower - 1 + n - first;
      if (slot >= 0 && slot < 4) weight[slot] = static_cast<float>(kernel[n]);
    }
    places.first.push_back(first);
    places.weight.insert(places.weight.end(), weight.begin(), weight.end());
  }
  return places;
}

void mix_rows(std::span<const float> values, int columns, const SamplePlaces& rows, int row, std::span<float> out) {
  const float* w = rows.weight.data() + 4 * static_cast<std::size_t>(row);
  const float* a = values.data() + static_cast<std::size_t>(rows.first[row]) * columns;
  const float* b = a + columns;
  const float* c = b + columns;
  const float* d = c + columns;
  for (int i = 0; i < columns; ++i) out[i] = (w[0] * a[i] + w[1] * b[i]) + (w[2] * c[i] + w[3] * d[i]);
}

float sample(std::span<const float> mixed, const SamplePlaces& columns, int place) {
  const float* x = mixed.data() + columns.first[place];
  const float* w = columns.weight.data() + 4 * static_cast<std::size_t>(place);
  return (w[0] * x[0] + w[1] * x[1]) + (w[2] * x[2] + w[3] * x[3]);
}

}  // namespace wisp::flow
