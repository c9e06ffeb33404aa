#include "capture/vision/outline_tracker.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "capture/vision/region.hpp"

namespace wisp {
namespace {

// Replaces the lower triangle of the n × n matrix by its Cholesky factor L, L Lᵀ = matrix. Returns false where the
// matrix is not positive definite.
bool cholesky(std::span<double> matrix, int n) {
  for (int i = 0; i < n; ++i) {
    double* row = matrix.data() + static_cast<std::ptrdiff_t>(i) * n;
    for (int j = 0; j <= i; ++j) {
      const double* other = matrix.data() + static_cast<std::ptrdiff_t>(j) * n;
      double sum = row[j];
      for (int k = 0; k < j; ++k) sum -= row[k] * other[k];
      if (j < i) {
        row[j] = sum / other[j];
      } else {
        if (!(sum > 0)) return false;
        row[i] = std::sqrt(sum);
      }
    }
  }
  return true;
}

// Solves L Lᵀ x = b in place.
void cholesky_solve(std::span<const double> factor, int n, std::span<double> b) {
  for (int i = 0; i < n; ++i) {
    const double* row = factor.data() + static_cast<std::ptrdiff_t>(i) * n;
    double sum = b[i];
    for (int k = 0; k < i; ++k) sum -= row[k] * b[k];
    b[i] = sum / row[i];
  }
  for (int i = n - 1; i >= 0; --i) {
    const double* row = factor.data() + static_cast<std::ptrdiff_t>(i) * n;
    b[i] /= row[i];
    for (int k = 0; k < i; ++k) b[k] -= row[k] * b[i];
  }
}

// Writes the inverse of L Lᵀ to `inverse` (n × n).
void cholesky_inverse(std::span<const double> factor, int n, std::span<double> inverse) {
  for (int column = 0; column < n; ++column) {
    // Solves for the column in row `column`, as the inverse is symmetric.
    const std::span<double> row = inverse.subspan(static_cast<std::size_t>(column) * n, n);
    std::fill(row.begin(), row.end(), 0.0);
    row[column] = 1;
    cholesky_solve(factor, n, row);
  }
}

constexpr double kMinNormalSd = 0.25;  // pixels: noise of a well-located edge

// Share of the height within which no point is an outlier: few control points cannot follow a sharp tip.
constexpr double kNoOutlier = 0.1;

// Standard deviation of the uninformative prior for the first frame, in heights.
constexpr double kVagueSd = 10;

}  // namespace

OutlineTracker::OutlineTracker(std::span<const double> knots, const TrackerOptions& options)
    : table_(knots), options_(options) {
  const std::size_t n = 2 * static_cast<std::size_t>(table_.points());
  estimate_.mean.assign(n, 0.0);
  for (auto* matrix : {&estimate_.covariance, &prior_information_, &information_, &factor_}) matrix->assign(n * n, 0.0);
  prior_vector_.assign(n, 0.0);
  vector_.assign(n, 0.0);
}

// Computes the prior: the previous posterior, with the mean shifted by the base's motion and the covariance widened.
void OutlineTracker::predict(const EdgeCloud& cloud) {
  const int n = static_cast<int>(vector_.size());
  if (!has_past_) {
    std::fill(prior_information_.begin(), prior_information_.end(), 0.0);
    const double precision = 1 / (kVagueSd * cloud.height * kVagueSd * cloud.height);
    for (int i = 0; i < n; ++i) {
      prior_information_[static_cast<std::size_t>(i) * n + i] = precision;
      prior_vector_[i] = precision * (i % 2 == 0 ? cloud.base_x : cloud.base_y);
    }
    return;
  }
  for (int i = 0; i < n; i += 2) {
    estimate_.mean[i] += cloud.base_x - base_x_;
    estimate_.mean[i + 1] += cloud.base_y - base_y_;
  }
  widen(cloud.height);
  factor_ = estimate_.covariance;
  [[maybe_unused]] const bool definite = cholesky(factor_, n);
  assert(definite);
  cholesky_inverse(factor_, n, prior_information_);
  for (int i = 0; i < n; ++i) {
    double sum = 0;
    for (int j = 0; j < n; ++j) sum += prior_information_[static_cast<std::size_t>(i) * n + j] * estimate_.mean[j];
    prior_vector_[i] = sum;
  }
}

void OutlineTracker::widen(double height) {
  const int points = table_.points();
  const std::size_t n = vector_.size();
  const double across = options_.normal_widening * height, along = options_.tangent_widening * height;
  for (int k = 0; k < points; ++k) {
    // A control point acts where its basis function peaks, near the mean of its three inner knots.
    const auto knots = table_.knots();
    const double s = (knots[k + 1] + knots[k + 2] + knots[k + 3]) / 3;
    const CurvePoint slope = table_.slope(estimate_.mean, s);
    const double size = std::max(length(slope.x, slope.y), 1e-9);
    const double tx = slope.x / size, ty = slope.y / size;
    const double cross = (along * along - across * across) * tx * ty;
    double* block = estimate_.covariance.data() + 2 * k * n + 2 * k;
    block[0] += along * along * tx * tx + across * across * ty * ty;
    block[1] += cross;
    block[n] += cross;
    block[n + 1] += along * along * ty * ty + across * across * tx * tx;
  }
}

// Adds measurements n · curve(s) = value that were gathered at one s, and so involve four control points.
void OutlineTracker::add(const BasisWeights& weights, const Gathered& gathered) {
  SpanSums& sums = sums_[static_cast<std::size_t>(weights.first)];
  const auto& [w0, w1, w2, w3] = weights.weight;
  const std::array<double, 10> both{w0 * w0, w1 * w0, w1 * w1, w2 * w0, w2 * w1,
                                    w2 * w2, w3 * w0, w3 * w1, w3 * w2, w3 * w3};
  for (std::size_t pair = 0; pair < both.size(); ++pair) {
    sums.xx[pair] += both[pair] * gathered.xx;
    sums.xy[pair] += both[pair] * gathered.xy;
    sums.yy[pair] += both[pair] * gathered.yy;
  }
  for (std::size_t r = 0; r < sums.x.size(); ++r) {
    sums.x[r] += weights.weight[r] * gathered.x;
    sums.y[r] += weights.weight[r] * gathered.y;
  }
}

// Adds the spans' sums to the information matrix (its lower triangle) and vector.
void OutlineTracker::spread_sums() {
  const std::size_t n = vector_.size();
  for (std::size_t first = 0; first < sums_.size(); ++first) {
    const SpanSums& sums = sums_[first];
    std::size_t pair = 0;
    for (std::size_t r = 0; r < 4; ++r) {
      double* row = information_.data() + 2 * (first + r) * n + 2 * first;
      for (std::size_t c = 0; c <= r; ++c, ++pair) {
        row[2 * c] += sums.xx[pair];
        if (c < r) row[2 * c + 1] += sums.xy[pair];
        row[n + 2 * c] += sums.xy[pair];
        row[n + 2 * c + 1] += sums.yy[pair];
      }
      vector_[2 * (first + r)] += sums.x[r];
      vector_[2 * (first + r) + 1] += sums.y[r];
    }
  }
}

// Adds all edge points to the prior. Normals are the edge points' gradients in a frame's first pass, the curve's later.
void OutlineTracker::measure(const EdgeCloud& cloud, bool along_own_normal) {
  information_ = prior_information_;
  vector_ = prior_vector_;
  sums_.assign(static_cast<std::size_t>(table_.points()) - 3, {});  // one per span
  for (std::size_t k = 0; k < cloud.points.size(); ++k) {
    if (out_[k]) continue;
    const EdgePoint& edge = cloud.points[k];
    double nx = edge.normal_x, ny = edge.normal_y;
    if (!along_own_normal) {
      const CurvePoint& slope = slopes_[k];
      const double size = std::max(length(slope.x, slope.y), 1e-9);
      nx = slope.y / size;
      ny = -slope.x / size;
    }
    const double along = nx * edge.y - ny * edge.x;
    Gathered here, before;
    here.take(nx, ny, nx * edge.x + ny * edge.y, normal_precision_);
    if (!along_own_normal) here.take(-ny, nx, along, hold_precision_);
    before.take(-ny, nx, along, tangent_precision_);
    add(table_.weights(places_[k]), here);
    add(cloud_weights_[k], before);
  }
  hold_ends(cloud);
  spread_sums();
}

// Adds the curve's two ends as points, measured in both directions with four times the precision of an edge point.
void OutlineTracker::hold_ends(const EdgeCloud& cloud) {
  const double precision = normal_precision_ * 4;
  for (const bool last : {false, true}) {
    const EdgePoint& end = last ? cloud.points.back() : cloud.points.front();
    Gathered both;
    both.take(1, 0, end.x, precision);
    both.take(0, 1, end.y, precision);
    add(table_.weights(last ? 1.0 : 0.0), both);
  }
}

void OutlineTracker::solve() {
  const int n = static_cast<int>(vector_.size());
  factor_ = information_;
  [[maybe_unused]] const bool definite = cholesky(factor_, n);
  assert(definite);
  estimate_.mean = vector_;
  cholesky_solve(factor_, n, estimate_.mean);
}

// Moves each edge point's parameter by a Newton step towards the nearest point of the curve, within `slip` of its
// position in the cloud, as points would otherwise gather where the curve happens to pass close by.
void OutlineTracker::project(const EdgeCloud& cloud) {
  table_.pieces(estimate_.mean, pieces_);
  for (std::size_t k = 0; k < cloud.points.size(); ++k) {
    double& s = places_[k];
    const auto [at, slope] = pieces_.at(s);
    const double square = slope.x * slope.x + slope.y * slope.y;
    if (square <= 0) continue;
    const double step = ((cloud.points[k].x - at.x) * slope.x + (cloud.points[k].y - at.y) * slope.y) / square;
    s = std::clamp(s + step, std::max(cloud.s[k] - options_.slip, 0.0), std::min(cloud.s[k] + options_.slip, 1.0));
  }
}

void OutlineTracker::measure_residuals(const EdgeCloud& cloud) {
  residuals_.resize(cloud.points.size());
  slopes_.resize(cloud.points.size());
  for (std::size_t k = 0; k < residuals_.size(); ++k) {
    const auto [at, slope] = pieces_.at(places_[k]);
    slopes_[k] = slope;
    residuals_[k] = length(cloud.points[k].x - at.x, cloud.points[k].y - at.y);
  }
}

double OutlineTracker::misfit() const {
  double sum = 0;
  for (std::size_t k = 0; k < residuals_.size(); ++k) sum += out_[k] != 0 ? 0 : residuals_[k];
  return sum;
}

// Projects and solves until the residuals stop falling. Where they rise, steps back and increases the weight of edge
// points' positions along the curve (Levenberg's damping: along the normal alone, steps overshoot at sharp turns).
void OutlineTracker::settle(const EdgeCloud& cloud) {
  project(cloud);
  measure_residuals(cloud);
  double best = misfit();
  best_mean_ = estimate_.mean;
  best_places_ = places_;
  hold_precision_ = options_.hold * normal_precision_;
  for (int pass = 1; pass < options_.passes; ++pass) {
    measure(cloud, false);
    solve();
    project(cloud);
    measure_residuals(cloud);
    const double now = misfit();
    const bool settled = now > 0.98 * best && now <= best;
    if (now < best) {
      best = now;
      best_mean_ = estimate_.mean;
      best_places_ = places_;
      hold_precision_ *= 0.5;
    } else {
      estimate_.mean = best_mean_;
      places_ = best_places_;
      table_.pieces(estimate_.mean, pieces_);
      measure_residuals(cloud);
      hold_precision_ *= 8;
    }
    if (settled) break;
  }
}

// Excludes edge points much farther from the curve than their median distance. Returns whether any were excluded.
bool OutlineTracker::gate(const EdgeCloud& cloud) {
  const std::size_t count = cloud.points.size();
  std::vector<double>& sorted = vector_;  // reuses vector_, which is rebuilt by the next measure()
  sorted.assign(residuals_.begin(), residuals_.end());
  std::nth_element(sorted.begin(), sorted.begin() + count / 2, sorted.end());
  const double typical = std::max(sorted[count / 2], kMinNormalSd);
  const double limit = std::max(options_.gate * typical, kNoOutlier * cloud.height);
  bool any = false;
  for (std::size_t k = 0; k < count; ++k) {
    out_[k] = residuals_[k] > limit;
    any = any || out_[k] != 0;
  }
  vector_.resize(estimate_.mean.size());
  return any;
}

void OutlineTracker::account() {
  double squares = 0;
  estimate_.used = 0;
  for (std::size_t k = 0; k < residuals_.size(); ++k) {
    if (out_[k]) continue;
    squares += residuals_[k] * residuals_[k];
    ++estimate_.used;
  }
  estimate_.gated = static_cast<int>(residuals_.size()) - estimate_.used;
  estimate_.residual = std::sqrt(squares / std::max(estimate_.used, 1));
}

const OutlineEstimate& OutlineTracker::update(const EdgeCloud& cloud) {
  const double normal_sd = std::max(options_.normal_sd * cloud.height, kMinNormalSd);
  const double tangent_sd = options_.tangent_sd * cloud.height;
  normal_precision_ = 1 / (normal_sd * normal_sd);
  tangent_precision_ = 1 / (tangent_sd * tangent_sd);
  places_ = cloud.s;
  cloud_weights_.clear();
  for (const double s : cloud.s) cloud_weights_.push_back(table_.weights(s));
  out_.assign(cloud.points.size(), 0);
  predict(cloud);
  measure(cloud, true);
  solve();
  settle(cloud);
  if (gate(cloud)) settle(cloud);
  account();
  cholesky_inverse(factor_, static_cast<int>(vector_.size()), estimate_.covariance);
  base_x_ = cloud.base_x;
  base_y_ = cloud.base_y;
  has_past_ = true;
  return estimate_;
}

}  // namespace wisp
