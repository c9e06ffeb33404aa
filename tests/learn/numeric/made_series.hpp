#pragma once
// Two series that any language can make, so that figures can be compared with other programs'.

#include <cmath>
#include <vector>

namespace wisp::made {

inline std::vector<double> first_series(int samples = 200) {
  std::vector<double> out;
  for (int t = 0; t < samples; ++t) {
    out.push_back(std::sin(0.3 * t) + 0.5 * std::cos(1.1 * t + 0.2) + 0.1 * ((t * 7919) % 101) / 101);
  }
  return out;
}

inline std::vector<double> second_series(int samples = 200) {
  std::vector<double> out;
  for (int t = 0; t < samples; ++t) {
    out.push_back(0.8 * std::sin(0.35 * t + 1) + 0.6 * std::cos(0.9 * t) + 0.2 * ((t * 104729) % 97) / 97);
  }
  return out;
}

}  // namespace wisp::made
