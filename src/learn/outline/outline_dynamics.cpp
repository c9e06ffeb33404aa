#include "learn/outline/outline_dynamics.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "learn/judge/judged_fit.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/numeric/decompositions.hpp"
#include "learn/rows/arx_design.hpp"

namespace wisp {
namespace {

using Matrix = Eigen::MatrixXd;
using ControlSeries = std::vector<std::vector<double>>;

constexpr int kOrder = 2;
constexpr int kInputLags = 6;                // lags 0 to 5: further lags, up to 20 frames, brought no lasting gain
constexpr Eigen::Index kMaxComponents = 14;  // maximum with inputs; without inputs all that move are replayed
constexpr double kMinPower = 1e-7;           // share of the largest power, below which a component is rounding
constexpr double kRidge = 1.5;               // initial, in rows of whitened components: limits overfitting
constexpr double kMaxRidge = 1e9;
constexpr double kStable = 0.999;
constexpr double kMinMotion = 1e-9;  // in heights: smaller motion is rounding
constexpr Eigen::Index kMinRows = 30;
constexpr double kFadeSeconds = 0.1;  // without inputs: half-life of deviations from the recorded rows
constexpr std::size_t kPowers = 3;    // powers of an input's size, followed by as many signed ones (RegressorShape)

// Returns whether a regressor is a power of an input's size, which reflection leaves unchanged.
bool is_even(std::size_t regressor) { return regressor / kPowers % 2 == 0; }

// Mean of the recordings' calm shapes; if no recording has one, of all complete rows.
std::vector<double> shape_at_rest(std::span<const Recording> recordings, const PreparedOutlines& prepared) {
  const std::size_t outputs = prepared.layout.outputs.size();
  std::vector<double> sum(outputs, 0.0);
  double count = 0;
  const auto add = [&](const std::vector<double>& shape) {
    if (shape.empty()) return;
    for (std::size_t k = 0; k < outputs; ++k) sum[k] += shape[k];
    ++count;
  };
  for (const std::vector<double>& rest : prepared.rest) add(rest);
  for (std::size_t r = 0; count == 0 && r < recordings.size(); ++r) {
    for (std::size_t row = 0; row < recordings[r].rows(); ++row) add(whole_row(recordings[r], prepared.layout, row));
  }
  for (double& value : sum) value /= std::max(1.0, count);
  return sum;
}

// Deviations from the shape at rest in shape coordinates, one row per frame.
Matrix deviations(std::span<const Recording> recordings, const OutlineLayout& layout, const std::vector<double>& rest) {
  std::vector<double> all;
  for (const Recording& recording : recordings) {
    for (std::size_t row = 0; row < recording.rows(); ++row) {
      const std::vector<double> control = whole_row(recording, layout, row);
      if (control.empty()) continue;
      const std::vector<double> at = shape_coordinates(control);
      for (std::size_t i = 0; i < at.size(); ++i) all.push_back(at[i] - rest[i]);
    }
  }
  const auto columns = static_cast<Eigen::Index>(rest.size());
  const auto rows = static_cast<Eigen::Index>(all.size()) / columns;
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(all.data(), rows,
                                                                                                  columns);
}

// Principal components of one symmetry, strongest first. append() scales them so that scores have a mean square of 1.
struct Components {
  Eigen::VectorXd power;  // mean squares about the shape at rest, descending
  Matrix vectors;

  explicit Components(const Matrix& deviations) {
    const auto rows = static_cast<double>(std::max<Eigen::Index>(1, deviations.rows()));
    const auto found = symmetric_eigensystem(deviations.transpose() * deviations / rows);
    power = found.values.reverse();
    vectors = found.vectors.rowwise().reverse();
  }
  std::size_t count(double least) const { return static_cast<std::size_t>((power.array() >= least).count()); }

