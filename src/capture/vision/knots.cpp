#include "capture/vision/edge_cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "capture/vision/outline_tracker.hpp"
#include "capture/vision/region.hpp"

namespace wisp {
namespace {

constexpr int kBins = 128;
constexpr double kMinGain = 0.002;  // share of the area by which placed knots must fit better: less is invisible
using Density = std::array<double, kBins>;

// Returns the outlines' mean change of direction in each bin of s, normalised to a sum of 1.
Density bending(std::span<const EdgeCloud> clouds) {
  Density out{};
  for (const EdgeCloud& cloud : clouds) {
    const std::size_t count = cloud.points.size(), reach = std::max<std::size_t>(2, count / 40);
    for (std::size_t k = reach; k + reach < count; ++k) {
      const EdgePoint &a = cloud.points[k - reach], &b = cloud.points[k], &c = cloud.points[k + reach];
      const double cross = (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
      const double dot = (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y);
      const int bin = std::min(kBins - 1, static_cast<int>(cloud.s[k] * kBins));
      out[bin] += std::abs(std::atan2(cross, dot)) / static_cast<double>(count);
    }
  }
  double sum = 0;
  for (const double value : out) sum += value;
  for (double& value : out) value = sum > 0 ? value / sum : 1.0 / kBins;
  return out;
}

// Returns knots that divide a density into equal amounts: bending^power, mixed with the share `even` of a uniform one.
std::vector<double> spread(const Density& bend, int points, double even, double power) {
  Density density;
  double sum = 0;
  for (int k = 0; k < kBins; ++k) {
    density[k] = std::pow(bend[k] * kBins, power);
    sum += density[k];
  }
  for (double& value : density) value = even / kBins + (1 - even) * value / sum;
  std::vector<double> interior;
  const int spans = points - kSplineDegree;
  double before = 0;
  int bin = 0;
  for (int k = 1; k < spans; ++k) {
    const double target = static_cast<double>(k) / spans;
    while (bin + 1 < kBins && before + density[bin] < target) before += density[bin++];
    interior.push_back((bin + std::clamp((target - before) / density[bin], 0.0, 1.0)) / kBins);
  }
  return clamped_knots(interior);
}

double misfit(const EdgeCloud& cloud, std::span<const double> residuals) {
  double area = cloud.left_out;
  for (std::size_t k = 1; k < residuals.size(); ++k) {
    const EdgePoint &a = cloud.points[k - 1], &b = cloud.points[k];
    area += 0.5 * (residuals[k - 1] + residuals[k]) * length(b.x - a.x, b.y - a.y);
  }
  return area / cloud.area;
}

// Averages the curve parameters to which edge points were moved, as a function of their positions in the clouds.
class PaceMeasure {
 public:
  void add(std::span<const double> even, std::span<const double> reached) {
    for (std::size_t k = 0; k < even.size(); ++k) {
      const double place = even[k] * kPaceSteps;
      const int step = std::min(kPaceSteps - 1, static_cast<int>(place));
      const double share = place - step;
      weight_[step] += 1 - share;
      weight_[step + 1] += share;
      sum_[step] += (1 - share) * reached[k];
      sum_[step + 1] += share * reached[k];
    }
  }

  std::vector<double> pace(std::span<const double> before) const {
    std::vector<double> out(before.begin(), before.end());
    for (int k = 1; k < kPaceSteps; ++k) {
      if (weight_[k] > 0) out[k] = sum_[k] / weight_[k];
    }
    // Strictly increasing: each further edge point has to advance the parameter.
    for (int k = 1; k <= kPaceSteps; ++k) out[k] = std::max(out[k], out[k - 1] + 0.1 / kPaceSteps);
    const double whole = out.back();
    for (double& value : out) value /= whole;
    return out;
  }

 private:
  std::array<double, kPaceSteps + 1> weight_{};
  std::array<double, kPaceSteps + 1> sum_{};
};

}  // namespace

CurveShape fit_pace(std::span<const EdgeCloud> clouds, std::span<const double> knots) {
  OutlineTracker tracker(knots);
  CurveShape best{{knots.begin(), knots.end()}, even_pace(), 1e30, {}};
  std::vector<double> pace = best.pace;
  for (int round = 0; round < 3; ++round) {
    PaceMeasure measure;
    double mean = 0;
    std::vector<double> misfits;
    for (const EdgeCloud& cloud : clouds) {
      EdgeCloud paced = cloud;
      for (double& s : paced.s) s = at_pace(pace, s);
      tracker.forget();
      const OutlineEstimate& outline = tracker.update(paced);
      // A curve that intersects itself (a loop at a sharp tip or the base) does so even more when played with noise.
      const bool folded = crosses_itself(curve_polyline(tracker.table(), outline.mean, 100));
      misfits.push_back(folded ? 1 : misfit(cloud, tracker.residuals()));
      mean += misfits.back() / static_cast<double>(clouds.size());
      measure.add(cloud.s, tracker.places());
    }
    if (mean < best.misfit) {
      best.misfit = mean;
      best.misfits = std::move(misfits);
      best.pace = pace;
    }
    pace = measure.pace(pace);
  }
  return best;
}

CurveShape choose_shape(std::span<const EdgeCloud> clouds, int points) {
  CurveShape best = fit_pace(clouds, uniform_knots(points));
  const double enough = best.misfit - kMinGain;
  const Density bend = bending(clouds);
  for (const double power : {0.5, 1.0}) {
    for (const double even : {0.6, 0.35, 0.15}) {
      CurveShape tried = fit_pace(clouds, spread(bend, points, even, power));
      if (tried.misfit < std::min(best.misfit, enough)) best = std::move(tried);
    }
  }
  return best;
}

}  // namespace wisp
