#include "wisp/model/switched.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace wisp {
namespace {

constexpr double kProbabilityError = 1e-6;

Result<void> check_numbers(std::span<const double> values, std::size_t expected, const std::string& what) {
  if (values.size() != expected) {
    return Error{what + " has " + std::to_string(values.size()) + " values, expected " + std::to_string(expected)};
  }
  for (double value : values) {
    if (!std::isfinite(value)) return Error{what + " holds a number that is not finite"};
  }
  return {};
}

Result<void> check_probabilities(std::span<const double> values, std::size_t modes, const std::string& what) {
  if (auto ok = check_numbers(values, modes, what); !ok) return ok;
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
  if (auto ok = check_numbers(shock, size * size, mode + "the size of shocks"); !ok) return ok;
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

Result<void> check_switching(const SwitchedArxModel& model) {
  const std::size_t modes = model.modes.size();
  const bool regions = model.switching == Switching::kRegions;
  const std::size_t row = 1 + (regions ? region_samples(model.orders).size() : 0);
  if (auto ok = check_numbers(model.regions, regions ? modes * row : 0, "the matrix of regions"); !ok) return ok;
  if (regions) {
    if (!model.initial.empty() || !model.transitions.empty()) {
      return Error{"the model switches by regions and has probabilities, expected none"};
    }
    return {};
  }
  if (auto ok = check_probabilities(model.initial, modes, "the probability of the first mode"); !ok) return ok;
  if (auto ok = check_numbers(model.transitions, modes * modes, "the matrix of transitions"); !ok) return ok;
  for (std::size_t from = 0; from < modes; ++from) {
    const auto of_mode = std::span(model.transitions).subspan(from * modes, modes);
    if (auto ok = check_probabilities(of_mode, modes, "what follows mode " + std::to_string(from)); !ok) return ok;
  }
  return {};
}

Result<void> check_lyapunov(const SwitchedArxModel& model) {
  if (model.lyapunov.empty()) return {};
  const auto blocks = state_blocks(model);
  if (model.lyapunov.size() != blocks.size()) {
    return Error{"the Lyapunov function has " + std::to_string(model.lyapunov.size()) + " blocks, expected " +
                 std::to_string(blocks.size())};
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const std::string block = "block " + std::to_string(b) + " of the Lyapunov function";
    if (blocks[b].states > kMaxLyapunovStates) return Error{block + " has more than 256 states"};
    const auto states = static_cast<std::size_t>(blocks[b].states);
    if (auto ok = check_numbers(model.lyapunov[b], states * states, block); !ok) return ok;
    if (!is_common_lyapunov(blocks[b], model.lyapunov[b])) {
      return Error{block + " is none: it does not shrink in every mode; learn the model again"};
    }
  }
  return {};
}

// Cholesky's factorisation, by what of a symmetric matrix is on and below its diagonal.
bool is_positive(std::vector<double> m, int n) {
  for (int j = 0; j < n; ++j) {
    double* row = m.data() + static_cast<std::ptrdiff_t>(j) * n;
    for (int k = 0; k < j; ++k) row[j] -= row[k] * row[k];
    if (!(row[j] > 0)) return false;
    row[j] = std::sqrt(row[j]);
    for (int i = j + 1; i < n; ++i) {
      double* below = m.data() + static_cast<std::ptrdiff_t>(i) * n;
      for (int k = 0; k < j; ++k) below[j] -= below[k] * row[k];
      below[j] /= row[j];
    }
  }
  return true;
}

// P − AᵀPA.
std::vector<double> decrease(std::span<const double> p, std::span<const double> a, int n) {
  std::vector<double> product(p.size(), 0.0), out(p.begin(), p.end());
  const auto at = [n](int i, int j) { return static_cast<std::size_t>(i) * n + j; };
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      for (int j = 0; j < n; ++j) product[at(i, j)] += p[at(i, k)] * a[at(k, j)];
    }
  }
  for (int k = 0; k < n; ++k) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) out[at(i, j)] -= a[at(k, i)] * product[at(k, j)];
    }
  }
  return out;
}

// The outputs that feed output `first` or are fed by it, directly or through others; they are marked as taken.
std::vector<int> block_of(int first, const OrderMatrix& na, std::vector<bool>& taken) {
  std::vector<int> block{first};
  taken[first] = true;
  for (std::size_t next = 0; next < block.size(); ++next) {
    for (int j = 0; j < na.rows(); ++j) {
      if (taken[j] || (na(block[next], j) == 0 && na(j, block[next]) == 0)) continue;
      taken[j] = true;
      block.push_back(j);
    }
  }
  std::sort(block.begin(), block.end());
  return block;
}

