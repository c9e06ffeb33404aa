#include "learn/markov/markov_rows.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "learn/arx/fit/arx_check.hpp"
#include "learn/numeric/decompositions.hpp"

namespace wisp::markov {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

constexpr double kRidge = 1e-9;  // of columns scaled to one size, so that a column that a mode never sees is 0

std::vector<double> means_of(const Signals& signals) {
  std::vector<double> means;
  for (std::size_t c = 0; c < signals.names.size(); ++c) {
    double sum = 0, count = 0;
    for (const auto& recording : signals.samples) {
      for (const double x : recording[c]) {
        if (!std::isnan(x)) sum += x, ++count;
      }
    }
    means.push_back(count > 0 ? sum / count : 0);
  }
  return means;
}

// A of the model has the sign opposite to the prediction's.
double sign_of(const LaggedChannel& column, int outputs) {
  return column.channel != kConstantChannel && column.channel < outputs ? -1 : 1;
}

MatrixXd residuals(const Rows& rows, const MatrixXd& theta) { return rows.y - rows.phi * theta; }

// Lower factor of the weighted covariance.
MatrixXd residual_factor(const MatrixXd& residual, const VectorXd& weights, const VectorXd& min_variance) {
  MatrixXd covariance = residual.transpose() * weights.asDiagonal() * residual / std::max(weights.sum(), 1e-9);
  for (Index i = 0; i < min_variance.size(); ++i) {
    covariance(i, i) = std::max(covariance(i, i) * (1 + 1e-9), min_variance(i));
  }
  const Eigen::LLT<MatrixXd> solver(covariance);
  if (solver.info() == Eigen::Success) return solver.matrixL();
  return covariance.diagonal().cwiseSqrt().asDiagonal();
}

MatrixXd weighted_theta(const Rows& rows, const VectorXd& weights) {
  MatrixXd gram = rows.phi.transpose() * weights.asDiagonal() * rows.phi;
  const VectorXd scale = gram.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  gram = scale.asDiagonal() * gram * scale.asDiagonal();
  gram.diagonal().array() += kRidge;
  const MatrixXd right = scale.asDiagonal() * (rows.phi.transpose() * weights.asDiagonal() * rows.y);
  MatrixXd theta = MatrixXd::Zero(rows.phi.cols(), rows.outputs());
  for (int i = 0; i < rows.outputs(); ++i) {
    const auto& columns = rows.design.groups[i].columns;
    theta(columns, i) = symmetric_solution(gram(columns, columns), right(columns, i)).cwiseProduct(scale(columns));
  }
  return theta;
}

}  // namespace

Result<Rows> make_rows(std::span<const Recording> recordings, const ChannelChoice& channels, const ArxOrders& orders,
                       std::vector<double> offset) {
  for (const Recording& recording : recordings) {
    if (auto ok = check(recording); !ok) return Error{recording.source + ": " + ok.error().message};
  }
  auto signals = find_signals(recordings, channels);
  if (!signals) return signals.error();
  if (auto ok = check_orders(orders, channels); !ok) return ok.error();
  signals->offset = offset.empty() ? means_of(*signals) : std::move(offset);
  Rows rows{orders, make_design(orders, ArxOffset::kEstimate, true), signals->offset, {}, {}};
  const LagLayout& layout = rows.design.layout;
  const RowPlan plan = plan_rows(*signals, layout, orders.history());
  if (plan.rows == 0) return Error{"no row of the recordings has all the samples that the orders ask for"};
  rows.phi.setOnes(static_cast<Index>(plan.rows), layout.size());
  rows.y.resize(rows.rows(), rows.outputs());
  ScaledBlock block(*signals, orders.history());
  for (const RowRun& run : plan.runs) {
    block.load(run);
    const auto at = static_cast<Index>(rows.places.size()), size = static_cast<Index>(block.rows());
    rows.runs.push_back({at, at + size});
    for (std::size_t t = run.begin; t < run.end; ++t) rows.places.push_back({run.recording, t});
    for (int c = 0; c < layout.size(); ++c) {
      if (layout[c].channel == kConstantChannel) continue;
      rows.phi.col(c).segment(at, size) = Eigen::Map<const VectorXd>(block.series(layout[c]), size);
    }
  }
  for (int i = 0; i < rows.outputs(); ++i) rows.y.col(i) = rows.phi.col(layout.target(i));
  return rows;
}

Rows share_of(const Rows& rows, double from, double to) {
  Rows part{rows.orders, rows.design, rows.offset, {}, {}};
  std::vector<Index> taken;
  for (const auto& run : rows.runs) {
    const auto size = static_cast<double>(run.end - run.begin);
    const auto begin = run.begin + static_cast<Index>(from * size), end = run.begin + static_cast<Index>(to * size);
    if (end <= begin) continue;
    const auto at = static_cast<Index>(taken.size());
    part.runs.push_back({at, at + end - begin});
    for (auto t = begin; t < end; ++t) taken.push_back(t);
  }
  part.phi = rows.phi(taken, Eigen::all);
  part.y = rows.y(taken, Eigen::all);
  for (auto t : taken) part.places.push_back(rows.places[static_cast<std::size_t>(t)]);
  return part;
}

