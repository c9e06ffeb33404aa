#include "wisp/learn/recursive_arx.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "learn/arx/fit/arx_check.hpp"
#include "learn/arx/fit/arx_stability.hpp"
#include "learn/arx/rows/arx_design.hpp"

namespace wisp {
namespace {

using Eigen::Index;

// Rows with the same regressors: the triangle of their weighted regression, and its targets.
class Triangle {
 public:
  Triangle(Index regressors, Index targets) : triangle_(Eigen::MatrixXd::Zero(regressors, regressors + targets)) {}

  Index regressors() const { return triangle_.rows(); }

  void believe(Index regressor, double weight, const Eigen::RowVectorXd& targets) {
    triangle_(regressor, regressor) = weight;
    triangle_.row(regressor).tail(targets.size()) = weight * targets;
  }

  void fade(double factor) { triangle_ *= factor; }

  /// Takes in a row [regressors | targets] whose entries before `first` are 0, by Givens rotations.
  void add(Eigen::RowVectorXd& row, Index first) {
    for (Index k = first; k < regressors(); ++k) {
      if (row[k] == 0) continue;
      const double length = std::hypot(triangle_(k, k), row[k]);
      const double c = triangle_(k, k) / length;
      const double s = row[k] / length;
      for (Index j = k; j < triangle_.cols(); ++j) {
        const double above = triangle_(k, j);
        triangle_(k, j) = c * above + s * row[j];
        row[j] = c * row[j] - s * above;
      }
    }
  }

  Eigen::MatrixXd solve() const {
    return triangle_.leftCols(regressors())
        .triangularView<Eigen::Upper>()
        .solve(triangle_.rightCols(triangle_.cols() - regressors()));
  }

 private:
  Eigen::MatrixXd triangle_;
};

}  // namespace

struct RecursiveArx::State {
  RecursiveOptions options;
  ArxDesign design;
  std::vector<Triangle> triangles;           // per group of the design
  std::vector<Eigen::MatrixXd> thetas;       // per group, without A's sign, in scaled units
  std::vector<double> scale;                 // per channel
  std::vector<double> offset;                // per channel
  std::vector<std::vector<double>> history;  // per channel: deviations at lag 0, 1, …; NaN where there are none
  std::vector<double> errors;
  std::vector<double> square;  // weighted sum of squared errors, per output
  double weight = 0;           // weighted number of samples
  std::size_t updates = 0;
  ArxModel model;
  bool held = false;

  State(const RecursiveOptions& given, const ArxModel* start)
      : options(given),
        design(make_design(given.orders, given.estimate_constant ? ArxOffset::kEstimate : ArxOffset::kMean)) {
    const int ny = options.orders.outputs();
    const int nu = options.orders.inputs();
    scale = options.output_scale.empty() ? std::vector<double>(ny, 1.0) : options.output_scale;
    const std::vector<double> inputs = options.input_scale.empty() ? std::vector<double>(nu, 1.0) : options.input_scale;
    scale.insert(scale.end(), inputs.begin(), inputs.end());
    offset.assign(ny + nu, 0.0);
    if (start != nullptr) {
      std::copy(start->output_mean.begin(), start->output_mean.end(), offset.begin());
      std::copy(start->input_mean.begin(), start->input_mean.end(), offset.begin() + ny);
    }
    errors.assign(ny, 0.0);
    square.assign(ny, 0.0);
    prepare_model(start);
    for (const SharedRows& rows : design.groups) add_group(rows);
    forget_history();
    write_model();
  }

  void prepare_model(const ArxModel* start) {
    const int ny = options.orders.outputs();
    model.orders = options.orders;
    for (int i = 0; i < ny; ++i) model.theta.emplace_back(options.orders.row_size(i), 0.0);
    model.constant.assign(ny, 0.0);
    if (start != nullptr) {
      model.theta = start->theta;
      model.constant = start->constant;
    }
    model.output_mean.assign(offset.begin(), offset.begin() + ny);
    model.input_mean.assign(offset.begin() + ny, offset.end());
    model.noise.sd.assign(ny, 0.0);
  }

  // From a coefficient in the model's units, with A's sign, to one in scaled units without it.
  double to_scaled(int output, LaggedChannel column) const {
    const double own = 1 / scale[output];
    if (column.channel == kConstantChannel) return own;
    return (column.channel < design.layout.outputs() ? -1.0 : 1.0) * own * scale[column.channel];
  }

  void add_group(const SharedRows& rows) {
    const auto d = static_cast<Index>(rows.columns.size());
    const auto targets = static_cast<Index>(rows.outputs.size());
    Eigen::MatrixXd theta(d, targets);
    for (Index k = 0; k < targets; ++k) {
      const int output = rows.outputs[k];
      for (Index p = 0; p < d; ++p) {
        const LaggedChannel column = design.layout[rows.columns[p]];
        const bool constant = column.channel == kConstantChannel;
        theta(p, k) = to_scaled(output, column) * (constant ? model.constant[output] : model.theta[output][p]);
      }
    }
    Triangle triangle(d, targets);
    for (Index p = 0; p < d; ++p) triangle.believe(p, std::sqrt(options.trust), theta.row(p));
    triangles.push_back(std::move(triangle));
    thetas.push_back(std::move(theta));
  }

  void forget_history() {
    history.assign(scale.size(), std::vector<double>(static_cast<std::size_t>(design.layout.history()) + 1,
                                                     std::numeric_limits<double>::quiet_NaN()));
  }

  void remember(std::size_t channel, double sample) {
    std::vector<double>& lags = history[channel];
    std::copy_backward(lags.begin(), lags.end() - 1, lags.end());
    lags.front() = (sample - offset[channel]) / scale[channel];
  }