std::vector<double> companion_of(const ArxModel& mode, const std::vector<int>& outputs, int states) {
  const int ny = static_cast<int>(outputs.size());
  std::vector<double> matrix(static_cast<std::size_t>(states) * states, 0.0);
  for (int r = 0; r < ny; ++r) {
    for (int c = 0; c < ny; ++c) {
      const auto lags = mode.a(outputs[r], outputs[c]);
      for (std::size_t lag = 0; lag < lags.size(); ++lag) {
        matrix[static_cast<std::size_t>(r) * states + lag * ny + c] =
            -static_cast<double>(static_cast<float>(lags[lag]));
      }
    }
  }
  for (int r = ny; r < states; ++r) matrix[static_cast<std::size_t>(r) * states + (r - ny)] = 1.0;
  return matrix;
}

}  // namespace

std::vector<RegionSample> region_samples(const ArxOrders& orders) {
  std::vector<RegionSample> samples;
  for (int j = 0; j < orders.outputs(); ++j) {
    int most = 0;
    for (int i = 0; i < orders.outputs(); ++i) most = std::max(most, orders.na(i, j));
    for (int lag = 1; lag <= most; ++lag) samples.push_back({false, j, lag});
  }
  for (int k = 0; k < orders.inputs(); ++k) {
    std::set<int> lags;
    for (int i = 0; i < orders.outputs(); ++i) {
      for (int l = 0; l < orders.nb(i, k); ++l) lags.insert(orders.nk(i, k) + l);
    }
    for (int lag : lags) samples.push_back({true, k, lag});
  }
  return samples;
}

ArxModel mode_model(const SwitchedArxModel& model, std::size_t mode) {
  const ArxMode& of = model.modes[mode];
  const auto ny = static_cast<std::size_t>(std::max(0, model.orders.outputs()));
  ArxModel arx{model.orders, of.theta, of.std_error, of.constant, model.output_mean, model.input_mean, {}};
  arx.noise.sd.assign(ny, 0.0);
  arx.noise.rank = static_cast<int>(ny);
  arx.noise.mixing = of.shock;
  return arx;
}

SwitchedArxModel switched_of(const ArxModel& model) {
  const auto ny = static_cast<std::size_t>(model.orders.outputs());
  std::vector<double> shock(ny * ny, 0.0);
  for (std::size_t i = 0; i < ny; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = i == j ? model.noise.sd[i] * model.noise.sd[i] : 0.0;
      for (int r = 0; r < model.noise.rank; ++r) {
        rest += model.noise.mixing[i * model.noise.rank + r] * model.noise.mixing[j * model.noise.rank + r];
      }
      for (std::size_t k = 0; k < j; ++k) rest -= shock[i * ny + k] * shock[j * ny + k];
      const double diagonal = shock[j * ny + j];
      shock[i * ny + j] = i == j ? std::sqrt(std::max(0.0, rest)) : diagonal > 0 ? rest / diagonal : 0.0;
    }
  }
  SwitchedArxModel out{model.orders, model.output_mean, model.input_mean, {}, Switching::kRegions, {}, {}, {}, {}};
  out.modes = {{model.theta, model.std_error, model.constant, std::move(shock)}};
  out.regions.assign(1 + region_samples(model.orders).size(), 0.0);
  return out;
}

std::vector<StateBlock> state_blocks(const SwitchedArxModel& model) {
  const OrderMatrix& na = model.orders.na;
  std::vector<bool> taken(na.rows(), false);
  std::vector<ArxModel> modes;
  for (std::size_t k = 0; k < model.modes.size(); ++k) modes.push_back(mode_model(model, k));
  std::vector<StateBlock> blocks;
  for (int first = 0; first < na.rows(); ++first) {
    if (taken[first]) continue;
    StateBlock block{block_of(first, na, taken), 0, {}};
    int order = 0;
    for (int i : block.outputs) {
      for (int j : block.outputs) order = std::max(order, na(i, j));
    }
    block.states = order * static_cast<int>(block.outputs.size());
    if (block.states == 0) continue;
    if (block.states <= kMaxLyapunovStates) {
      for (const ArxModel& mode : modes) block.companion.push_back(companion_of(mode, block.outputs, block.states));
    }
    blocks.push_back(std::move(block));
  }
  return blocks;
}

bool is_common_lyapunov(const StateBlock& block, std::span<const double> lyapunov) {
  const int n = block.states;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) {
      if (lyapunov[static_cast<std::size_t>(i) * n + j] != lyapunov[static_cast<std::size_t>(j) * n + i]) return false;
    }
  }
  if (!is_positive({lyapunov.begin(), lyapunov.end()}, n)) return false;
  return std::all_of(block.companion.begin(), block.companion.end(),
                     [&](const auto& mode) { return is_positive(decrease(lyapunov, mode, n), n); });
}

Result<void> check(const SwitchedArxModel& model) {
  if (model.modes.empty() || model.modes.size() > kMaxArxModes) {
    return Error{"a switched model has " + std::to_string(model.modes.size()) + " modes, expected 1 to 64"};
  }
  for (std::size_t k = 0; k < model.modes.size(); ++k) {
    if (auto ok = check_mode(model, k); !ok) return ok;
  }
  if (auto ok = check_switching(model); !ok) return ok;
  return check_lyapunov(model);
}

}  // namespace wisp
