#include "learn/fidelity/fidelity_marginal.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace wisp {

double wasserstein1(std::vector<double> x, std::vector<double> y) {
  assert(!x.empty() && !y.empty());
  std::sort(x.begin(), x.end());
  std::sort(y.begin(), y.end());
  // Quantile functions are stairs with steps at i/n and j/m; between two steps their difference is constant. Steps are
  // compared as integers over n·m, so that equal ones meet.
  const std::size_t n = x.size();
  const std::size_t m = y.size();
  double area = 0;
  std::size_t i = 0;
  std::size_t j = 0;
  std::size_t at = 0;
  while (i < n && j < m) {
    const std::size_t next = std::min((i + 1) * m, (j + 1) * n);
    area += static_cast<double>(next - at) * std::abs(x[i] - y[j]);
    if (next == (i + 1) * m) ++i;
    if (next == (j + 1) * n) ++j;
    at = next;
  }
  return area / (static_cast<double>(n) * static_cast<double>(m));
}

double standard_deviation(std::span<const double> samples) {
  if (samples.size() < 2) return 0;
  const auto n = static_cast<double>(samples.size());
  const double mean = std::accumulate(samples.begin(), samples.end(), 0.0) / n;
  double sum = 0;
  for (double value : samples) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / n);
}

}  // namespace wisp