  void append(std::size_t taken, std::vector<double>& basis) const {
    for (Eigen::Index i = 0; i < vectors.rows(); ++i) {
      for (std::size_t k = 0; k < taken; ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        basis.push_back(vectors(i, at) * std::sqrt(power[at]));
      }
    }
  }
};

// Returns the least power of a kept component: the `count`-th largest of both symmetries, but not below rounding.
double least_power(const Components& even, const Components& odd, Eigen::Index count) {
  std::vector<double> all(even.power.begin(), even.power.end());
  all.insert(all.end(), odd.power.begin(), odd.power.end());
  std::sort(all.begin(), all.end(), std::greater<>());
  const double last = all[static_cast<std::size_t>(std::min<Eigen::Index>(count, std::ssize(all))) - 1];
  return std::max({last, kMinPower * all.front(), std::numeric_limits<double>::min()});
}

// Returns the range of `middle` plus the values; unless `symmetric`, extended to equal distances from `middle`.
ValueRange range_of(const Eigen::VectorXd& values, double middle, bool symmetric) {
  const double low = values.minCoeff(), high = values.maxCoeff(), far = std::max(-low, high);
  return symmetric ? ValueRange{middle + low, middle + high} : ValueRange{middle - far, middle + far};
}

Result<ShapeComponents> find_shape(std::span<const Recording> recordings, const PreparedOutlines& prepared) {
  ShapeComponents shape;
  shape.rest = shape_coordinates(shape_at_rest(recordings, prepared));
  const Matrix moved = deviations(recordings, prepared.layout, shape.rest);
  const auto points = static_cast<Eigen::Index>(shape.points());
  if (moved.rows() < 2 || moved.cwiseAbs().maxCoeff() < kMinMotion) {
    return Error{recordings.front().source + ": its outline never moves; there is nothing to learn"};
  }
  const Components even(moved.leftCols(points)), odd(moved.rightCols(points));
  const double least = least_power(even, odd, prepared.inputs.empty() ? 2 * points : kMaxComponents);
  shape.symmetric = even.count(least);
  shape.antisymmetric = odd.count(least);
  even.append(shape.symmetric, shape.basis);
  odd.append(shape.antisymmetric, shape.basis);
  for (Eigen::Index i = 0; i < 2 * points; ++i) {
    shape.coordinates.push_back(range_of(moved.col(i), shape.rest[static_cast<std::size_t>(i)], i < points));
  }
  for (std::size_t k = 0; k < shape.count(); ++k) {
    const bool symmetric = k < shape.symmetric;
    const auto at = static_cast<Eigen::Index>(symmetric ? k : k - shape.symmetric);
    const Components& from = symmetric ? even : odd;
    const Matrix part = symmetric ? moved.leftCols(points) : moved.rightCols(points);
    shape.components.push_back(range_of(part * from.vectors.col(at) / std::sqrt(from.power[at]), 0, symmetric));
  }
  return shape;
}

// Regression rows of one symmetry: past components, then the inputs' regressors at each lag, even regressors for
// symmetric components and odd ones for antisymmetric components.
class RowsOf {
 public:
  RowsOf(const ShapeComponents& shape, const Recording& moved, const PreparedOutlines& prepared) : shape_(shape) {
    for (std::size_t k = 0; k < shape.count(); ++k) components_.push_back(&moved.channels[k].samples);
    for (const std::string& name : prepared.channels.inputs) inputs_.push_back(&samples_of(moved, name));
  }

  bool fill(std::size_t row, bool symmetric, Eigen::VectorXd& x, Eigen::VectorXd& y) const {
    const std::size_t first = symmetric ? 0 : shape_.symmetric, end = symmetric ? shape_.symmetric : shape_.count();
    Eigen::Index at = 0;
    for (std::size_t k = first; k < end; ++k) y[static_cast<Eigen::Index>(k - first)] = (*components_[k])[row];
    for (std::size_t lag = 1; lag <= kOrder; ++lag) {
      for (std::size_t k = first; k < end; ++k) x[at++] = (*components_[k])[row - lag];
    }
    for (std::size_t k = 0; k < inputs_.size(); ++k) {
      if (is_even(k) != symmetric) continue;
      for (std::size_t lag = 0; lag < kInputLags; ++lag) x[at++] = (*inputs_[k])[row - lag];
    }
    x[at] = 1;
    return x.allFinite() && y.allFinite();
  }

 private:
  const ShapeComponents& shape_;
  std::vector<const std::vector<double>*> components_;
  std::vector<const std::vector<double>*> inputs_;
};

// Products of one symmetry's regressors with themselves and with their targets.
struct Products {
  Matrix gram, right, squares;
  double rows = 0;

