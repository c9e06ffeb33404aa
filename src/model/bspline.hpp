#pragma once
// Cubic B-splines: knots, basis functions and their derivatives.
//
// Source: C. de Boor, A Practical Guide to Splines, chapter IX (the recurrence); L. Piegl & W. Tiller, The NURBS Book,
// section 2.2. Only + − × ÷ are used, so that the weights have the same bits on every machine.

#include <array>
#include <span>
#include <vector>

namespace wisp {

inline constexpr int kSplineDegree = 3;

/// Returns the full knot vector of an open cubic B-spline with `points` control points, clamped at both ends
/// (multiplicity 4 there), uniform between; parameters run over [0, 1]. Returns points + 4 ascending values.
/// Precondition: points >= 4.
std::vector<double> uniform_knots(int points);

/// Returns the full, clamped knot vector over [0, 1] with the given interior knots.
/// Precondition: `interior` is ascending and inside (0, 1).
std::vector<double> clamped_knots(std::span<const double> interior);

/// Returns whether `knots` is a full, clamped, ascending cubic knot vector over [0, 1] for at least four control points
/// with no interior knot of multiplicity above 3.
bool valid_knots(std::span<const double> knots);

/// Values of the four basis functions that can be nonzero at one parameter. `first`: control point of the first one.
struct BasisWeights {
  int first = 0;
  std::array<double, 4> weight{};
};

/// Returns the basis functions at parameter s. Weights sum to 1.
/// Precondition: valid_knots(knots); 0 <= s <= 1.
BasisWeights basis(std::span<const double> knots, double s);

/// Returns the derivatives of the basis functions with respect to s; they sum to 0. Preconditions: those of basis().
BasisWeights basis_derivative(std::span<const double> knots, double s);

}  // namespace wisp
