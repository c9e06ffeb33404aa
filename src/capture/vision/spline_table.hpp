#pragma once
// B-spline basis as one cubic polynomial per span, for curves that are evaluated many thousand times.

#include <array>
#include <span>
#include <vector>

#include "model/bspline.hpp"

namespace wisp {

/// A point or a direction in the picture.
struct CurvePoint {
  double x = 0;
  double y = 0;
};

/// Returns the side of the line from a to b on which p lies: twice the signed area of the triangle, 0 on the line.
inline double side_of(const CurvePoint& a, const CurvePoint& b, const CurvePoint& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// Number of equal cells of [0, 1]; a table stores the span in which each begins.
inline constexpr int kSplineCells = 64;

/// One curve as a cubic polynomial per span: expensive to build, fastest to evaluate.
class CurvePieces {
 public:
  struct Place {
    CurvePoint point;
    CurvePoint slope;
  };

  /// The curve and its derivative at s, 0 to 1.
  Place at(double s) const {
    auto k = static_cast<std::size_t>(guess_[static_cast<std::size_t>(s * kSplineCells)]);
    while (k + 1 < pieces_.size() && pieces_[k + 1].begin <= s) ++k;
    const auto& [begin, power] = pieces_[k];
    const double t = s - begin;
    const auto point = [t](double a, double b, double c, double d) { return a + t * (b + t * (c + t * d)); };
    const auto slope = [t](double b, double c, double d) { return b + t * (2 * c + t * 3 * d); };
    return {
        {point(power[0].x, power[1].x, power[2].x, power[3].x), point(power[0].y, power[1].y, power[2].y, power[3].y)},
        {slope(power[1].x, power[2].x, power[3].x), slope(power[1].y, power[2].y, power[3].y)}};
  }

 private:
  friend class SplineTable;
  struct Piece {
    double begin = 0;
    std::array<CurvePoint, 4> power;  // coefficients of powers of (s − begin)
  };
  std::vector<Piece> pieces_;
  std::span<const int> guess_;  // SplineTable::guess_ of the table
};

/// The B-spline basis of one knot vector.
class SplineTable {
 public:
  /// Precondition: valid_knots(knots).
  explicit SplineTable(std::span<const double> knots);

  int points() const { return points_; }
  std::span<const double> knots() const { return knots_; }

  /// The four non-zero weights at s, and the index of their first control point; s is clamped to [0, 1].
  BasisWeights weights(double s) const;

  /// Derivatives of the weights with respect to s.
  BasisWeights derivatives(double s) const;

  /// Point of the curve at s. `controls` holds x and y of each control point, alternating.
  CurvePoint at(std::span<const double> controls, double s) const;

  CurvePoint slope(std::span<const double> controls, double s) const;

  /// Builds the curve's pieces, which refer to the table and must not outlive it.
  void pieces(std::span<const double> controls, CurvePieces& out) const;

 private:
  struct Span {
    double begin = 0;
    int first = 0;
    std::array<std::array<double, 4>, 4> power{};  // power[k][r]: coefficient of (s − begin)^k in weight r
  };
  const Span& span_at(double s) const;

  std::vector<double> knots_;
  int points_ = 0;
  std::vector<Span> spans_;
  std::vector<int> guess_;  // index of the span in which each cell of [0, 1] begins
};

/// The curve as an open polyline of `count` points with equally spaced s. Precondition: count >= 2.
std::vector<CurvePoint> curve_polyline(const SplineTable& table, std::span<const double> controls, int count);

/// Whether an open polyline intersects itself (adjacent sides do not count); the outline of an object never does.
bool crosses_itself(std::span<const CurvePoint> polyline);

}  // namespace wisp