  Products(Eigen::Index regressors, Eigen::Index outputs)
      : gram(Matrix::Zero(regressors, regressors)),
        right(Matrix::Zero(regressors, outputs)),
        squares(Matrix::Zero(outputs, 1)) {}

  void add(const Recording& recording, const RowsOf& rows_of, bool symmetric) {
    Eigen::VectorXd x(gram.rows()), y(right.cols());
    const std::size_t history = std::max(kOrder, kInputLags - 1);
    for (const Episode& episode : episodes(recording)) {
      for (std::size_t row = episode.begin + history; row < episode.end; ++row) {
        if (!rows_of.fill(row, symmetric, x, y)) continue;
        gram.selfadjointView<Eigen::Lower>().rankUpdate(x);
        right += x * y.transpose();
        squares += y.cwiseAbs2();
        ++rows;
      }
    }
  }
  Matrix solved(double ridge) const {
    Matrix weighted = gram.selfadjointView<Eigen::Lower>();
    weighted.diagonal().array() += ridge;
    return symmetric_solutions(weighted, right);
  }
  // Standard deviation of the residual of output k.
  double residual_sd(const Matrix& found, Eigen::Index k) const {
    const Matrix whole = gram.selfadjointView<Eigen::Lower>();
    const Eigen::VectorXd b = found.col(k);
    const double left = squares(k, 0) - 2 * b.dot(right.col(k)) + b.dot(whole * b);
    return std::sqrt(std::max(0.0, left) / std::max(1.0, rows));
  }
};

ArxOrders shape_orders(const ShapeComponents& shape, std::size_t regressors) {
  const auto ny = static_cast<int>(shape.count()), nu = static_cast<int>(regressors);
  ArxOrders orders{OrderMatrix(ny, ny), OrderMatrix(ny, nu), OrderMatrix(ny, nu)};
  const auto symmetric = static_cast<int>(shape.symmetric);
  for (int i = 0; i < ny; ++i) {
    for (int j = 0; j < ny; ++j) orders.na(i, j) = (i < symmetric) == (j < symmetric) ? kOrder : 0;
    for (int k = 0; k < nu; ++k)
      orders.nb(i, k) = is_even(static_cast<std::size_t>(k)) == (i < symmetric) ? kInputLags : 0;
  }
  return orders;
}

// Coefficients of one output row in the order of ArxModel::theta, from a column of its symmetry's regression.
void set_row(const Eigen::VectorXd& found, std::size_t of_kind, std::vector<double>& theta, double& constant) {
  for (std::size_t k = 0; k < of_kind; ++k) {
    for (std::size_t lag = 0; lag < kOrder; ++lag) {
      theta.push_back(-found[static_cast<Eigen::Index>(lag * of_kind + k)]);
    }
  }
  theta.insert(theta.end(), found.begin() + static_cast<std::ptrdiff_t>(kOrder * of_kind), found.end() - 1);
  constant = found[found.size() - 1];
}

ArxModel shape_model(const ShapeComponents& shape, const Products& even, const Products& odd, std::size_t regressors,
                     double ridge) {
  ArxModel arx;
  arx.orders = shape_orders(shape, regressors);
  arx.output_mean.assign(shape.count(), 0.0);
  arx.input_mean.assign(regressors, 0.0);
  arx.constant.assign(shape.count(), 0.0);
  for (const bool symmetric : {true, false}) {
    const Products& products = symmetric ? even : odd;
    const Matrix found = products.solved(ridge);
    for (Eigen::Index k = 0; k < found.cols(); ++k) {
      const std::size_t i = arx.theta.size();
      set_row(found.col(k), static_cast<std::size_t>(found.cols()), arx.theta.emplace_back(), arx.constant[i]);
      arx.noise.sd.push_back(products.residual_sd(found, k));
    }
  }
  return arx;
}

// Returns dynamics without inputs: deviations from the replayed rows, caused by jumps between rows, decay.
OutlineDynamics fading_shape(std::span<const Recording> recordings, const PreparedOutlines& prepared,
                             ShapeComponents shape) {
  const auto count = static_cast<int>(shape.count());
  OutlineDynamics out{{}, std::move(shape)};
  const double fade = std::exp2(-1 / (kFadeSeconds * recordings.front().rate_hz));
  ArxModel& arx = out.arx;
  arx.orders = {OrderMatrix(count, count), OrderMatrix(count, 0), OrderMatrix(count, 0)};
  arx.constant.assign(out.shape.count(), 0.0);
  arx.output_mean = arx.constant;
  std::vector<double> squares(out.shape.count(), 0.0);
  for (int k = 0; k < count; ++k) {
    arx.orders.na(k, k) = 1;
    arx.theta.push_back({-fade});
  }
  for (const Recording& recording : recordings) {
    const Recording moved = moved_recording(out.shape, recording, prepared);
    for (const Episode& episode : episodes(moved)) {
      for (std::size_t row = episode.begin + 1; row < episode.end; ++row) {
        const auto left = [&](std::size_t k) {
          return moved.channels[k].samples[row] - fade * moved.channels[k].samples[row - 1];
        };
        if (std::isnan(left(0))) continue;
        for (std::size_t k = 0; k < squares.size(); ++k) squares[k] += left(k) * left(k);
        ++out.rows;
      }
    }
  }
  for (double square : squares) {
    arx.noise.sd.push_back(std::sqrt(square / std::max(1.0, static_cast<double>(out.rows))));
  }
  return out;
}

Result<void> check_rows(const OutlineDynamics& dynamics, Eigen::Index least, const Recording& first) {
  if (dynamics.rows >= static_cast<std::size_t>(least)) return {};
  return Error{first.source + ": has " + std::to_string(dynamics.rows) + " complete rows with their past, " +
               "expected at least " + std::to_string(least) + "; record longer"};
}

Result<OutlineDynamics> fit_shape(std::span<const Recording> recordings, const PreparedOutlines& prepared) {
  auto shape = find_shape(recordings, prepared);
  if (!shape) return shape.error();
  if (prepared.inputs.empty()) {
    OutlineDynamics fading = fading_shape(recordings, prepared, *std::move(shape));
    if (auto ok = check_rows(fading, kMinRows, recordings.front()); !ok) return ok.error();
    return fading;
  }
  OutlineDynamics out{{}, *std::move(shape), kRidge};
  const std::size_t regressors = prepared.channels.inputs.size();
  // Number of regressors after the past components, for either symmetry, including the constant.
  const auto functions = static_cast<Eigen::Index>(regressors / 2 * kInputLags + 1);
  const auto even_count = static_cast<Eigen::Index>(out.shape.symmetric);
  const auto odd_count = static_cast<Eigen::Index>(out.shape.antisymmetric);
  Products even(kOrder * even_count + functions, even_count), odd(kOrder * odd_count + functions, odd_count);
  for (const Recording& recording : recordings) {
    const Recording moved = moved_recording(out.shape, recording, prepared);
    const RowsOf rows(out.shape, moved, prepared);
    even.add(moved, rows, true);
    odd.add(moved, rows, false);
  }
  out.rows = static_cast<std::size_t>(even.rows);
  const Eigen::Index least = std::max({2 * even.gram.rows(), 2 * odd.gram.rows(), kMinRows});
  if (auto ok = check_rows(out, least, recordings.front()); !ok) return ok.error();
  for (;; out.ridge *= 4, out.stabilised = true) {
    out.arx = shape_model(out.shape, even, odd, regressors, out.ridge);
    if (spectral_radius(out.arx) < kStable || out.ridge > kMaxRidge) return out;
  }
}

Result<OutlineDynamics> fit_points(std::span<const Recording> recordings, const PreparedOutlines& prepared, int order) {
  UniformOrders uniform;
  uniform.outputs = static_cast<int>(prepared.channels.outputs.size());
  uniform.inputs = static_cast<int>(prepared.channels.inputs.size());
  uniform.na = uniform.nb = order;
  uniform.nk = 0;
  uniform.group = 2;
  uniform.coupling = Coupling::kDiagonal;
  ArxOptions options;
  options.orders = make_orders(uniform);
  options.judge_free_run = false;
  auto fitted = fit_arx(recordings, prepared.channels, options);
  if (!fitted) return fitted.error();
  OutlineDynamics out{std::move(fitted->model), {}, 0, fitted->summary.stable.changed};
  out.rows = fitted->summary.rows;
  out.arx.std_error.clear();
  return out;
}

}  // namespace

Result<OutlineDynamics> fit_dynamics(std::span<const Recording> recordings, const PreparedOutlines& prepared,
                                     int paper) {
  return paper > 0 ? fit_points(recordings, prepared, paper) : fit_shape(recordings, prepared);
}

std::vector<double> components_of(const ShapeComponents& shape, std::span<const double> coordinates) {
  std::vector<double> out(shape.count(), 0.0), norm(shape.count(), 0.0);
  const double* basis = shape.basis.data();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const bool symmetric = i < shape.points();
    const std::size_t first = symmetric ? 0 : shape.symmetric, end = symmetric ? shape.symmetric : shape.count();
    for (std::size_t k = first; k < end; ++k, ++basis) {
      out[k] += *basis * (coordinates[i] - shape.rest[i]);
      norm[k] += *basis * *basis;
    }
  }
  for (std::size_t k = 0; k < out.size(); ++k) out[k] /= norm[k];
  return out;
}

