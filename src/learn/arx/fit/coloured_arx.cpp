#include "wisp/learn/coloured_arx.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string>

namespace wisp {
namespace {

constexpr int kMostNoiseOrder = 64;
constexpr double kSettled = 1e-9;    // of the loss: what a further pass must gain
constexpr int kMostHalvings = 20;    // of a step
constexpr double kRankLost = 1e-13;  // of the largest pivot

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

// Deviations of a run of complete rows: outputs, then inputs, as columns.
using Run = Matrix;

struct Means {
  std::vector<double> outputs;
  std::vector<double> inputs;
};

std::vector<std::string> names_of(const ChannelChoice& channels) {
  std::vector<std::string> names = channels.outputs;
  names.insert(names.end(), channels.inputs.begin(), channels.inputs.end());
  return names;
}

Result<std::vector<const std::vector<double>*>> columns_of(const Recording& recording, const ChannelChoice& channels) {
  std::vector<const std::vector<double>*> out;
  for (const std::string& name : names_of(channels)) {
    const auto index = find_channel(recording, name);
    if (!index) return Error{recording.source + ": there is no channel " + name};
    out.push_back(&recording.channels[*index].samples);
  }
  return out;
}

Result<Means> means_of(std::span<const Recording> recordings, const ChannelChoice& channels) {
  std::vector<double> sum(channels.outputs.size() + channels.inputs.size()), count(sum.size());
  for (const Recording& recording : recordings) {
    const auto columns = columns_of(recording, channels);
    if (!columns) return columns.error();
    for (std::size_t c = 0; c < sum.size(); ++c) {
      for (double x : *(*columns)[c]) {
        if (std::isnan(x)) continue;
        sum[c] += x;
        ++count[c];
      }
    }
  }
  for (std::size_t c = 0; c < sum.size(); ++c) sum[c] = count[c] > 0 ? sum[c] / count[c] : 0;
  const auto split = sum.begin() + static_cast<std::ptrdiff_t>(channels.outputs.size());
  return Means{{sum.begin(), split}, {split, sum.end()}};
}

// Maximal runs of complete rows within episodes, longer than the history.
Result<std::vector<Run>> runs_of(std::span<const Recording> recordings, const ChannelChoice& channels,
                                 const Means& means, int history) {
  std::vector<double> middle = means.outputs;
  middle.insert(middle.end(), means.inputs.begin(), means.inputs.end());
  std::vector<Run> runs;
  for (const Recording& recording : recordings) {
    const auto columns = columns_of(recording, channels);
    if (!columns) return columns.error();
    const auto complete = [&](std::size_t row) {
      return std::none_of(columns->begin(), columns->end(),
                          [&](const auto* column) { return std::isnan((*column)[row]); });
    };
    for (const Episode& episode : episodes(recording)) {
      for (std::size_t begin = episode.begin; begin < episode.end;) {
        std::size_t end = begin;
        while (end < episode.end && complete(end)) ++end;
        if (end - begin > static_cast<std::size_t>(history)) {
          Run run(static_cast<Eigen::Index>(end - begin), static_cast<Eigen::Index>(middle.size()));
          for (std::size_t c = 0; c < middle.size(); ++c) {
            for (std::size_t row = begin; row < end; ++row) {
              run(static_cast<Eigen::Index>(row - begin), static_cast<Eigen::Index>(c)) =
                  (*(*columns)[c])[row] - middle[c];
            }
          }
          runs.push_back(std::move(run));
        }
        begin = end + 1;
      }
    }
  }
  return runs;
}

// One output's regression over one run: what it was, and its regressors without those of the noise.
struct Regression {
  Vector output;
  Matrix regressors;
};

Regression regression_of(const Run& run, const ArxOrders& orders, int i, int history) {
  const Eigen::Index rows = run.rows() - history;
  Regression out{run.col(i).tail(rows), Matrix(rows, orders.row_size(i))};
  Eigen::Index column = 0;
  for (int j = 0; j < orders.outputs(); ++j) {
    for (int lag = 1; lag <= orders.na(i, j); ++lag) {
      out.regressors.col(column++) = -run.col(j).segment(history - lag, rows);
    }
  }
  for (int k = 0; k < orders.inputs(); ++k) {
    for (int l = 0; l < orders.nb(i, k); ++l) {
      out.regressors.col(column++) = run.col(orders.outputs() + k).segment(history - orders.nk(i, k) - l, rows);
    }
  }
  return out;
}

// Σ f_l x(t − l) over l ≥ 1, from rest.
Vector lagged(const Vector& filter, const Vector& series) {
  Vector out = Vector::Zero(series.size());
  for (Eigen::Index l = 1; l <= filter.size(); ++l) {
    out.tail(std::max<Eigen::Index>(0, series.size() - l)) +=
        filter[l - 1] * series.head(std::max<Eigen::Index>(0, series.size() - l));
  }
  return out;
}

// x / (1 + f q⁻¹ + …), from rest.
Vector divided(const Vector& filter, Vector series) {
  for (Eigen::Index t = 0; t < series.size(); ++t) {
    for (Eigen::Index l = 1; l <= std::min(t, filter.size()); ++l) series[t] -= filter[l - 1] * series[t - l];
  }
  return series;
}

// What a row's parameters leave, and how that changes with them.
struct Prediction {
  Vector error;
  Matrix slope;  // −∂ error / ∂ parameters
};

// Parameters: the row's theta, then its filter.
Vector errors_of(const Regression& regression, const Vector& parameters, NoiseColour colour) {
  const Eigen::Index d = regression.regressors.cols();
  const Vector left = regression.output - regression.regressors * parameters.head(d);
  const Vector filter = parameters.tail(parameters.size() - d);
  if (colour == NoiseColour::kAutoregressive) return left + lagged(filter, left);
  return divided(filter, left);
}

Prediction prediction_of(const Regression& regression, const Vector& parameters, NoiseColour colour) {
  const Eigen::Index d = regression.regressors.cols();
  const Vector filter = parameters.tail(parameters.size() - d);
  Prediction out{errors_of(regression, parameters, colour), Matrix(regression.output.size(), parameters.size())};
  const Vector left = regression.output - regression.regressors * parameters.head(d);
  for (Eigen::Index c = 0; c < d; ++c) {
    const Vector regressor = regression.regressors.col(c);
    const bool sums = colour == NoiseColour::kAutoregressive;
    out.slope.col(c) = sums ? Vector(regressor + lagged(filter, regressor)) : divided(filter, regressor);
  }
  for (Eigen::Index l = 1; l <= filter.size(); ++l) {
    Vector one = Vector::Zero(l);
    one[l - 1] = 1;
    const bool sums = colour == NoiseColour::kAutoregressive;
    out.slope.col(d + l - 1) = sums ? Vector(-lagged(one, left)) : divided(filter, lagged(one, out.error));
  }
  return out;
}

double loss_of(const std::vector<Regression>& data, const Vector& parameters, NoiseColour colour) {
  double sum = 0;
  double rows = 0;
  for (const Regression& part : data) {
    sum += errors_of(part, parameters, colour).squaredNorm();
    rows += static_cast<double>(part.output.size());
  }
  return sum / rows;
}

// One output's estimate.
struct RowFit {
  Vector parameters;
  Vector std_error;
  double loss = 0;
  int passes = 0;
  bool converged = false;
  bool full_rank = true;
};

struct Normal {
  Matrix matrix;
  Vector right;
};

Normal normal_of(const std::vector<Regression>& data, const Vector& parameters, NoiseColour colour) {
  Normal out{Matrix::Zero(parameters.size(), parameters.size()), Vector::Zero(parameters.size())};
  for (const Regression& part : data) {
    const Prediction prediction = prediction_of(part, parameters, colour);
    out.matrix += prediction.slope.transpose() * prediction.slope;
    out.right += prediction.slope.transpose() * prediction.error;
  }
  return out;
}

bool full_rank(const Eigen::LDLT<Matrix>& factor) {
  const Vector pivots = factor.vectorD();
  return pivots.size() == 0 || pivots.minCoeff() > kRankLost * pivots.maxCoeff();
}

RowFit fit_row(const std::vector<Regression>& data, const ColouredArxOptions& options) {
  const NoiseColour colour = options.noise.colour;
  const Eigen::Index d = data.front().regressors.cols();
  RowFit fit;
  fit.parameters = Vector::Zero(d + options.noise.order);
  double rows = 0;
  for (const Regression& part : data) rows += static_cast<double>(part.output.size());
  // Least squares first: with a filter of nothing a step is the whole way.
  Normal normal = normal_of(data, fit.parameters, NoiseColour::kAutoregressive);
  const Eigen::LDLT<Matrix> start(Matrix(normal.matrix.topLeftCorner(d, d)));
  fit.full_rank = full_rank(start);
  if (!fit.full_rank) return fit;
  fit.parameters.head(d) = start.solve(normal.right.head(d));
  fit.loss = loss_of(data, fit.parameters, colour);
  while (!fit.converged && fit.passes < options.most_passes) {
    ++fit.passes;
    normal = normal_of(data, fit.parameters, colour);
    Vector step = normal.matrix.ldlt().solve(normal.right);
    double loss = loss_of(data, fit.parameters + step, colour);
    for (int halving = 0; !(loss <= fit.loss) && halving < kMostHalvings; ++halving) {
      step /= 2;
      loss = loss_of(data, fit.parameters + step, colour);
    }
    fit.converged = !(loss < fit.loss * (1 - kSettled));
    if (!(loss <= fit.loss)) break;
    fit.parameters += step;
    fit.loss = loss;
  }
  normal = normal_of(data, fit.parameters, colour);
  const double freedom = std::max(1.0, rows - static_cast<double>(fit.parameters.size()));
  const Matrix covariance = normal.matrix.ldlt().solve(Matrix::Identity(normal.matrix.rows(), normal.matrix.cols()));
  fit.std_error = (covariance.diagonal() * (fit.loss * rows / freedom)).cwiseMax(0.0).cwiseSqrt();
  return fit;
}

std::vector<double> plain(const Vector& values) { return {values.begin(), values.end()}; }

Result<void> check_options(std::span<const Recording> recordings, const ChannelChoice& channels,
                           const ColouredArxOptions& options) {
  const ArxOrders& orders = options.orders;
  if (recordings.empty()) return Error{"there is no recording to learn from"};
  if (orders.outputs() != static_cast<int>(channels.outputs.size()) || orders.na.columns() != orders.outputs() ||
      orders.inputs() != static_cast<int>(channels.inputs.size()) || orders.nb.rows() != orders.outputs() ||
      orders.nk.rows() != orders.outputs() || orders.nk.columns() != orders.inputs()) {
    return Error{"the orders have not the shape of the channels"};
  }
  const int least = options.noise.colour == NoiseColour::kWhite ? 0 : 1;
  if (options.noise.order < least || options.noise.order > (least == 0 ? 0 : kMostNoiseOrder)) {
    return Error{"the noise model's order is " + std::to_string(options.noise.order) + ", expected " +
                 (least == 0 ? "0 where it is white" : "1 to 64")};
  }
  if (options.most_passes < 1 || options.most_passes > 1000)
    return Error{"the number of passes is " + std::to_string(options.most_passes) + ", expected 1 to 1000"};
  return {};
}

// The first coefficients, after the leading 1, of D, or of 1/C down to what is smallest.
std::vector<double> whitener(const std::vector<double>& filter, NoiseColour colour, double smallest, int most) {
  if (colour != NoiseColour::kMovingAverage) return filter;
  Vector impulse = Vector::Zero(most + 1);
  impulse[0] = 1;
  const Vector inverse =
      divided(Eigen::Map<const Vector>(filter.data(), static_cast<Eigen::Index>(filter.size())), impulse);
  int last = most;
  while (last > 0 && std::abs(inverse[last]) < smallest) --last;
  return {inverse.begin() + 1, inverse.begin() + 1 + last};
}

// (1 + w q⁻¹ + …) times a polynomial whose coefficients begin at some lag.
std::vector<double> product(const std::vector<double>& whitening, std::span<const double> polynomial) {
  std::vector<double> out(polynomial.size() + whitening.size(), 0.0);
  for (std::size_t l = 0; l < polynomial.size(); ++l) {
    out[l] += polynomial[l];
    for (std::size_t w = 0; w < whitening.size(); ++w) out[l + w + 1] += whitening[w] * polynomial[l];
  }
  return out;
}

}  // namespace

Result<NoiseModel> parse_noise_model(std::string_view text) {
  if (text == "white") return NoiseModel{};
  const bool autoregressive = text.starts_with("ar:");
  int order = 0;
  const std::string_view number = text.substr(std::min<std::size_t>(3, text.size()));
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), order);
  const bool read = error == std::errc{} && end == number.data() + number.size();
  if ((autoregressive || text.starts_with("ma:")) && read && order >= 1 && order <= kMostNoiseOrder) {
    return NoiseModel{autoregressive ? NoiseColour::kAutoregressive : NoiseColour::kMovingAverage, order};
  }
  return Error{"the noise model is '" + std::string(text) + "', expected white, ar:N or ma:N with N from 1 to 64"};
}

