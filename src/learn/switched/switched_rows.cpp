#include "learn/switched/switched_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "learn/arx/fit/arx_check.hpp"
#include "learn/arx/rows/arx_design.hpp"
#include "learn/arx/rows/arx_rows.hpp"

namespace wisp {
namespace {

void add_scale(std::span<const Recording> recordings, const std::string& name, bool subtract_mean,
               std::vector<double>& means, std::vector<double>& sizes) {
  double count = 0, mean = 0, square = 0;
  for (const Recording& recording : recordings) {
    for (double x : recording.channels[*find_channel(recording, name)].samples) {
      if (std::isnan(x)) continue;
      ++count;
      const double step = x - mean;
      mean += step / count;
      square += step * (x - mean);
    }
  }
  const double sd = count > 0 ? std::sqrt(square / count) : 0;
  means.push_back(subtract_mean ? mean : 0);
  sizes.push_back(sd > 0 && std::isfinite(sd) ? sd : 1);
}

// Where a regressor stands in phi.
int column_of(const std::vector<RegionSample>& samples, int outputs, const LaggedChannel& wanted) {
  if (wanted.channel == kConstantChannel) return 0;
  const bool input = wanted.channel >= outputs;
  const RegionSample sample{input, input ? wanted.channel - outputs : wanted.channel, wanted.lag};
  return 1 + static_cast<int>(std::find(samples.begin(), samples.end(), sample) - samples.begin());
}

std::vector<std::vector<int>> columns_of(const ArxOrders& orders, const std::vector<RegionSample>& samples) {
  std::vector<std::vector<int>> rows;
  for (int i = 0; i < orders.outputs(); ++i) {
    std::vector<int>& row = rows.emplace_back();
    for (const LaggedChannel& column : row_regressors(orders, i, ArxOffset::kEstimate)) {
      row.push_back(column_of(samples, orders.outputs(), column));
    }
  }
  return rows;
}

// The channels about the operating point.
Result<Signals> signals_about(std::span<const Recording> recordings, const ChannelChoice& channels,
                              const SwitchedScales& scales) {
  auto signals = find_signals(recordings, channels);
  if (!signals) return signals;
  signals->offset = scales.output_mean;
  signals->offset.insert(signals->offset.end(), scales.input_mean.begin(), scales.input_mean.end());
  return signals;
}

Eigen::MatrixXd lower_factor(const std::vector<double>& shock, const SwitchedRows& rows) {
  const int ny = rows.outputs();
  Eigen::MatrixXd factor(ny, ny);
  for (int i = 0; i < ny; ++i) {
    for (int j = 0; j < ny; ++j) {
      factor(i, j) = shock[static_cast<std::size_t>(i) * ny + j] / rows.scales.output_size[i];
    }
  }
  return factor;
}

double size_of(const RegionSample& sample, const SwitchedScales& scales) {
  return (sample.input ? scales.input_size : scales.output_size)[static_cast<std::size_t>(sample.channel)];
}

}  // namespace

SwitchedScales scales_of(std::span<const Recording> recordings, const ChannelChoice& channels, bool subtract_means) {
  SwitchedScales scales;
  for (const auto& name : channels.outputs)
    add_scale(recordings, name, subtract_means, scales.output_mean, scales.output_size);
  for (const auto& name : channels.inputs)
    add_scale(recordings, name, subtract_means, scales.input_mean, scales.input_size);
  return scales;
}

Result<void> check_switched_data(std::span<const Recording> recordings, const ChannelChoice& channels,
                                 const ArxOrders& orders) {
  for (const Recording& recording : recordings) {
    if (auto ok = check(recording); !ok) return Error{recording.source + ": " + ok.error().message};
  }
  if (const auto signals = find_signals(recordings, channels); !signals) return signals.error();
  return check_orders(orders, channels);
}

Result<SwitchedRows> make_switched_rows(std::span<const Recording> recordings, const ChannelChoice& channels,
                                        const ArxOrders& orders, const SwitchedScales& scales) {
  const auto signals = signals_about(recordings, channels, scales);
  if (!signals) return signals.error();
  SwitchedRows rows{orders, scales, region_samples(orders), {}, {}, {}, {}, {}};
  rows.columns = columns_of(orders, rows.samples);
  const RowPlan plan = plan_rows(*signals, make_design(orders, ArxOffset::kEstimate).layout, orders.history());
  if (plan.rows == 0) return Error{"no row of the recordings has all the samples that the orders ask for"};
  const auto count = static_cast<Eigen::Index>(plan.rows);
  rows.phi.resize(count, static_cast<Eigen::Index>(1 + rows.samples.size()));
  rows.phi.col(0).setOnes();
  rows.y.resize(count, rows.outputs());
  ScaledBlock block(*signals, orders.history());
  const auto series = [&](const LaggedChannel& column) {
    return Eigen::Map<const Eigen::VectorXd>(block.series(column), static_cast<Eigen::Index>(block.rows()));
  };
  for (const RowRun& run : plan.runs) {
    block.load(run);
    const auto at = static_cast<Eigen::Index>(rows.places.size()), size = static_cast<Eigen::Index>(block.rows());
    rows.runs.push_back({at, at + size});
    for (std::size_t t = run.begin; t < run.end; ++t) rows.places.push_back({run.recording, t});
    for (std::size_t c = 0; c < rows.samples.size(); ++c) {
      const RegionSample& sample = rows.samples[c];
      rows.phi.col(static_cast<Eigen::Index>(c) + 1).segment(at, size) =
          series({sample.input ? rows.outputs() + sample.channel : sample.channel, sample.lag}) /
          size_of(sample, scales);
    }
    for (int i = 0; i < rows.outputs(); ++i) {
      rows.y.col(i).segment(at, size) = series({i, 0}) / scales.output_size[i];
    }
  }
  return rows;
}

SwitchedRows share_of(const SwitchedRows& rows, double from, double to) {
  SwitchedRows part{rows.orders, rows.scales, rows.samples, rows.columns, {}, {}, {}, {}};
  std::vector<Eigen::Index> taken;
  for (const auto& run : rows.runs) {
    const auto size = static_cast<double>(run.end - run.begin);
    const auto begin = run.begin + static_cast<Eigen::Index>(from * size);
    const auto end = run.begin + static_cast<Eigen::Index>(to * size);
    if (end <= begin) continue;
    const auto at = static_cast<Eigen::Index>(taken.size());
    part.runs.push_back({at, at + end - begin});
    for (auto t = begin; t < end; ++t) taken.push_back(t);
  }
  part.phi = rows.phi(taken, Eigen::all);
  part.y = rows.y(taken, Eigen::all);
  for (auto t : taken) part.places.push_back(rows.places[static_cast<std::size_t>(t)]);
  return part;
}

double coefficient_scale(const SwitchedRows& rows, int output, int column) {
  const double own = rows.scales.output_size[output];
  if (column == 0) return own;
  const RegionSample& sample = rows.samples[column - 1];
  return (sample.input ? own : -own) / size_of(sample, rows.scales);
}

ScaledModes scaled_modes(const SwitchedArxModel& model, const SwitchedRows& rows) {
  ScaledModes out;
  out.switching = model.switching;
  const auto width = static_cast<Eigen::Index>(1 + rows.samples.size());
  for (const ArxMode& mode : model.modes) {
    Eigen::MatrixXd theta = Eigen::MatrixXd::Zero(width, rows.outputs());
    for (int i = 0; i < rows.outputs(); ++i) {
      const auto& columns = rows.columns[i];
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const double value = c + 1 < columns.size() ? mode.theta[i][c] : mode.constant[i];
        theta(columns[c], i) = value / coefficient_scale(rows, i, columns[c]);
      }
    }
    out.theta.push_back(std::move(theta));
    out.factor.push_back(lower_factor(mode.shock, rows));
  }
  const auto modes = static_cast<Eigen::Index>(model.modes.size());
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  if (model.switching == Switching::kMarkov) {
    out.initial = Eigen::Map<const Eigen::VectorXd>(model.initial.data(), modes);
    out.transitions = Eigen::Map<const Rows>(model.transitions.data(), modes, modes);
    return out;
  }
  out.regions = Eigen::Map<const Rows>(model.regions.data(), modes, width);
  for (Eigen::Index c = 1; c < width; ++c) out.regions.col(c) *= size_of(rows.samples[c - 1], rows.scales);
  return out;
}