  double value(LaggedChannel column) const {
    return column.channel == kConstantChannel ? 1.0 : history[column.channel][column.lag];
  }

  // A group learns where all that it needs is there.
  bool learn(std::size_t g) {
    const SharedRows& rows = design.groups[g];
    const auto d = static_cast<Index>(rows.columns.size());
    const auto targets = static_cast<Index>(rows.outputs.size());
    Eigen::RowVectorXd row(d + targets);
    for (Index p = 0; p < d; ++p) row[p] = value(design.layout[rows.columns[p]]);
    for (Index k = 0; k < targets; ++k) row[d + k] = value({rows.outputs[k], 0});
    if (!row.allFinite()) return false;
    const Eigen::RowVectorXd error = row.tail(targets) - row.head(d) * thetas[g];
    for (Index k = 0; k < targets; ++k) errors[rows.outputs[k]] = error[k] * scale[rows.outputs[k]];
    triangles[g].fade(std::sqrt(options.forgetting));
    triangles[g].add(row, 0);
    if (d > 0) hold_floor(g);
    thetas[g] = triangles[g].solve();
    return true;
  }

  // One regressor a step in turn: what forgetting takes from it in a round comes back as belief in the present
  // estimate.
  void hold_floor(std::size_t g) {
    const Index d = triangles[g].regressors();
    const auto regressor = static_cast<Index>(updates % static_cast<std::size_t>(d));
    const double strength = std::sqrt(options.floor * (1 - std::pow(options.forgetting, static_cast<double>(d))));
    if (strength == 0) return;
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(d + thetas[g].cols());
    row[regressor] = strength;
    row.tail(thetas[g].cols()) = strength * thetas[g].row(regressor);
    triangles[g].add(row, regressor);
  }

  void write_model() {
    for (std::size_t g = 0; g < design.groups.size(); ++g) {
      const SharedRows& rows = design.groups[g];
      for (std::size_t k = 0; k < rows.outputs.size(); ++k) {
        const int output = rows.outputs[k];
        for (std::size_t p = 0; p < rows.columns.size(); ++p) {
          const LaggedChannel column = design.layout[rows.columns[p]];
          const double theta = thetas[g](static_cast<Index>(p), static_cast<Index>(k)) / to_scaled(output, column);
          (column.channel == kConstantChannel ? model.constant[output] : model.theta[output][p]) = theta;
        }
      }
    }
    held = false;
    for (double radius = spectral_radius(model); radius > 1 - options.stability_margin / 2;) {
      held = true;
      scale_poles(model, (1 - options.stability_margin) / radius);
      radius = spectral_radius(model);
    }
  }

  void write_noise() {
    for (std::size_t i = 0; i < errors.size(); ++i) {
      square[i] = options.forgetting * square[i] + errors[i] * errors[i];
      model.noise.sd[i] = std::sqrt(square[i] / weight);
    }
  }
};

Result<RecursiveArx> RecursiveArx::create(const RecursiveOptions& options, const ArxModel* start) {
  const auto ny = static_cast<std::size_t>(options.orders.outputs());
  const auto nu = static_cast<std::size_t>(options.orders.inputs());
  if (ny == 0) return Error{"a model to learn has no outputs"};
  const ChannelChoice unnamed{std::vector<std::string>(nu), std::vector<std::string>(ny)};
  if (auto ok = check_orders(options.orders, unnamed); !ok) return ok.error();
  if (!(options.forgetting > 0 && options.forgetting <= 1)) return Error{"forgetting must be above 0 and at most 1"};
  if (!(options.trust > 0) || !(options.floor >= 0)) return Error{"trust must be above 0, and the floor not below it"};
  if (!(options.stability_margin > 0 && options.stability_margin < 1)) {
    return Error{"the stability margin must lie between 0 and 1"};
  }
  const auto fits = [](const std::vector<double>& scale, std::size_t count) {
    return scale.empty() ||
           (scale.size() == count && std::all_of(scale.begin(), scale.end(), [](double s) { return s > 0; }));
  };
  if (!fits(options.output_scale, ny) || !fits(options.input_scale, nu)) {
    return Error{"scales must be above 0, one an output and one an input"};
  }
  if (start != nullptr && !(start->orders == options.orders)) {
    return Error{"the model to start from has other orders than those to learn"};
  }
  return RecursiveArx(std::make_unique<State>(options, start));
}

RecursiveArx::RecursiveArx(std::unique_ptr<State> state) : state_(std::move(state)) {}
RecursiveArx::RecursiveArx(RecursiveArx&&) noexcept = default;
RecursiveArx& RecursiveArx::operator=(RecursiveArx&&) noexcept = default;
RecursiveArx::~RecursiveArx() = default;

bool RecursiveArx::update(std::span<const double> outputs, std::span<const double> inputs) {
  State& state = *state_;
  assert(outputs.size() == state.errors.size() && outputs.size() + inputs.size() == state.scale.size());
  for (std::size_t i = 0; i < outputs.size(); ++i) state.remember(i, outputs[i]);
  for (std::size_t k = 0; k < inputs.size(); ++k) state.remember(outputs.size() + k, inputs[k]);
  std::fill(state.errors.begin(), state.errors.end(), 0.0);
  bool learned = false;
  for (std::size_t g = 0; g < state.design.groups.size(); ++g) learned = state.learn(g) || learned;
  if (!learned) return false;
  ++state.updates;
  state.weight = state.options.forgetting * state.weight + 1;
  state.write_model();
  state.write_noise();
  return true;
}

std::span<const double> RecursiveArx::errors() const { return state_->errors; }
void RecursiveArx::restart() { state_->forget_history(); }
const ArxModel& RecursiveArx::model() const { return state_->model; }
bool RecursiveArx::held() const { return state_->held; }

}  // namespace wisp