Result<ColouredArxFit> fit_coloured_arx(std::span<const Recording> recordings, const ChannelChoice& channels,
                                        const ColouredArxOptions& options) {
  if (auto ok = check_options(recordings, channels, options); !ok) return ok.error();
  const auto means = means_of(recordings, channels);
  if (!means) return means.error();
  const int history = options.orders.history();
  const auto runs = runs_of(recordings, channels, *means, history);
  if (!runs) return runs.error();
  ColouredArxFit out;
  ColouredArx& model = out.model;
  const auto ny = static_cast<std::size_t>(options.orders.outputs());
  model.noise = options.noise;
  model.model = {options.orders, {}, {}, std::vector<double>(ny, 0.0), means->outputs, means->inputs, {}};
  for (const Run& run : *runs) out.samples_used += static_cast<std::size_t>(run.rows() - history);
  for (std::size_t i = 0; i < ny; ++i) {
    const Eigen::Index d = options.orders.row_size(static_cast<int>(i));
    if (out.samples_used <= static_cast<std::size_t>(d + options.noise.order)) {
      return Error{recordings.front().source + ": has " + std::to_string(out.samples_used) + " rows for " +
                   std::to_string(d + options.noise.order) + " coefficients; record longer or lower the orders"};
    }
    std::vector<Regression> data;
    for (const Run& run : *runs) data.push_back(regression_of(run, options.orders, static_cast<int>(i), history));
    const RowFit fit = fit_row(data, options);
    if (!fit.full_rank) {
      return Error{recordings.front().source + ": a regressor of " + channels.outputs[i] +
                   " is a combination of others; lower the orders"};
    }
    model.model.theta.push_back(plain(fit.parameters.head(d)));
    model.model.std_error.push_back(plain(fit.std_error.head(d)));
    model.filter.push_back(plain(fit.parameters.tail(options.noise.order)));
    model.filter_std_error.push_back(plain(fit.std_error.tail(options.noise.order)));
    model.model.noise.sd.push_back(std::sqrt(fit.loss));
    out.loss.push_back(fit.loss);
    out.passes = std::max(out.passes, fit.passes);
    out.converged = out.converged && fit.converged;
  }
  return out;
}

