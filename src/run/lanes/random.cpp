#include "wisp/run/random.hpp"

#include <iterator>

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

float normal(std::uint32_t word) {
  float lanes[LiveNumbers::kLanes];
  store(normal_lanes(all<Words<LiveNumbers>>(word)), lanes);
  return lanes[0];
}

std::span<const std::array<float, 3>> normal_table() {
  static constexpr std::size_t kCount = std::size(kNormalSegments) - 1;  // the last one only pads
  static constexpr auto kTable = [] {
    std::array<std::array<float, 3>, kCount> table{};
    for (std::size_t k = 0; k < kCount; ++k) {
      for (int c = 0; c < 3; ++c) table[k][c] = kNormalSegments[k].c[c];
    }
    return table;
  }();
  return kTable;
}

}  // namespace wisp
