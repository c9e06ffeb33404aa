#pragma once
// How far two distributions of one number are apart.

#include <span>
#include <vector>

namespace wisp {

/// The Wasserstein-1 distance of two samples: the area between their quantile functions, that is how far, on average,
/// the sorted values of one must be moved to become the other's. In the samples' unit.
///
/// Precondition: both have samples.
double wasserstein1(std::vector<double> x, std::vector<double> y);

/// Standard deviation with divisor n; 0 for fewer than two samples.
double standard_deviation(std::span<const double> samples);

}  // namespace wisp
