#include "capture/clip/views/view_join.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace wisp {
namespace {

// Normalised correlation of first[k + lag] and second[k]; −1 where there are too few rows or a series is constant.
double correlation(std::span<const double> first, std::span<const double> second, std::ptrdiff_t lag, double least) {
  double count = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  const auto end = std::min(std::ssize(second), std::ssize(first) - lag);
  for (auto k = std::max<std::ptrdiff_t>(0, -lag); k < end; ++k) {
    const double a = first[static_cast<std::size_t>(k + lag)], b = second[static_cast<std::size_t>(k)];
    if (std::isnan(a + b)) continue;
    count += 1, x += a, y += b, xx += a * a, yy += b * b, xy += a * b;
  }
  const double power = count < least ? 0 : (xx - x * x / count) * (yy - y * y / count);
  return power > 1e-18 ? (xy - x * y / count) / std::sqrt(power) : -1;
}

}  // namespace

std::optional<TimeOffset> time_offset(std::span<const double> first, std::span<const double> second, double rate_hz) {
  // Minimum overlap, as a share of the shorter series: short overlaps correlate by chance.
  const auto shorter = static_cast<double>(std::min(first.size(), second.size()));
  const double least = std::max(2 * rate_hz, 0.3 * shorter);
  std::vector<double> found;
  for (auto lag = -std::ssize(second); lag <= std::ssize(first); ++lag)
    found.push_back(correlation(first, second, lag, least));
  const auto best = std::max_element(found.begin(), found.end());
  if (*best <= -1) return std::nullopt;
  const auto at = best - found.begin();
  TimeOffset out{static_cast<double>(at - std::ssize(second)), *best, -1};
  for (std::ptrdiff_t k = 0; k < std::ssize(found); ++k) {
    if (std::abs(static_cast<double>(k - at)) >= rate_hz)
      out.next_best = std::max(out.next_best, found[static_cast<std::size_t>(k)]);
  }
  // Refines the maximum between samples by a parabola through three; the correlation at both ends is −1.
  const double before = best[-1], after = best[1], bend = before - 2 * *best + after;
  if (bend < 0 && before > -1 && after > -1) out.rows += std::clamp(0.5 * (before - after) / bend, -0.5, 0.5);
  return out;
}

}  // namespace wisp
