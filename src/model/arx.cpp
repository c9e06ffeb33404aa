#include "wisp/model/arx.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <span>
#include <string>

#include "wisp/model/switched.hpp"

namespace wisp {
namespace {

// Checks that a list has `expected` values, all finite. `what` names the list in errors.
Result<void> check_finite(std::span<const double> values, std::size_t expected, const std::string& what) {
  if (values.size() != expected) {
    return Error{what + " has " + std::to_string(values.size()) + " values, expected " + std::to_string(expected)};
  }
  for (double value : values) {
    if (!std::isfinite(value)) return Error{what + " holds a number that is not finite"};
  }
  return {};
}

constexpr int kMaxChannels = 4096;
constexpr int kMaxOrder = 4096;
constexpr int kMaxFedBack = 1024;  // the spectral radius of larger companion matrices takes minutes

std::string at(const char* what, int i, int j) {
  return std::string(what) + "(" + std::to_string(i) + "," + std::to_string(j) + ")";
}

// Returns the size of the companion matrix of a block of outputs: the largest order times the number of outputs.
int fed_back(const OrderMatrix& na, const std::vector<int>& outputs) {
  int order = 0;
  for (int i : outputs) {
    for (int j : outputs) order = std::max(order, na(i, j));
  }
  return order * static_cast<int>(outputs.size());
}

Result<void> check_orders(const ArxOrders& orders) {
  const int ny = orders.outputs();
  const int nu = orders.inputs();
  if (ny < 1 || ny > kMaxChannels)
    return Error{"an ARX model has " + std::to_string(ny) + " outputs, expected 1 to 4096"};
  if (nu > kMaxChannels) return Error{"an ARX model has " + std::to_string(nu) + " inputs, expected at most 4096"};
  if (orders.na.columns() != ny) return Error{"na is not a square matrix of outputs"};
  if (orders.nb.rows() != ny) return Error{"nb has not one row an output"};
  if (orders.nk.rows() != ny || orders.nk.columns() != nu) return Error{"nk has not the shape of nb"};
  for (const auto& [matrix, name] : {std::pair{&orders.na, "na"}, {&orders.nb, "nb"}, {&orders.nk, "nk"}}) {
    for (int i = 0; i < matrix->rows(); ++i) {
      for (int j = 0; j < matrix->columns(); ++j) {
        const int order = (*matrix)(i, j);
        if (order < 0 || order > kMaxOrder) {
          return Error{at(name, i, j) + " is " + std::to_string(order) + ", expected 0 to 4096"};
        }
      }
    }
  }
  for (const std::vector<int>& outputs : coupled_outputs(orders.na)) {
    if (fed_back(orders.na, outputs) <= kMaxFedBack) continue;
    return Error{std::to_string(outputs.size()) + " coupled outputs are computed from " +
                 std::to_string(fed_back(orders.na, outputs)) + " past values, expected at most 1024"};
  }
  return {};
}

Result<void> check_ends(const ResampledResiduals& resampled) {
  std::uint32_t before = 0;
  for (std::uint32_t end : resampled.ends) {
    if (end <= before) return Error{"a stretch of the resampled residuals ends before it begins"};
    before = end;
  }
  if (resampled.row_count() <= kMaxResampledRows) return {};
  return Error{"the resampled residuals have " + std::to_string(resampled.row_count()) +
               " rows, expected at most 4194304"};
}

Result<void> check_mirror(const ResampledResiduals& resampled, std::size_t ny) {
  if (resampled.mirror.empty()) return {};
  if (resampled.mirror.size() != ny) return Error{"the resampled residuals' mirror image is not one entry an output"};
  for (int from : resampled.mirror) {
    if (from == 0 || std::abs(from) > static_cast<int>(ny))
      return Error{"the resampled residuals' mirror image takes an output that is not there"};
  }
  return {};
}

Result<void> check_past(const ResampledResiduals& resampled) {
  const bool driven = resampled.toward >= 0;
  const std::vector<int>& lags = resampled.lags;
  const bool ascending = std::is_sorted(lags.begin(), lags.end(), std::less_equal<>());
  if (driven ? lags.empty() || lags.size() > kMaxResampledLags || lags.front() != 0 || lags.back() > kMaxOrder ||
                   !ascending
             : !lags.empty()) {
    return Error{"the resampled residuals' lags are not up to 16 ascending numbers from 0 to 4096"};
  }
  const std::size_t before = driven ? resampled.ends.size() * static_cast<std::size_t>(lags.back()) : 0;
  if (resampled.winds.size() != (driven ? resampled.row_count() + before : 0)) {
    return Error{"the resampled residuals have not a number of wind a row and a lag before each stretch"};
  }
  const std::array bounds{resampled.wind_scale, resampled.tolerance, resampled.margin};
  if (auto ok = check_finite(bounds, bounds.size(), "the resampled residuals' wind"); !ok) return ok;
  if (resampled.wind_scale < 0 || resampled.tolerance < 0 || resampled.margin < 0)
    return Error{"the resampled residuals' wind has a negative scale"};
  return {};
}

Result<void> check_resampled(const ResampledResiduals& resampled, std::size_t outputs, int nu) {
  if (resampled.empty()) {
    return resampled.ends.empty() ? Result<void>() : Error{"the resampled residuals have stretches without rows"};
  }
  if (auto ok = check_ends(resampled); !ok) return ok;
  const bool driven = resampled.toward >= 0;
  if (resampled.across < 0 || 2 * static_cast<std::size_t>(resampled.across) > outputs ||
      (resampled.across > 0 && driven && (resampled.mirror.empty() || resampled.toward + 3 >= nu))) {
    return Error{"the resampled residuals are in the round, and not of outputs and an input that are"};
  }
  const std::size_t ny = outputs - static_cast<std::size_t>(resampled.across);
  if (resampled.rows.size() != resampled.row_count() * ny)
    return Error{"the resampled residuals are not one number an output"};
  if (auto ok = check_finite(resampled.scale, ny, "the resampled residuals' scale"); !ok) return ok;
  const bool negative =
      std::any_of(resampled.scale.begin(), resampled.scale.end(), [](double scale) { return scale < 0; });
  if (negative) return Error{"a scale of the resampled residuals is negative"};
  if (resampled.toward < -1 || resampled.toward >= nu) {
    return Error{"the resampled residuals hang on an input that is not there"};
  }
  if (auto ok = check_past(resampled); !ok) return ok;
  if (resampled.longest < 1 || resampled.longest > 1000000) {
    return Error{"the resampled residuals' number of steps is out of range"};
  }
  return check_mirror(resampled, ny);
}

Result<void> check_noise(const ResidualNoise& noise, std::size_t ny) {
  if (auto ok = check_finite(noise.sd, ny, "the residual's standard deviation"); !ok) return ok;
  for (double sd : noise.sd) {
    if (sd < 0) return Error{"a residual's standard deviation is negative"};
  }
  if (!noise.sd_ci95.empty() && noise.sd_ci95.size() != ny) return Error{"the 95 % intervals are not one an output"};
  for (const auto& interval : noise.sd_ci95) {
    if (!(std::isfinite(interval[0]) && std::isfinite(interval[1]) && interval[0] <= interval[1])) {
      return Error{"a 95 % interval of a standard deviation is not an interval"};
    }
  }
  return {};
}

using Square = std::vector<double>;  // n × n, row-major

// Returns the companion matrix of one block of outputs, with coefficients rounded to single precision.
Square companion(const ArxModel& model, const std::vector<int>& outputs, int& size) {
  const int ny = static_cast<int>(outputs.size());
  size = fed_back(model.orders.na, outputs);
  Square matrix(static_cast<std::size_t>(size) * size, 0.0);
  for (int r = 0; r < ny; ++r) {
    for (int c = 0; c < ny; ++c) {
      const auto lags = model.a(outputs[r], outputs[c]);
      for (std::size_t lag = 0; lag < lags.size(); ++lag) {
        matrix[static_cast<std::size_t>(r) * size + lag * ny + c] = -static_cast<double>(static_cast<float>(lags[lag]));
      }
    }
  }
  for (int r = ny; r < size; ++r) matrix[static_cast<std::size_t>(r) * size + (r - ny)] = 1.0;
  return matrix;
}

Square squared(const Square& m, int n) {
  Square out(m.size(), 0.0);
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      const double factor = m[static_cast<std::size_t>(i) * n + k];
      if (factor == 0.0) continue;
      for (int j = 0; j < n; ++j)
        out[static_cast<std::size_t>(i) * n + j] += factor * m[static_cast<std::size_t>(k) * n + j];
    }
  }
  return out;
}