SwitchedArxModel model_of(const ScaledModes& modes, const SwitchedRows& rows) {
  SwitchedArxModel model{rows.orders, rows.scales.output_mean, rows.scales.input_mean, {}, modes.switching, {}, {}, {},
                         {}};
  const int ny = rows.outputs();
  for (int k = 0; k < modes.modes(); ++k) {
    ArxMode mode;
    for (int i = 0; i < ny; ++i) {
      std::vector<double>& row = mode.theta.emplace_back();
      for (int column : rows.columns[i]) row.push_back(modes.theta[k](column, i) * coefficient_scale(rows, i, column));
      mode.constant.push_back(row.back());
      row.pop_back();
      for (int j = 0; j < ny; ++j) {
        mode.shock.push_back(j <= i ? modes.factor[k](i, j) * rows.scales.output_size[i] : 0.0);
      }
    }
    model.modes.push_back(std::move(mode));
  }
  for (int k = 0; k < modes.modes(); ++k) {
    if (modes.switching == Switching::kMarkov) {
      model.initial.push_back(modes.initial(k));
      for (int to = 0; to < modes.modes(); ++to) model.transitions.push_back(modes.transitions(k, to));
      continue;
    }
    for (Eigen::Index c = 0; c < modes.regions.cols(); ++c) {
      model.regions.push_back(modes.regions(k, c) / (c == 0 ? 1.0 : size_of(rows.samples[c - 1], rows.scales)));
    }
  }
  return model;
}

