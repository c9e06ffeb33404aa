#include "learn/markov/markov_rows.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include <string>

#include "base/statistics.hpp"
#include "learn/fit/arx_fit.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/numeric/decompositions.hpp"

namespace wisp::markov {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

Result<Rows> rows_of(const SwitchedArxModel& model, const Recording& recording, const ChannelChoice& channels) {
  if (auto ok = check(model); !ok) return ok.error();
  std::vector<double> offset = model.output_mean;
  offset.insert(offset.end(), model.input_mean.begin(), model.input_mean.end());
  return make_rows({&recording, 1}, channels, model.orders, std::move(offset));
}

// Outputs, then inputs, as deviations from the operating point; simulation overwrites the outputs.
using Series = std::vector<std::vector<double>>;

Series deviations(const Rows& rows, const Recording& recording, const ChannelChoice& channels) {
  Series all;
  for (const auto* names : {&channels.outputs, &channels.inputs}) {
    for (const std::string& name : *names) {
      all.push_back(recording.channels[*find_channel(recording, name)].samples);
      for (double& x : all.back()) x -= rows.offset[all.size() - 1];
    }
  }
  return all;
}

class Predictor {
 public:
  Predictor(const SwitchedArxModel& model, const Rows& rows, const Series& measured)
      : chain_(chain_of(model, rows)), rows_(rows), measured_(measured), series_(measured) {
    belief_row_.assign(measured.front().size(), -1);
    for (std::size_t r = 0; r < rows.places.size(); ++r) belief_row_[rows.places[r].row] = static_cast<Index>(r);
    given_past_ = believe(chain_, rows).given_past;
  }

  // Predicts every row from the samples up to `steps` rows before it, or, for kFreeRun, from the episode's first rows.
  void predict(const Episode& episode, int steps, Series& out) {
    const std::size_t first = episode.begin + static_cast<std::size_t>(rows_.orders.history());
    if (steps == kFreeRun) {
      RowVectorXd chance;
      for (std::size_t t = first; t < episode.end; ++t) show(t, step(t, t == first, chance), out);
      return;
    }
    const auto back = static_cast<std::size_t>(steps - 1);
    for (std::size_t t = first + back; t < episode.end; ++t) {
      RowVectorXd chance, next;
      for (std::size_t s = t - back; s <= t && next.allFinite(); ++s) next = step(s, s == t - back, chance);
      show(t, next, out);
      for (std::size_t i = 0; i < out.size(); ++i) {
        for (std::size_t s = t - back; s <= t; ++s) series_[i][s] = measured_[i][s];
      }
    }
  }

 private:
  // Returns the mean of row t over the modes, stored in series_ for later rows; NaN, not stored, where a sample is
  // missing. `chance`: probabilities of the modes at row t − 1, unused if `first`; receives the probabilities at row t.
  RowVectorXd step(std::size_t t, bool first, RowVectorXd& chance) {
    const Index known = belief_row_[t];
    chance = !first       ? RowVectorXd(chance * chain_.transitions)
             : known >= 0 ? RowVectorXd(given_past_.row(known))
                          : RowVectorXd(chain_.initial.transpose());
    const LagLayout& layout = rows_.design.layout;
    RowVectorXd phi = RowVectorXd::Ones(layout.size());
    for (int c = 0; c < layout.size(); ++c) {
      const auto [channel, lag] = layout[c];
      if (channel == kConstantChannel) continue;
      const bool target = channel < rows_.outputs() && lag == 0;
      phi(c) = target ? 0 : series_[static_cast<std::size_t>(channel)][t - static_cast<std::size_t>(lag)];
    }
    if (!phi.allFinite()) return RowVectorXd::Constant(rows_.outputs(), kMissing);
    RowVectorXd next = RowVectorXd::Zero(rows_.outputs());
    for (std::size_t k = 0; k < chain_.modes.size(); ++k) {
      next += chance(static_cast<Index>(k)) * (phi * chain_.modes[k].theta);
    }
    for (Index i = 0; i < next.size(); ++i) series_[static_cast<std::size_t>(i)][t] = next(i);
    return next;
  }

  static void show(std::size_t t, const RowVectorXd& next, Series& out) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i][t] = next(static_cast<Index>(i));
  }

  Chain chain_;
  const Rows& rows_;
  const Series& measured_;
  Series series_;
  std::vector<Index> belief_row_;
  Eigen::MatrixXd given_past_;
};