double frobenius(const Square& m) {
  double sum = 0;
  for (double value : m) sum += value * value;
  return std::sqrt(sum);
}

// Returns the spectral radius ρ by Gelfand's formula, lim ‖Mᵏ‖^(1/k), with k doubled by squaring up to 2^39: the factor
// ‖Mᵏ‖/ρᵏ enters with the exponent 2^−39. M is scaled to norm 1 before each squaring, and log2 of the scales is summed.
double radius(Square m, int n) {
  double log_radius = 0;
  double share = 1;
  for (int doubling = 0; doubling < 40; ++doubling) {
    const double norm = frobenius(m);
    if (norm == 0.0 || std::isinf(norm)) return norm;  // infinite: a coefficient beyond single precision
    for (double& value : m) value /= norm;
    log_radius += share * std::log2(norm);
    share /= 2;
    m = squared(m, n);
  }
  return std::exp2(log_radius);
}

constexpr double kProbabilityError = 1e-6;

Result<void> check_probabilities(std::span<const double> values, std::size_t modes, const std::string& what) {
  if (auto ok = check_finite(values, modes, what); !ok) return ok;
  double sum = 0;
  for (double value : values) {
    if (value < 0) return Error{what + " holds a probability below 0"};
    sum += value;
  }
  if (std::abs(sum - 1) > kProbabilityError) {
    return Error{what + " adds up to " + std::to_string(sum) + ", expected 1"};
  }
  return {};
}