Result<double> log_likelihood(const ColouredArx& model, std::span<const Recording> recordings,
                              const ChannelChoice& channels) {
  const ArxModel& arx = model.model;
  const int history = arx.orders.history();
  const auto runs = runs_of(recordings, channels, {arx.output_mean, arx.input_mean}, history);
  if (!runs) return runs.error();
  if (runs->empty()) return Error{"no row can be predicted: every stretch is shorter than the model's history"};
  double sum = 0;
  for (std::size_t i = 0; i < arx.theta.size(); ++i) {
    Vector parameters(static_cast<Eigen::Index>(arx.theta[i].size() + model.filter[i].size()));
    std::copy(arx.theta[i].begin(), arx.theta[i].end(), parameters.begin());
    std::copy(model.filter[i].begin(), model.filter[i].end(),
              parameters.begin() + static_cast<std::ptrdiff_t>(arx.theta[i].size()));
    std::vector<Regression> data;
    for (const Run& run : *runs) data.push_back(regression_of(run, arx.orders, static_cast<int>(i), history));
    const double variance = arx.noise.sd[i] * arx.noise.sd[i];
    const double loss = loss_of(data, parameters, model.noise.colour);
    sum -= 0.5 * (std::log(2 * std::numbers::pi * variance) + loss / variance);
  }
  return sum;
}