Recording moved_recording(const ShapeComponents& shape, const Recording& recording, const PreparedOutlines& prepared) {
  if (shape.empty()) return recording;
  const std::size_t outputs = prepared.layout.outputs.size();
  Recording out = recording;
  out.channels.erase(out.channels.begin(), out.channels.begin() + static_cast<std::ptrdiff_t>(outputs));
  std::vector<Channel> components;
  for (std::size_t k = 0; k < shape.count(); ++k) {
    components.push_back({"c" + std::to_string(k), "", Role::kOutput, std::vector<double>(recording.rows(), kMissing)});
  }
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const std::vector<double> control = whole_row(recording, prepared.layout, row);
    if (control.empty()) continue;
    const std::vector<double> found = components_of(shape, shape_coordinates(control));
    for (std::size_t k = 0; k < found.size(); ++k) components[k].samples[row] = found[k];
  }
  out.channels.insert(out.channels.begin(), components.begin(), components.end());
  return out;
}

ChannelChoice moved_channels(const ShapeComponents& shape, const PreparedOutlines& prepared) {
  if (shape.empty()) return prepared.channels;
  ChannelChoice out{prepared.channels.inputs, {}};
  for (std::size_t k = 0; k < shape.count(); ++k) out.outputs.push_back("c" + std::to_string(k));
  return out;
}

