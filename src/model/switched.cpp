#include "wisp/model/switched.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <string>

#include "model/check_finite.hpp"

namespace wisp {
namespace {

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
