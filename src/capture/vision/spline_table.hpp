#pragma once
// A B-spline's basis as one cubic polynomial a span, for curves that are evaluated many thousand times.

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

/// Equal cells of [0, 1], in each of which a table knows the span that it begins in.
inline constexpr int kSplineCells = 64;

/// One curve as a cubic polynomial a span: the fastest to evaluate, once it is made.
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
    std::array<CurvePoint, 4> power;  // of (s − begin)
  };
  std::vector<Piece> pieces_;
  std::span<const int> guess_;  // the table's
};

/// The basis functions over one knot vector.
class SplineTable {
 public:
  /// Precondition: valid_knots(knots).
  explicit SplineTable(std::span<const double> knots);

  int points() const { return points_; }
  std::span<const double> knots() const { return knots_; }

  /// The four weights at s and the first control point that they belong to; s is clamped to [0, 1].
  BasisWeights weights(double s) const;

  /// Their derivatives with respect to s.
  BasisWeights derivatives(double s) const;

  /// The curve at s. `controls` holds x and y of each control point, alternating.
  CurvePoint at(std::span<const double> controls, double s) const;

  /// Its derivative.
  CurvePoint slope(std::span<const double> controls, double s) const;

  /// Makes the curve's pieces, which are good as long as the table is.
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
  std::vector<int> guess_;  // the span in which each of equal cells of [0, 1] begins
};

/// The outline as a polyline of `count` points evenly spread over s, closed by the reader.
///
/// Precondition: count >= 2.
std::vector<CurvePoint> curve_polyline(const SplineTable& table, std::span<const double> controls, int count);

/// Whether two pieces of an open polyline that are not neighbours cross, as no outline's do.
bool crosses_itself(std::span<const CurvePoint> polyline);

}  // namespace wisp
