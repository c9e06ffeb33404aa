#include "wisp/run/random.hpp"

#include "run/lanes/random_lanes.hpp"

namespace wisp {

std::array<std::uint32_t, 4> random_words(const RandomKey& key) {
  const std::uint64_t streams[LiveNumbers::kLanes] = {key.stream}, born[LiveNumbers::kLanes] = {};
  Words<LiveNumbers> counters[4], words[4];
  random_counters<LiveNumbers>({streams, born, key.step}, counters);
  random_group<LiveNumbers>(random_keys(key.seed), counters, key.group, words);
  std::array<std::uint32_t, 4> out{};
  for (int k = 0; k < 4; ++k) {
    std::uint32_t lanes[LiveNumbers::kLanes];
    store(words[k], lanes);
    out[k] = lanes[0];
  }
  return out;
}

std::array<float, 2> normal_pair(std::uint32_t word) {
  const auto pair = normal_lanes(all<Words<LiveNumbers>>(word));
  float first[LiveNumbers::kLanes], second[LiveNumbers::kLanes];
  store(pair.first, first);
  store(pair.second, second);
  return {first[0], second[0]};
}

}  // namespace wisp