constexpr double kRidge = 1e-9;  // added to the Gram matrix of scaled columns: gives columns of zeros the coefficient 0

std::vector<double> means_of(const Signals& signals) {
  std::vector<double> means;
  for (std::size_t c = 0; c < signals.names.size(); ++c) {
    std::vector<double> all;
    for (const auto& recording : signals.samples) all.insert(all.end(), recording[c].begin(), recording[c].end());
    means.push_back(mean(present(std::move(all))));
  }
  return means;
}

MatrixXd residuals(const Rows& rows, const MatrixXd& theta) { return rows.y - rows.phi * theta; }

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

// ln of the Gaussian density of every row's outputs under every mode, rows × modes.
MatrixXd log_densities(const Chain& chain, const Rows& rows) {
  MatrixXd out(rows.rows(), static_cast<Index>(chain.modes.size()));
  const RowVectorXd least = 1e-9 * rows.y.cwiseAbs().colwise().maxCoeff().cwiseMax(1e-150);  // floor of the noise
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

}  // namespace

Result<Belief> believe(const SwitchedArxModel& model, const Recording& recording, const ChannelChoice& channels) {
  const auto rows = rows_of(model, recording, channels);
  if (!rows) return rows.error();
  return believe(chain_of(model, *rows), *rows);
}

Result<Series> predict(const SwitchedArxModel& model, const Recording& recording, const ChannelChoice& channels,
                       int steps) {
  if (auto ok = check_steps({&steps, 1}); !ok) return ok.error();
  const auto rows = rows_of(model, recording, channels);
  if (!rows) return rows.error();
  const Series measured = deviations(*rows, recording, channels);
  Predictor predictor(model, *rows, measured);
  Series out(channels.outputs.size(), std::vector<double>(recording.rows(), kMissing));
  for (const Episode& episode : episodes(recording)) predictor.predict(episode, steps, out);
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (double& y : out[i]) y += model.output_mean[i];
  }
  return out;
}

Result<PredictionFigures> figures(const SwitchedArxModel& model, std::span<const Recording> recordings,
                                  const ChannelChoice& channels, int steps) {
  std::vector<Series> predicted;
  for (const Recording& recording : recordings) {
    auto one = predict(model, recording, channels, steps);
    if (!one) return one.error();
    predicted.push_back(std::move(*one));
  }
  PredictionFigures out;
  out.steps = steps;
  for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
    double count = 0, error = 0, sum = 0, square = 0, size = 0;
    for (std::size_t r = 0; r < predicted.size(); ++r) {
      const auto& measured = recordings[r].channels[*find_channel(recordings[r], channels.outputs[i])].samples;
      for (std::size_t t = 0; t < measured.size(); ++t) {
        const double y = measured[t] - model.output_mean[i], e = measured[t] - predicted[r][i][t];
        if (std::isnan(e)) continue;
        ++count, error += e * e, size += std::abs(e), sum += y, square += y * y;
      }
    }
    out.rows = static_cast<std::size_t>(count);
    count = std::max(count, 1.0);
    const double spread = square - sum * sum / count;
    out.mean_square.push_back(error / count);
    out.fit_percent.push_back(spread > 1e-13 * square ? 100 * (1 - std::sqrt(error / spread)) : 0);
    out.j.push_back(size / count);
  }
  if (out.rows == 0) return Error{recordings.front().source + ": is too short to predict any row"};
  return out;
}

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
  const auto radius_of = [&] { return spectral_radius(mode_model(model_of({{mode}, {}, {}}, rows), 0)); };
  double radius = radius_of();
  if (radius <= max_radius) return false;
  double most = max_radius;
  do {  // again where coefficients in single precision leave poles that cluster outside
    for (int c = 0; c < layout.size(); ++c) {
      if (sign_of(layout[c], rows.outputs()) < 0) mode.theta.row(c) *= std::pow(most / radius, layout[c].lag);
    }
    radius = radius_of(), most *= max_radius;
  } while (radius >= 1);
  mode.theta.row(layout.find({kConstantChannel, 0})) +=
      weights.transpose() * residuals(rows, mode.theta) / std::max(weights.sum(), 1e-9);
  mode.factor = residual_factor(residuals(rows, mode.theta), weights, min_variance);
  return true;
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