Chain chain_of(const SwitchedArxModel& model, const Rows& rows) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const LagLayout& layout = rows.design.layout;
  Chain out;
  for (const ArxMode& mode : model.modes) {
    MatrixXd theta = MatrixXd::Zero(layout.size(), rows.outputs());
    for (int i = 0; i < rows.outputs(); ++i) {
      const auto& columns = rows.design.groups[i].columns;
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const double value = c + 1 < columns.size() ? mode.theta[i][c] : mode.constant[i];
        theta(columns[c], i) = value * sign_of(layout[columns[c]], rows.outputs());
      }
    }
    out.modes.push_back(
        {std::move(theta), Eigen::Map<const RowMajor>(mode.shock.data(), rows.outputs(), rows.outputs())});
  }
  const auto count = static_cast<Index>(model.modes.size());
  out.initial = Eigen::Map<const VectorXd>(model.initial.data(), count);
  out.transitions = Eigen::Map<const RowMajor>(model.transitions.data(), count, count);
  return out;
}

ArxMode model_mode(const Mode& mode, const Rows& rows) {
  ArxMode out;
  for (int i = 0; i < rows.outputs(); ++i) {
    std::vector<double>& row = out.theta.emplace_back();
    for (const int column : rows.design.groups[i].columns) {
      row.push_back(mode.theta(column, i) * sign_of(rows.design.layout[column], rows.outputs()));
    }
    out.constant.push_back(row.back());
    row.pop_back();
    for (int j = 0; j < rows.outputs(); ++j) out.shock.push_back(j <= i ? mode.factor(i, j) : 0.0);
  }
  return out;
}

SwitchedArxModel model_of(const Chain& chain, const Rows& rows) {
  const auto outputs = rows.offset.begin() + rows.outputs();
  SwitchedArxModel model{rows.orders, {rows.offset.begin(), outputs}, {outputs, rows.offset.end()}, {}, {}, {}};
  for (const Mode& mode : chain.modes) model.modes.push_back(model_mode(mode, rows));
  model.initial.assign(chain.initial.begin(), chain.initial.end());
  for (const auto& from : chain.transitions.rowwise()) {
    model.transitions.insert(model.transitions.end(), from.begin(), from.end());
  }
  return model;
}

Mode fit_mode(const Rows& rows, const VectorXd& weights, const VectorXd& min_variance) {
  Mode mode{weighted_theta(rows, weights), {}};
  mode.factor = residual_factor(residuals(rows, mode.theta), weights, min_variance);
  return mode;
}

bool limit_radius(double max_radius, const Rows& rows, const VectorXd& weights, const VectorXd& min_variance,
                  Mode& mode) {
  const LagLayout& layout = rows.design.layout;
  const double radius = spectral_radius(mode_model(model_of({{mode}, {}, {}}, rows), 0));
  if (radius <= max_radius) return false;
  for (int c = 0; c < layout.size(); ++c) {
    if (sign_of(layout[c], rows.outputs()) < 0) mode.theta.row(c) *= std::pow(max_radius / radius, layout[c].lag);
  }
  mode.theta.row(layout.find({kConstantChannel, 0})) +=
      weights.transpose() * residuals(rows, mode.theta) / std::max(weights.sum(), 1e-9);
  mode.factor = residual_factor(residuals(rows, mode.theta), weights, min_variance);
  return true;
}

MatrixXd log_densities(const Chain& chain, const Rows& rows) {
  MatrixXd out(rows.rows(), static_cast<Index>(chain.modes.size()));
  const RowVectorXd least = 1e-9 * rows.y.cwiseAbs().colwise().maxCoeff().cwiseMax(1e-150);  // a mode without noise
  for (std::size_t k = 0; k < chain.modes.size(); ++k) {
    MatrixXd factor = chain.modes[k].factor;
    double size = 0.5 * rows.outputs() * std::log(2 * std::numbers::pi);
    for (int i = 0; i < rows.outputs(); ++i) {
      factor(i, i) = std::max(factor(i, i), least(i));
      size += std::log(factor(i, i));
    }
    const MatrixXd white =
        factor.triangularView<Eigen::Lower>().solve(residuals(rows, chain.modes[k].theta).transpose());
    out.col(static_cast<Index>(k)) = -0.5 * white.colwise().squaredNorm().transpose().array() - size;
  }
  return out;
}

Belief believe(const Chain& chain, const Rows& rows) {
  const MatrixXd log_density = log_densities(chain, rows);
  const Index n = rows.rows(), count = log_density.cols();
  Belief out{MatrixXd(n, count), MatrixXd(n, count), MatrixXd::Zero(count, count), VectorXd(n)};
  MatrixXd filtered(n, count);
  for (const auto& run : rows.runs) {
    for (auto t = run.begin; t < run.end; ++t) {
      out.given_past.row(t) = t == run.begin ? RowVectorXd(chain.initial.transpose())
                                             : RowVectorXd(filtered.row(t - 1) * chain.transitions);
      const double most = log_density.row(t).maxCoeff();
      const RowVectorXd joint = out.given_past.row(t).array() * (log_density.row(t).array() - most).exp();
      const double sum = std::max(joint.sum(), 1e-300);
      filtered.row(t) = joint / sum;
      out.log_likelihood(t) = most + std::log(sum);
    }
    out.given_all.row(run.end - 1) = filtered.row(run.end - 1);
    for (auto t = run.end - 1; t-- > run.begin;) {
      const VectorXd next = out.given_all.row(t + 1).array() / out.given_past.row(t + 1).array().max(1e-300);
      const MatrixXd joint = (filtered.row(t).transpose() * next.transpose()).cwiseProduct(chain.transitions);
      out.steps += joint;
      out.given_all.row(t) = joint.rowwise().sum().transpose() / std::max(joint.sum(), 1e-300);
    }
  }
  return out;
}

std::vector<int> Belief::likeliest() const {
  std::vector<int> out;
  for (Index t = 0; t < given_all.rows(); ++t) {
    Index best = 0;
    given_all.row(t).maxCoeff(&best);
    out.push_back(static_cast<int>(best));
  }
  return out;
}

}  // namespace wisp::markov