Eigen::MatrixXd log_densities(const ScaledModes& modes, const SwitchedRows& rows) {
  Eigen::MatrixXd out(rows.rows(), modes.modes());
  for (int k = 0; k < modes.modes(); ++k) {
    const Eigen::MatrixXd residual = (rows.y - rows.phi * modes.theta[k]).transpose();
    Eigen::MatrixXd factor = modes.factor[k];
    for (int i = 0; i < rows.outputs(); ++i) factor(i, i) = std::max(factor(i, i), 1e-9);  // a mode without noise
    const Eigen::MatrixXd white = factor.triangularView<Eigen::Lower>().solve(residual);
    double size = 0.5 * rows.outputs() * std::log(2 * std::numbers::pi);
    for (int i = 0; i < rows.outputs(); ++i) size += std::log(factor(i, i));
    out.col(k) = -0.5 * white.colwise().squaredNorm().transpose().array() - size;
  }
  return out;
}

std::vector<int> region_modes(const ScaledModes& modes, const SwitchedRows& rows) {
  const Eigen::MatrixXd score = rows.phi * modes.regions.transpose();
  std::vector<int> out;
  for (Eigen::Index t = 0; t < rows.rows(); ++t) {
    Eigen::Index best = 0;
    score.row(t).maxCoeff(&best);
    out.push_back(static_cast<int>(best));
  }
  return out;
}

ModeBelief believe(const ScaledModes& modes, const SwitchedRows& rows, const Eigen::MatrixXd& log_density) {
  const Eigen::Index n = rows.rows(), count = modes.modes();
  ModeBelief out{Eigen::MatrixXd(n, count), Eigen::MatrixXd(n, count), Eigen::MatrixXd::Zero(count, count),
                 Eigen::VectorXd(n)};
  Eigen::MatrixXd filtered(n, count);
  for (const auto& run : rows.runs) {
    for (auto t = run.begin; t < run.end; ++t) {
      const Eigen::RowVectorXd before = t == run.begin ? Eigen::RowVectorXd(modes.initial.transpose())
                                                       : Eigen::RowVectorXd(filtered.row(t - 1) * modes.transitions);
      out.given_past.row(t) = before;
      const double most = log_density.row(t).maxCoeff();
      const Eigen::RowVectorXd joint = before.array() * (log_density.row(t).array() - most).exp();
      const double sum = std::max(joint.sum(), 1e-300);
      filtered.row(t) = joint / sum;
      out.log_likelihood(t) = most + std::log(sum);
    }
    out.given_all.row(run.end - 1) = filtered.row(run.end - 1);
    for (auto t = run.end - 1; t-- > run.begin;) {
      const Eigen::ArrayXd next = out.given_all.row(t + 1).array() / out.given_past.row(t + 1).array().max(1e-300);
      const Eigen::MatrixXd joint =
          (filtered.row(t).transpose() * next.matrix().transpose()).cwiseProduct(modes.transitions);
      out.steps += joint;
      out.given_all.row(t) = joint.rowwise().sum().transpose();
      out.given_all.row(t) /= std::max(out.given_all.row(t).sum(), 1e-300);
    }
  }
  return out;
}

std::vector<double> row_log_likelihoods(const ScaledModes& modes, const SwitchedRows& rows) {
  const Eigen::MatrixXd density = log_densities(modes, rows);
  std::vector<double> out;
  if (modes.switching == Switching::kMarkov) {
    const ModeBelief belief = believe(modes, rows, density);
    return {belief.log_likelihood.begin(), belief.log_likelihood.end()};
  }
  const std::vector<int> mode = region_modes(modes, rows);
  for (Eigen::Index t = 0; t < rows.rows(); ++t) out.push_back(density(t, mode[static_cast<std::size_t>(t)]));
  return out;
}

std::vector<int> likeliest_modes(const ScaledModes& modes, const SwitchedRows& rows) {
  if (modes.switching == Switching::kRegions) return region_modes(modes, rows);
  const ModeBelief belief = believe(modes, rows, log_densities(modes, rows));
  std::vector<int> out;
  for (Eigen::Index t = 0; t < rows.rows(); ++t) {
    Eigen::Index best = 0;
    belief.given_all.row(t).maxCoeff(&best);
    out.push_back(static_cast<int>(best));
  }
  return out;
}

}  // namespace wisp