Result<void> check_shock(std::span<const double> shock, int ny, const std::string& mode) {
  const auto size = static_cast<std::size_t>(ny);
  if (auto ok = check_finite(shock, size * size, mode + "the size of shocks"); !ok) return ok;
  for (int i = 0; i < ny; ++i) {
    for (int j = i + 1; j < ny; ++j) {
      if (shock[i * size + j] != 0) return Error{mode + "the matrix of shocks is not lower triangular"};
    }
  }
  return {};
}

Result<void> check_mode(const SwitchedArxModel& model, std::size_t k) {
  const std::string mode = "mode " + std::to_string(k) + ": ";
  if (auto ok = check_shock(model.modes[k].shock, model.orders.outputs(), mode); !ok) return ok;
  if (auto ok = check(mode_model(model, k)); !ok) return Error{mode + ok.error().message};
  return {};
}

Result<void> check_quantiles(const std::vector<double>& quantiles) {
  if (quantiles.empty()) return {};
  if (auto ok = check_finite(quantiles, kShockQuantiles, "the list of a shock's quantiles"); !ok) return ok;
  if (std::is_sorted(quantiles.begin(), quantiles.end())) return {};
  return Error{"a shock's quantiles do not ascend"};
}

Result<void> check_chain(const SwitchedArxModel& model) {
  const std::size_t modes = model.modes.size();
  if (auto ok = check_probabilities(model.initial, modes, "the probability of the first mode"); !ok) return ok;
  if (auto ok = check_finite(model.transitions, modes * modes, "the matrix of transitions"); !ok) return ok;
  for (std::size_t from = 0; from < modes; ++from) {
    const auto of_mode = std::span(model.transitions).subspan(from * modes, modes);
    if (auto ok = check_probabilities(of_mode, modes, "what follows mode " + std::to_string(from)); !ok) return ok;
  }
  return {};
}

}  // namespace

int ArxOrders::row_size(int i) const {
  int size = 0;
  for (int j = 0; j < na.columns(); ++j) size += na(i, j);
  for (int k = 0; k < nb.columns(); ++k) size += nb(i, k);
  return size;
}

int ArxOrders::history() const {
  int history = 0;
  for (int order : na.values()) history = std::max(history, order);
  for (int i = 0; i < nb.rows(); ++i) {
    for (int k = 0; k < nb.columns(); ++k) {
      if (nb(i, k) > 0) history = std::max(history, nk(i, k) + nb(i, k) - 1);
    }
  }
  return history;
}

std::span<const double> ArxModel::a(int i, int j) const {
  std::size_t begin = 0;
  for (int before = 0; before < j; ++before) begin += orders.na(i, before);
  return std::span(theta[i]).subspan(begin, orders.na(i, j));
}

