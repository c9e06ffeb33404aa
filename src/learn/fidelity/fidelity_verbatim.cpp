#include "learn/fidelity/fidelity_verbatim.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "learn/fidelity/fidelity_marginal.hpp"

namespace wisp {
namespace {

std::vector<double> tolerances(std::span<const Stretch> real, double tolerance) {
  std::vector<double> out;
  const std::size_t channels = real.empty() ? 0 : real.front().channels;
  for (std::size_t c = 0; c < channels; ++c) {
    std::vector<double> all;
    for (const Stretch& stretch : real) {
      const auto samples = stretch.channel(c);
      all.insert(all.end(), samples.begin(), samples.end());
    }
    out.push_back(tolerance * standard_deviation(all));
  }
  return out;
}

bool alike(std::span<const double> a, std::span<const double> b, std::span<const double> tolerance) {
  for (std::size_t c = 0; c < a.size(); ++c) {
    if (!(std::abs(a[c] - b[c]) <= tolerance[c])) return false;
  }
  return true;
}

// run[j]: rows of a common run that ends at row i of one and row j of the other.
std::size_t longest_common_run(const Stretch& a, const Stretch& b, std::span<const double> tolerance) {
  std::vector<std::size_t> run(b.rows() + 1, 0);
  std::size_t longest = 0;
  for (std::size_t i = 0; i < a.rows(); ++i) {
    for (std::size_t j = b.rows(); j > 0; --j) {
      run[j] = alike(a.row(i), b.row(j - 1), tolerance) ? run[j - 1] + 1 : 0;
      longest = std::max(longest, run[j]);
    }
  }
  return longest;
}

}  // namespace

std::size_t longest_verbatim_run(std::span<const Stretch> real, std::span<const Stretch> synthesized,
                                 double tolerance) {
  const std::vector<double> allowed = tolerances(real, tolerance);
  std::size_t longest = 0;
  for (const Stretch& a : real) {
    for (const Stretch& b : synthesized) longest = std::max(longest, longest_common_run(a, b, allowed));
  }
  return longest;
}

}  // namespace wisp
