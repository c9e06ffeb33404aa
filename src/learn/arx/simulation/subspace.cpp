#include "learn/arx/simulation/subspace.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "learn/arx/simulation/drive_fit.hpp"
#include "learn/numeric/decompositions.hpp"
#include "learn/numeric/lag_gram.hpp"

namespace wisp::arx {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr int kMinHorizon = 3;    // of past and of future
constexpr int kMaxColumns = 800;  // of both together
constexpr double kRowsAColumn = 1.5;
constexpr double kRidge = 1e-10;    // of every column's own energy: the Gram matrix has no more digits
constexpr double kNothing = 1e-12;  // a squared strength below this share of the largest is rounding
constexpr double kMinNoise = 1e-5;  // in shares of an output's size

// One lag of outputs and no delay: every row whose inputs are there is simulated.
ArxOrders one_lag(const Signals& signals, const std::vector<int>& outputs) {
  ArxOrders orders{OrderMatrix(signals.outputs, signals.outputs), OrderMatrix(signals.outputs, signals.inputs),
                   OrderMatrix(signals.outputs, signals.inputs)};
  for (int i : outputs) {
    for (int j : outputs) orders.na(i, j) = 1;
    for (int k = 0; k < signals.inputs; ++k) orders.nb(i, k) = 1;
  }
  return orders;
}

// Columns of all channels over a window of rows; its last row is lag 0.
struct Window {
  std::vector<int> channels;
  LagLayout layout;

  Window(const Signals& signals, const std::vector<int>& outputs, int rows)
      : channels(channels_of(signals, outputs)), layout(signals.outputs, signals.inputs, used(channels, rows)) {}

  static std::vector<int> channels_of(const Signals& signals, const std::vector<int>& outputs) {
    std::vector<int> channels = outputs;
    for (int k = 0; k < signals.inputs; ++k) channels.push_back(signals.outputs + k);
    return channels;
  }

  static std::vector<LaggedChannel> used(const std::vector<int>& channels, int rows) {
    std::vector<LaggedChannel> out;
    for (int channel : channels) {
      for (int lag = 0; lag < rows; ++lag) out.push_back({channel, lag});
    }
    return out;
  }

  // Columns of channels [first, last) at lags from `oldest` down to `newest`, row by row.
  void append(std::size_t first, std::size_t last, int oldest, int newest, std::vector<int>& columns) const {
    for (int lag = oldest; lag >= newest; --lag) {
      for (std::size_t c = first; c < last; ++c) columns.push_back(layout.find({channels[c], lag}));
    }
  }
};

VectorXcd mirrored(VectorXcd poles, double most) {
  for (auto& pole : poles) {
    const double size = std::abs(pole);
    if (size >= 1) pole *= std::min(1 / size, most) / size;
  }
  return poles;
}

}  // namespace

Subspace::Subspace(const Signals& signals, const std::vector<int>& outputs, bool constant)
    : block_(signals, one_lag(signals, outputs), outputs, constant, 1), constant_(constant) {
  if (block_.runs().empty() || !(block_.weight().array() > 0).all() || signals.inputs == 0) return;
  for (double scale : signals.scale) {
    if (scale == 0) return;
  }
  const int channels = block_.size() + block_.inputs();
  horizon_ = std::min(kStateSpaceLags, kMaxColumns / (2 * channels));
  for (; horizon_ >= kMinHorizon; --horizon_) {
    const Window window(signals, block_.outputs(), 2 * horizon_);
    const RowPlan plan = plan_rows(signals, window.layout, window.layout.history());
    if (static_cast<double>(plan.rows) >= kRowsAColumn * 2 * horizon_ * channels) break;
  }
  if (horizon_ >= kMinHorizon) find_observability(signals);
}

void Subspace::find_observability(const Signals& signals) {
  const Window window(signals, block_.outputs(), 2 * horizon_);
  const RowPlan plan = plan_rows(signals, window.layout, window.layout.history());
  const auto outputs = static_cast<std::size_t>(block_.size()), all = window.channels.size();
  std::vector<int> columns;  // future inputs, the past, future outputs
  window.append(outputs, all, horizon_ - 1, 0, columns);
  const auto inputs = Index(columns.size());
  window.append(0, all, 2 * horizon_ - 1, horizon_, columns);
  const auto given = Index(columns.size());
  window.append(0, outputs, horizon_ - 1, 0, columns);
  const Index told = Index(columns.size()) - given;
  const ChannelPairs pairs = ChannelPairs::Constant(window.layout.channels(), window.layout.channels(), true);
  MatrixXd gram = lag_gram(signals, plan, window.layout, pairs)(columns, columns);
  gram.diagonal() *= 1 + kRidge;
  const Eigen::LLT<MatrixXd> factor(gram.topLeftCorner(given, given));
  const MatrixXd of_told = factor.matrixL().solve(gram.topRightCorner(given, told));
  const MatrixXd of_past = of_told.bottomRows(given - inputs);
  const SymmetricEigensystem system = symmetric_eigensystem(of_past.transpose() * of_past);
  if (!system.values.allFinite()) return;
  const Index most = std::min<Index>(Index{horizon_ - 1} * block_.size(), told);
  Index states = 0;
  while (states < most && system.values[told - 1 - states] > kNothing * system.values[told - 1]) ++states;
  strength_ = system.values.tail(states).reverse().cwiseSqrt();
  direction_ = system.vectors.rightCols(states).rowwise().reverse();
  const Index first = block_.size();
  const VectorXd energy = gram.diagonal().segment(given, first);
  const VectorXd rest = energy - of_told.leftCols(first).colwise().squaredNorm().transpose();
  noise_ = rest.cwiseMax(kMinNoise * kMinNoise * energy).cwiseSqrt() / std::sqrt(static_cast<double>(plan.rows));
}

std::optional<StateSpace> Subspace::model(int states, double most) const {
  const Index n = std::min(states, max_states()), outputs = block_.size();
  if (n == 0) return std::nullopt;
  const MatrixXd effect = direction_.leftCols(n) * strength_.head(n).cwiseSqrt().asDiagonal();
  const Index rows = effect.rows() - outputs;
  const MatrixXd step = effect.topRows(rows).householderQr().solve(effect.bottomRows(rows));
  if (!step.allFinite()) return std::nullopt;
  const Eigensystem system = eigensystem(step);
  const VectorXcd modes = mirrored(system.values, most);
  const MatrixXcd shapes = effect.topRows(outputs) * system.right;
  const Drive drive = fit_drive(block_, modes, shapes, constant_);
  StateSpace out{step, (system.right * drive.b).real(), effect.topRows(outputs), drive.d, drive.level, noise_};
  if (modes != system.values) out.a = (system.right * modes.asDiagonal() * system.left).real();
  if (!out.a.allFinite() || !out.b.allFinite() || !out.d.allFinite() || !out.level.allFinite()) return std::nullopt;
  return out;
}

}  // namespace wisp::arx
