#include "wisp/model/mode_systems.hpp"

#include <cmath>
#include <string>

namespace wisp {
namespace {

constexpr double kMaxCoefficient = 1e6;
constexpr double kMaxRate = 1e6;

bool finite(const std::vector<double>& values) {
  for (double x : values) {
    if (!(std::abs(x) <= kMaxCoefficient)) return false;
  }
  return true;
}

}  // namespace

std::size_t system_terms(int degree) {
  constexpr std::size_t kSeen = kSystemStates + 3;
  return 1 + kSeen + (degree == 2 ? kSeen * (kSeen + 1) / 2 : 0);
}

Result<void> check(const ModeSystems& systems, int modes) {
  if (systems.degree != 1 && systems.degree != 2) {
    return Error{"the systems of a chain's modes have degree " + std::to_string(systems.degree) + ", expected 1 or 2"};
  }
  if (systems.modes.size() != static_cast<std::size_t>(modes)) {
    return Error{"a chain of " + std::to_string(modes) + " modes has systems for " +
                 std::to_string(systems.modes.size())};
  }
  const bool noisy = !systems.modes.front().noise.empty();
  for (std::size_t mode = 0; mode < systems.modes.size(); ++mode) {
    const ModeSystem& one = systems.modes[mode];
    const std::string name = "the system of mode " + std::to_string(mode);
    const std::size_t noise = noisy ? kSystemStates * kSystemStates : 0;
    if (one.coefficient.size() != kSystemStates * system_terms(systems.degree) || one.noise.size() != noise) {
      return Error{name + " has " + std::to_string(one.coefficient.size()) + " coefficients, expected " +
                   std::to_string(kSystemStates * system_terms(systems.degree))};
    }
    if (!finite(one.coefficient) || !finite(one.noise)) return Error{name + " holds a coefficient out of range"};
    for (std::size_t k = 0; k < kSystemStates; ++k) {
      if (!(one.lowest[k] >= -kMaxRate && one.lowest[k] <= one.highest[k] && one.highest[k] <= kMaxRate)) {
        return Error{name + " has a range that is not one"};
      }
    }
    for (std::uint16_t steps : one.steps) {
      if (steps == 0) return Error{name + " may last no step, expected at least 1"};
    }
  }
  return {};
}

}  // namespace wisp