ArxModel as_white(const ColouredArx& model, double smallest, int most_lags) {
  const ArxModel& from = model.model;
  ArxModel out = from;
  const int ny = from.orders.outputs();
  out.std_error.clear();
  for (int i = 0; i < ny; ++i) {
    const auto whitening = whitener(model.filter[i], model.noise.colour, smallest, most_lags);
    std::vector<double> row;
    for (int j = 0; j < ny; ++j) {
      std::vector<double> lags = product(whitening, from.a(i, j));
      if (from.orders.na(i, j) == 0) lags.clear();
      // The leading 1 of the row's own polynomial is whitened too.
      if (i == j) {
        lags.resize(std::max(lags.size(), whitening.size()));
        for (std::size_t l = 0; l < whitening.size(); ++l) lags[l] += whitening[l];
      }
      out.orders.na(i, j) = static_cast<int>(lags.size());
      row.insert(row.end(), lags.begin(), lags.end());
    }
    for (int k = 0; k < from.orders.inputs(); ++k) {
      std::vector<double> lags = product(whitening, from.b(i, k));
      if (from.orders.nb(i, k) == 0) lags.clear();
      out.orders.nb(i, k) = static_cast<int>(lags.size());
      row.insert(row.end(), lags.begin(), lags.end());
    }
    out.theta[i] = std::move(row);
  }
  return out;
}

}  // namespace wisp
