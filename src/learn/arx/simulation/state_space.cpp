#include "learn/arx/simulation/state_space.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "learn/numeric/decompositions.hpp"

namespace wisp::arx {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMinLags = 8;
constexpr int kFeedback = 120;  // samples that an output is predicted from: more outputs remember fewer lags

// c, c a, c a², …, the oldest row first.
MatrixXd observability(const StateSpace& model, Index rows) {
  const Index outputs = model.outputs();
  MatrixXd out(rows * outputs, model.states());
  MatrixXd power = model.c;
  for (Index k = 0; k < rows; ++k) {
    out.middleRows(k * outputs, outputs) = power;
    power = power * model.a;
  }
  return out;
}

// Takes `lags` rows of outputs, the oldest first and without what inputs and level did since, to the state before them.
MatrixXd state_filter(const StateSpace& model, int lags) {
  const VectorXd weight = model.noise.cwiseInverse().replicate(lags, 1);
  return pseudo_inverse(weight.asDiagonal() * observability(model, lags)) * weight.asDiagonal();
}

MatrixXd power_of(const MatrixXd& matrix, int exponent) {
  MatrixXd out = MatrixXd::Identity(matrix.rows(), matrix.cols());
  for (int k = 0; k < exponent; ++k) out = out * matrix;
  return out;
}

// Blocks of so many columns in the opposite order.
MatrixXd oldest_first(const MatrixXd& newest_first, Index columns) {
  MatrixXd out(newest_first.rows(), newest_first.cols());
  for (Index at = 0; at < out.cols(); at += columns) {
    out.middleCols(out.cols() - columns - at, columns) = newest_first.middleCols(at, columns);
  }
  return out;
}

MatrixXd rounded(const MatrixXd& matrix) { return matrix.cast<float>().cast<double>(); }

}  // namespace

int arx_lags(int states, int outputs) {
  const int needed = (states + outputs - 1) / outputs;
  return std::max(needed, std::clamp(kFeedback / outputs, kMinLags, kStateSpaceLags));
}

ArxForm arx_form(const StateSpace& model, int lags) {
  const Index outputs = model.outputs(), inputs = model.inputs();
  const MatrixXd ahead = model.c * power_of(model.a, lags);
  const MatrixXd gain = ahead * state_filter(model, lags);
  ArxForm form{MatrixXd(outputs, outputs * lags), MatrixXd(outputs, inputs * (lags + 1)), model.level};
  for (Index l = 0; l < lags; ++l) {
    form.feedback.middleCols(l * outputs, outputs) = gain.middleCols((lags - 1 - l) * outputs, outputs);
  }
  // (1 − feedback) applied to the response: beyond `lags` nothing is left of it, since the form is exact.
  MatrixXd response(outputs, inputs * (lags + 1));
  response.leftCols(inputs) = model.d;
  MatrixXd reached = model.b;
  for (Index l = 1; l <= lags; ++l) {
    response.middleCols(l * inputs, inputs) = model.c * reached;
    reached = model.a * reached;
  }
  form.drive = response;
  for (Index l = 1; l <= lags; ++l) {
    for (Index m = 1; m <= l; ++m) {
      form.drive.middleCols(l * inputs, inputs) -=
          form.feedback.middleCols((m - 1) * outputs, outputs) * response.middleCols((l - m) * inputs, inputs);
    }
  }
  for (Index m = 0; m < lags; ++m) form.constant -= form.feedback.middleCols(m * outputs, outputs) * model.level;
  form.feedback = rounded(form.feedback);
  form.drive = rounded(form.drive);
  return form;
}

double radius(const ArxForm& form) {
  const Index outputs = form.feedback.rows(), size = form.feedback.cols();
  if (!form.feedback.allFinite() || !form.drive.allFinite()) return std::numeric_limits<double>::infinity();
  MatrixXd companion = MatrixXd::Zero(size, size);
  companion.topRows(outputs) = form.feedback;
  companion.bottomLeftCorner(size - outputs, size - outputs).setIdentity();
  return eigenvalues(companion).cwiseAbs().maxCoeff();
}

MatrixXd simulate(const StateSpace& model, const BlockRun& run, Index begin, const VectorXd& state) {
  const Index rows = run.inputs.rows() - begin;
  MatrixXd states(model.states(), rows);
  VectorXd x = state;
  for (Index t = 0; t < rows; ++t) {
    states.col(t) = x;
    x = model.a * x + model.b * run.inputs.row(begin + t).transpose();
  }
  MatrixXd out = (model.c * states).transpose() + run.inputs.bottomRows(rows) * model.d.transpose();
  out.rowwise() += model.level.transpose();
  return out;
}

VectorXd best_state(const StateSpace& model, const BlockRun& run, Index begin, const VectorXd& weight) {
  const Index outputs = model.outputs(), states = model.states();
  const Index rows = std::min<Index>(run.outputs.rows() - begin, kMaxStateRows);
  const MatrixXd base = simulate(model, run, begin, VectorXd::Zero(states));
  MatrixXd gram = MatrixXd::Zero(states, states);
  VectorXd moment = VectorXd::Zero(states);
  MatrixXd power = model.c;
  for (Index t = 0; t < rows; ++t) {
    VectorXd rest = (run.outputs.row(begin + t) - base.row(t)).transpose();
    VectorXd counted = weight;
    for (Index o = 0; o < outputs; ++o) {
      if (std::isnan(rest[o])) rest[o] = counted[o] = 0;
    }
    gram += power.transpose() * counted.asDiagonal() * power;
    moment += power.transpose() * (counted.asDiagonal() * rest);
    power = power * model.a;
  }
  gram.diagonal().array() += 1e-12 * gram.diagonal().maxCoeff() + 1e-300;
  return gram.llt().solve(moment);
}

MatrixXd simulate(const ArxForm& form, const BlockRun& run, Index begin) {
  const Index outputs = form.feedback.rows(), lags = form.lags(), inputs = run.inputs.cols();
  const Index rows = run.inputs.rows() - begin;
  const MatrixXd feedback = oldest_first(form.feedback, outputs), drive = oldest_first(form.drive, inputs);
  const MatrixXd u = run.inputs.transpose();
  MatrixXd y(outputs, lags + rows);
  y.leftCols(lags) = run.outputs.middleRows(begin - lags, lags).transpose();
  for (Index t = 0; t < rows; ++t) {
    y.col(lags + t) = form.constant + feedback * y.middleCols(t, lags).reshaped() +
                      drive * u.middleCols(begin + t - lags, lags + 1).reshaped();
  }
  return y.rightCols(rows).transpose();
}

}  // namespace wisp::arx
