#include <algorithm>
#include <cmath>
#include <complex>
#include <random>

#include "base/statistics.hpp"
#include "capture/clip/views/view_join.hpp"

namespace wisp {
namespace {

constexpr int kShuffles = 1000;
// Maximum power of the first two harmonics of the directions: 4 for a single direction, at least 1 for two directions,
// 0 for evenly distributed ones.
constexpr double kMaxDirectionPower = 0.95;

// Mean square over all directions of two harmonics fitted to these numbers, one per blow.
double harmonics(std::span<const BlowAnswer> blows, std::span<const double> numbers) {
  double power = 0;
  for (const int times : {1, 2}) {
    std::complex<double> sum;
    for (std::size_t k = 0; k < blows.size(); ++k) sum += numbers[k] * std::polar(1.0, times * blows[k].azimuth);
    power += std::norm(sum);
  }
  return 2 * power / static_cast<double>(blows.size() * blows.size());
}

}  // namespace

std::optional<std::array<double, 3>> asymmetry_of(std::span<const BlowAnswer> blows) {
  const std::size_t n = blows.size();
  if (n < kMinSymmetryBlows || harmonics(blows, std::vector<double>(n, 1.0)) > kMaxDirectionPower) return {};
  double strength = 0, lean = 0, both = 0, square = 1e-12;
  const auto count = static_cast<double>(n);
  for (const BlowAnswer& blow : blows) strength += blow.strength / count, lean += blow.lean / count;
  for (const BlowAnswer& blow : blows) {
    both += (blow.strength - strength) * (blow.lean - lean), square += std::pow(blow.strength - strength, 2);
  }
  std::vector<double> rest, by_chance;
  for (const BlowAnswer& blow : blows)
    rest.push_back((blow.lean - lean - both / square * (blow.strength - strength)) / lean);
  const double seen = harmonics(blows, rest), lost = count / (count - 2);
  std::mt19937 generator(1);
  for (int k = 0; k < kShuffles; ++k) {
    for (std::size_t left = n; left > 1; --left) std::swap(rest[left - 1], rest[generator() % left]);
    by_chance.push_back(lost * harmonics(blows, rest));
  }
  const double reach = std::sqrt(quantile(by_chance, 0.95)), share = std::sqrt(seen);
  // In permuted leans 4 / n of the harmonics' own power appears as chance.
  return std::array{100 * std::sqrt(std::max(0.0, seen - mean(by_chance)) / (1 - 4 / count)),
                    100 * std::max(0.0, share - reach), 100 * (share + reach)};
}

}  // namespace wisp
