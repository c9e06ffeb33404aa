#pragma once
// The outline as a random curve: a Gaussian over the control points of a B-spline, updated by edge points.
//
// Source: section 3.2 of the paper: the spline is a random curve with a distribution over its control points, the data
// cloud is processed point by point, the posterior is approximated by a Gaussian, and the estimate is its median (which
// is its mean). Blake & Isard, Active Contours (Springer 1998), chapters 6 to 10, for measurements along the normal and
// the prior that is the previous frame's posterior, widened.
//
// The recursion uses the information form (inverse covariance): an edge point then changes only the entries of four
// control points, whereas the covariance form would change all; both give the same posterior. Departure: besides its
// precise measurement along the normal, an edge point weakly measures its position along the curve; otherwise control
// points would slide round the outline from frame to frame.

#include <cstdint>
#include <span>
#include <vector>

#include "capture/vision/edge_cloud.hpp"
#include "capture/vision/spline_table.hpp"

namespace wisp {

/// Noise model. Lengths are shares of the outline's height, so that tracking does not depend on image scale.
struct TrackerOptions {
  double normal_sd = 0.002;         ///< sd of an edge point along the normal, 0.0005 to 0.02; at least ¼ pixel
  double tangent_sd = 0.02;         ///< sd of an edge point along the curve, 0.005 to 0.5: 10 times normal_sd
  double normal_widening = 0.1;     ///< sd added per frame across the curve, 0.01 to 1: a flame may move by its width
  double tangent_widening = 0.005;  ///< sd added per frame along the curve, 0.001 to 1
  double hold = 0.05;  ///< initial weight of an edge point's position along the curve, relative to the normal, 0 to 1
  double gate = 6;     ///< outlier threshold in median residuals, 3 to 20
  double slip = 0.1;   ///< maximum shift in s of an edge point along the curve, 0 to 0.2
  int passes = 16;     ///< maximum number of projections of edge points onto the curve, ≥ 1
};

/// The Gaussian posterior after one frame.
struct OutlineEstimate {
  std::vector<double> mean;        ///< x and y of each control point, alternating: 2N values
  std::vector<double> covariance;  ///< 2N × 2N
  double residual = 0;             ///< root mean square distance of the edge points used from the curve, pixels
  int used = 0;                    ///< number of edge points used
  int gated = 0;                   ///< number of outliers excluded
};

class OutlineTracker {
 public:
  /// Precondition: valid_knots(knots).
  explicit OutlineTracker(std::span<const double> knots, const TrackerOptions& options = {});

  const SplineTable& table() const { return table_; }

  /// Takes in one frame's edge points. Returns the posterior, valid until the next call.
  const OutlineEstimate& update(const EdgeCloud& cloud);

  /// Distance of each edge point of the last frame from the posterior's curve, pixels.
  std::span<const double> residuals() const { return residuals_; }

  /// Parameter of the curve's point nearest to each edge point of the last frame.
  std::span<const double> places() const { return places_; }

  /// Resets the tracker: the next frame starts an episode without prior.
  void forget() { has_past_ = false; }

 private:
  void predict(const EdgeCloud& cloud);
  void widen(double height);
  /// Sums of scalar measurements at one place of the curve: Σ precision·n·nᵀ and Σ precision·value·n.
  struct Gathered {
    double xx = 0;
    double xy = 0;
    double yy = 0;
    double x = 0;
    double y = 0;
    void take(double nx, double ny, double value, double precision) {
      const double px = precision * nx, py = precision * ny;
      xx += px * nx;
      xy += px * ny;
      yy += py * ny;
      x += px * value;
      y += py * value;
    }
  };
  /// Sums for a span's four control points: for each of their 10 pairs, and for each point.
  struct SpanSums {
    std::array<double, 10> xx{}, xy{}, yy{};
    std::array<double, 4> x{}, y{};
  };
  void add(const BasisWeights& weights, const Gathered& gathered);
  void spread_sums();
  void measure(const EdgeCloud& cloud, bool along_own_normal);
  void hold_ends(const EdgeCloud& cloud);
  void solve();
  void project(const EdgeCloud& cloud);
  void measure_residuals(const EdgeCloud& cloud);
  double misfit() const;
  void settle(const EdgeCloud& cloud);
  bool gate(const EdgeCloud& cloud);
  void account();

  SplineTable table_;
  TrackerOptions options_;
  bool has_past_ = false;
  double base_x_ = 0;
  double base_y_ = 0;
  double normal_precision_ = 0;
  double tangent_precision_ = 0;
  double hold_precision_ = 0;
  std::vector<double> best_mean_;
  std::vector<double> best_places_;
  OutlineEstimate estimate_;
  std::vector<double> prior_information_;  // 2N × 2N
  std::vector<double> prior_vector_;       // information × mean
  std::vector<double> information_;
  std::vector<double> vector_;
  std::vector<double> factor_;
  std::vector<SpanSums> sums_;               // indexed by a span's first control point
  std::vector<BasisWeights> cloud_weights_;  // basis weights at the positions assigned to the edge points
  CurvePieces pieces_;                       // polynomials of the mean curve
  std::vector<double> places_;
  std::vector<CurvePoint> slopes_;  // derivative of the curve at places_
  std::vector<std::uint8_t> out_;   // whether each edge point is excluded as an outlier
  std::vector<double> residuals_;
};

}  // namespace wisp