Result<ControlSeries> predict_outline(const OutlineDynamics& dynamics, const Recording& recording,
                                      const PreparedOutlines& prepared, const PredictOptions& options) {
  const ShapeComponents& shape = dynamics.shape;
  auto moved =
      predict(dynamics.arx, moved_recording(shape, recording, prepared), moved_channels(shape, prepared), options);
  if (!moved || shape.empty()) return moved;
  ControlSeries out(shape.rest.size(), std::vector<double>(recording.rows(), kMissing));
  std::vector<double> components(shape.count());
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    for (std::size_t k = 0; k < components.size(); ++k) components[k] = (*moved)[k][row];
    if (std::any_of(components.begin(), components.end(), [](double value) { return std::isnan(value); })) continue;
    const std::vector<double> control = control_points(shape, components);
    for (std::size_t k = 0; k < control.size(); ++k) out[k][row] = control[k];
  }
  return out;
}

ControlSeries outline_prediction_sd(const OutlineDynamics& dynamics, int steps) {
  ControlSeries moved = prediction_sd(dynamics.arx, steps);
  const ShapeComponents& shape = dynamics.shape;
  if (shape.empty()) return moved;
  ControlSeries out(shape.rest.size(), std::vector<double>(static_cast<std::size_t>(steps), 0.0));
  for (std::size_t k = 0; k < shape.count(); ++k) {
    std::vector<double> one(shape.count(), 0.0);
    one[k] = 1;
    const std::vector<double> there = control_points(shape, one);
    const std::vector<double> rest = control_points(shape, std::vector<double>(shape.count(), 0.0));
    for (std::size_t i = 0; i < out.size(); ++i) {
      for (std::size_t s = 0; s < out[i].size(); ++s) out[i][s] += std::pow((there[i] - rest[i]) * moved[k][s], 2);
    }
  }
  for (auto& row : out) {
    for (double& value : row) value = std::sqrt(value);
  }
  return out;
}

}  // namespace wisp
