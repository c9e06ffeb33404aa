#include "wisp/run/random.hpp"

#include "run/random_lanes.hpp"

namespace wisp {
namespace {

struct OneLane {
  using Real = float;
  using Word = std::uint32_t;
  static constexpr int kLanes = 1;
};

}  // namespace

std::array<std::uint32_t, 4> random_words(const RandomKey& key) {
  std::uint32_t words[4][1];
  random_group<OneLane>(random_keys(key.seed), {&key.stream, &key.step}, key.group, words);
  return {words[0][0], words[1][0], words[2][0], words[3][0]};
}

float normal(std::uint32_t word) {
  float deviate = 0;
  normal_lanes<OneLane>({word}, &deviate);
  return deviate;
}

}  // namespace wisp