std::span<const double> ArxModel::b(int i, int k) const {
  std::size_t begin = 0;
  for (int j = 0; j < orders.na.columns(); ++j) begin += orders.na(i, j);
  for (int before = 0; before < k; ++before) begin += orders.nb(i, before);
  return std::span(theta[i]).subspan(begin, orders.nb(i, k));
}

Result<void> check(const ArxModel& model) {
  if (auto ok = check_orders(model.orders); !ok) return ok;
  const auto ny = static_cast<std::size_t>(model.orders.outputs());
  if (model.theta.size() != ny) return Error{"an ARX model has not one row of coefficients an output"};
  if (!model.std_error.empty() && model.std_error.size() != ny)
    return Error{"standard errors are not one row an output"};
  for (std::size_t i = 0; i < ny; ++i) {
    const auto size = static_cast<std::size_t>(model.orders.row_size(static_cast<int>(i)));
    const std::string row = "row " + std::to_string(i) + " of ";
    if (auto ok = check_finite(model.theta[i], size, row + "the ARX coefficients"); !ok) return ok;
    if (model.std_error.empty()) continue;
    if (auto ok = check_finite(model.std_error[i], size, row + "the standard errors"); !ok) return ok;
  }
  if (auto ok = check_finite(model.constant, ny, "the constant term"); !ok) return ok;
  if (auto ok = check_finite(model.output_mean, ny, "the outputs' mean"); !ok) return ok;
  if (auto ok = check_finite(model.input_mean, model.orders.inputs(), "the inputs' mean"); !ok) return ok;
  if (auto ok = check_resampled(model.noise.resampled, ny, model.orders.inputs()); !ok) return ok;
  return check_noise(model.noise, ny);
}

std::vector<std::vector<int>> coupled_outputs(const OrderMatrix& na) {
  std::vector<int> label(static_cast<std::size_t>(na.rows()));
  std::iota(label.begin(), label.end(), 0);
  for (bool changed = true; changed;) {
    changed = false;
    for (int i = 0; i < na.rows(); ++i) {
      for (int j = 0; j < na.columns(); ++j) {
        if (na(i, j) == 0 || label[i] == label[j]) continue;
        label[i] = label[j] = std::min(label[i], label[j]);
        changed = true;
      }
    }
  }
  std::vector<std::vector<int>> blocks(label.size());
  for (std::size_t i = 0; i < label.size(); ++i) blocks[label[i]].push_back(static_cast<int>(i));
  std::erase_if(blocks, [](const std::vector<int>& block) { return block.empty(); });
  return blocks;
}

double spectral_radius(const ArxModel& model) {
  double largest = 0;
  for (const std::vector<int>& outputs : coupled_outputs(model.orders.na)) {
    int size = 0;
    Square matrix = companion(model, outputs, size);
    if (size > 0) largest = std::max(largest, radius(std::move(matrix), size));
  }
  return largest;
}

ArxModel mode_model(const SwitchedArxModel& model, std::size_t mode) {
  const ArxMode& of = model.modes[mode];
  const auto ny = static_cast<std::size_t>(std::max(0, model.orders.outputs()));
  ArxModel arx{model.orders, of.theta, of.std_error, of.constant, model.output_mean, model.input_mean, {}};
  for (std::size_t i = 0; i < ny && (i + 1) * ny <= of.shock.size(); ++i) {
    const auto row = of.shock.begin() + static_cast<std::ptrdiff_t>(i * ny);
    arx.noise.sd.push_back(std::sqrt(std::inner_product(row, row + static_cast<std::ptrdiff_t>(ny), row, 0.0)));
  }
  return arx;
}

Result<void> check(const SwitchedArxModel& model) {
  if (model.modes.empty() || model.modes.size() > kMaxArxModes) {
    return Error{"a switched model has " + std::to_string(model.modes.size()) + " modes, expected 1 to 64"};
  }
  for (std::size_t k = 0; k < model.modes.size(); ++k) {
    if (auto ok = check_mode(model, k); !ok) return ok;
  }
  if (auto ok = check_quantiles(model.shock_quantiles); !ok) return ok;
  return check_chain(model);
}

}  // namespace wisp
