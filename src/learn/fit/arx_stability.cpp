#include "learn/fit/arx_stability.hpp"

#include <algorithm>

#include "learn/numeric/decompositions.hpp"
#include "learn/rows/arx_design.hpp"

namespace wisp {
using Eigen::Index;
using Eigen::VectorXd;

Eigen::MatrixXd companion_of(const ArxModel& model, const std::vector<int>& outputs) {
  int order = 0;
  for (int value : model.orders.na.values()) order = std::max(order, value);
  const Index count = std::ssize(outputs), states = count * order;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(states, states);
  for (Index r = 0; r < count; ++r) {
    for (Index c = 0; c < count; ++c) {
      const auto a = model.a(outputs[r], outputs[c]);
      for (Index lag = 0; lag < std::ssize(a); ++lag) companion(r, lag * count + c) = -a[lag];
    }
  }
  for (Index r = count; r < states; ++r) companion(r, r - count) = 1;
  return companion;
}

namespace {

// Scales the poles of one output's A; B and the constant move to their conditional optimum for that A.
void scale_row(const Eigen::MatrixXd& inverse, double factor, int output, ArxModel& model) {
  std::vector<double>& theta = model.theta[output];
  std::vector<double> moved;
  for (int j = 0; j < model.orders.outputs(); ++j) {
    double power = factor;
    for (int lag = 0; lag < model.orders.na(output, j); ++lag, power *= factor) {
      moved.push_back(theta[moved.size()] * (power - 1));
    }
  }
  const auto own = std::ssize(moved);
  const VectorXd push =
      shortest_solution(inverse.topLeftCorner(own, own), Eigen::Map<const VectorXd>(moved.data(), own));
  const VectorXd follow = inverse.bottomLeftCorner(inverse.rows() - own, own) * push;
  for (Index k = 0; k < own; ++k) theta[k] += moved[k];
  for (Index k = 0; k < follow.size(); ++k) {
    const auto place = static_cast<std::size_t>(own + k);
    (place < theta.size() ? theta[place] : model.constant[output]) += follow[k];
  }
}

}  // namespace

void make_stable(ArxModel& model, const std::vector<Eigen::MatrixXd>& inverse, double max_radius, double share) {
  for (const std::vector<int>& outputs : coupled_outputs(model.orders.na)) {
    const Eigen::MatrixXd companion = companion_of(model, outputs);
    const double radius = companion.size() > 0 ? eigenvalues(companion).cwiseAbs().maxCoeff() : 0;
    if (radius <= max_radius) continue;
    for (int output : outputs) scale_row(inverse[output], share * max_radius / radius, output, model);
  }
}

}  // namespace wisp
