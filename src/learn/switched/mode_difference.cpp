#include "learn/switched/mode_difference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wisp {
namespace {

double std_errors_apart(double a, double b, double error_a, double error_b) {
  if (a == b) return 0;
  const double error = std::hypot(error_a, error_b);
  return error > 0 ? std::abs(a - b) / error : std::numeric_limits<double>::infinity();
}

void compare(double apart, ModeDifference& out) {
  ++out.compared;
  out.coefficients += apart > kDifferentStdErrors ? 1 : 0;
  out.most_std_errors = std::max(out.most_std_errors, apart);
}

// ln of an output's residual standard deviation: the length of its row of the shocks' factor.
double log_residual(const ArxMode& mode, std::size_t output) {
  const std::size_t outputs = mode.constant.size();
  double square = 0;
  for (std::size_t k = 0; k < outputs; ++k)
    square += mode.shock[output * outputs + k] * mode.shock[output * outputs + k];
  return 0.5 * std::log(std::max(square, std::numeric_limits<double>::min()));
}

}  // namespace

std::vector<ModeDifference> mode_differences(const SwitchedArxModel& model,
                                             std::span<const std::vector<double>> constant_std_error) {
  std::vector<ModeDifference> all;
  for (std::size_t first = 0; first < model.modes.size(); ++first) {
    for (std::size_t second = first + 1; second < model.modes.size(); ++second) {
      const ArxMode &a = model.modes[first], &b = model.modes[second];
      const std::size_t outputs = a.constant.size();
      ModeDifference& out = all.emplace_back(ModeDifference{first, second});
      double log_ratio = 0;
      for (std::size_t i = 0; i < outputs; ++i) {
        for (std::size_t c = 0; c < a.theta[i].size(); ++c) {
          compare(std_errors_apart(a.theta[i][c], b.theta[i][c], a.std_error[i][c], b.std_error[i][c]), out);
        }
        compare(
            std_errors_apart(a.constant[i], b.constant[i], constant_std_error[first][i], constant_std_error[second][i]),
            out);
        log_ratio += log_residual(b, i) - log_residual(a, i);
      }
      out.noise_ratio = std::exp(log_ratio / static_cast<double>(outputs));
    }
  }
  return all;
}

}  // namespace wisp
