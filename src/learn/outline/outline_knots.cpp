#include "learn/outline/outline_knots.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "model/bspline.hpp"

namespace wisp {
namespace {

using Matrix = Eigen::MatrixXd;

constexpr int kSamples = 200;

// Basis functions at even parameters: samples × control points.
Matrix basis_table(std::span<const double> knots) {
  const auto points = static_cast<Eigen::Index>(knots.size()) - kSplineDegree - 1;
  Matrix table = Matrix::Zero(kSamples, points);
  for (int k = 0; k < kSamples; ++k) {
    const BasisWeights weights = basis(knots, static_cast<double>(k) / (kSamples - 1));
    for (int r = 0; r < 4; ++r) table(k, weights.first + r) = weights.weight[r];
  }
  return table;
}

// The matrix that takes old control points to new ones: the ends as they are, because clamped curves end in their end
// points, and the others by least squares.
Matrix change(const Matrix& from, const Matrix& to) {
  const Eigen::Index points = to.cols();
  const Matrix inner = to.middleCols(1, points - 2);
  Matrix rest = from;
  rest.col(0) -= to.col(0);
  rest.col(points - 1) -= to.col(points - 1);
  Matrix out = Matrix::Zero(points, points);
  out(0, 0) = out(points - 1, points - 1) = 1;
  out.middleRows(1, points - 2) = inner.colPivHouseholderQr().solve(rest);
  return out;
}

}  // namespace

Reknotted with_knots(const Recording& recording, const OutlineLayout& layout, std::span<const double> knots) {
  const Matrix from = basis_table(layout.knots);
  const Matrix to = basis_table(knots);
  const Matrix matrix = change(from, to);
  Reknotted out{recording, 0};
  set_numbers_attribute(out.recording, "knots", knots);
  const auto points = static_cast<Eigen::Index>(layout.points);
  double square = 0;
  double rows = 0;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    Matrix old(points, 2);
    for (Eigen::Index k = 0; k < 2 * points; ++k) {
      old(k / 2, k % 2) = recording.channels[layout.outputs[k]].samples[row];
    }
    if (!old.allFinite()) continue;
    const Matrix fresh = matrix * old;
    for (Eigen::Index k = 0; k < 2 * points; ++k) {
      out.recording.channels[layout.outputs[k]].samples[row] = fresh(k / 2, k % 2);
    }
    square += (to * fresh - from * old).squaredNorm() / kSamples;
    rows += 1;
  }
  out.rms = rows > 0 ? std::sqrt(square / rows) : 0;
  return out;
}

}  // namespace wisp
