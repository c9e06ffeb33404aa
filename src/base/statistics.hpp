#pragma once
// Location and spread of samples, for all layers.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace wisp {

/// Returns the nearest-rank sample at `share` (0 smallest, 0.5 median, 1 largest); 0 if empty.
///
/// `share` in [0, 1]; no sample is NaN.
template <class T>
T quantile(std::vector<T> values, double share) {
  if (values.empty()) return T(0);
  const auto at = values.begin() + std::lround(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Returns the middle sample, the upper one of an even number of samples; 0 if empty.
template <class T>
T median(std::vector<T> values) {
  return quantile(std::move(values), 0.5);
}

/// Returns the values that are not NaN.
inline std::vector<double> present(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  return values;
}

/// Returns the arithmetic mean; 0 if empty.
inline double mean(std::span<const double> values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Returns the standard deviation about the mean, divided by the number of samples; 0 if empty.
inline double deviation(std::span<const double> values) {
  if (values.empty()) return 0;
  const double middle = mean(values);
  double sum = 0;
  for (const double value : values) sum += (value - middle) * (value - middle);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace wisp
