#include "wisp/run/random.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "run/lanes/random_lanes.hpp"

namespace wisp::random_test {
namespace {

using Block = std::array<std::uint32_t, 4>;

// Philox with any counter and key, through the kernel.
Block philox_of(const Block& counter, std::uint64_t key) {
  Words<LiveNumbers> words[4];
  for (int k = 0; k < 4; ++k) words[k] = all<Words<LiveNumbers>>(counter[k]);
  philox(random_keys(key), words);
  Block out{};
  for (int k = 0; k < 4; ++k) {
    std::uint32_t lanes[LiveNumbers::kLanes];
    store(words[k], lanes);
    for (std::uint32_t lane : lanes) EXPECT_EQ(lane, lanes[0]);
    out[k] = lanes[0];
  }
  return out;
}

// The known answers of the authors' library for 7 rounds.
TEST(RandomWords, AreThoseOfPhilox) {
  EXPECT_EQ(philox_of({0, 0, 0, 0}, 0), (Block{0x5f6fb709, 0x0d893f64, 0x4f121f81, 0x4f730a48}));
  const std::uint32_t ones = 0xffffffff;
  EXPECT_EQ(philox_of({ones, ones, ones, ones}, ~std::uint64_t{0}),
            (Block{0x5207ddc2, 0x45165e59, 0x4d8ee751, 0x8c52f662}));
  EXPECT_EQ(philox_of({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, 0x299f31d0a4093822),
            (Block{0x4dfccaba, 0x190a87f0, 0xc47362ba, 0xb6b5242a}));
}

TEST(RandomWords, DifferWhereverTheKeyDiffers) {
  const RandomKey key{.seed = 5, .stream = 6, .step = 7, .group = 8};
  std::vector<RandomKey> others(9, key);
  others[0].seed = 4;
  others[1].seed = key.seed + (std::uint64_t{1} << 40);
  others[2].stream = 4;
  others[3].stream = key.stream + (std::uint64_t{1} << 40);
  others[4].step = 4;
  others[5].step = key.step + (std::uint64_t{1} << 40);
  others[6].group = 4;
  others[7].step = key.step + (std::uint64_t{1} << 32);
  others[8].group = 0xffff;
  for (const RandomKey& other : others) EXPECT_NE(random_words(key), random_words(other));
  EXPECT_EQ(random_words(key), random_words({.seed = 5, .stream = 6, .step = 7, .group = 8}));
}

// The polar form in double precision, of the parts of a word as they are documented.
std::array<double, 2> exact_pair(std::uint32_t word) {
  const double u = (word % (1U << 20) + 0.5) / (1 << 20), turn = word >> 20 & 1 ? -1 : 1;
  const double angle = std::acos(-1.0) * ((static_cast<std::int32_t>(word) >> 21) + 0.5) / 2048;
  const double size = turn * std::sqrt(-2 * std::log(u));
  return {size * std::cos(angle), size * std::sin(angle)};
}

double error_at(std::uint32_t word) {
  const auto exact = exact_pair(word);
  const auto pair = normal_pair(word);
  return std::max(std::abs(pair[0] - exact[0]), std::abs(pair[1] - exact[1]));
}

// The documented bound. Words: every length in 16 directions, every direction with 256 lengths and the longest.
TEST(NormalPair, IsThePolarFormWithinItsStatedError) {
  double largest = 0;
  for (std::uint32_t u = 0; u < 1U << 20; ++u) largest = std::max(largest, error_at(u * 0x9E3779B1U << 20 | u));
  for (std::uint32_t direction = 0; direction < 1U << 12; ++direction) {
    for (std::uint32_t k = 0; k < 256; ++k) largest = std::max(largest, error_at(direction << 20 | k * 4112));
  }
  std::printf("largest error of normal_pair(): %.3g\n", largest);
  EXPECT_LT(largest, 4e-5);
  EXPECT_GT(largest, 1e-7);  // that the check looks at something
}

TEST(NormalPair, ReachesAsFarAsIsSaid) {
  float farthest = 0;
  for (std::uint32_t direction = 0; direction < 1U << 12; ++direction) {
    const auto pair = normal_pair(direction << 20);
    farthest = std::max({farthest, std::abs(pair[0]), std::abs(pair[1])});
  }
  EXPECT_NEAR(farthest, 5.3956, 1e-4);  // √(−2 ln 2⁻²¹)
}

TEST(NormalPair, IsSymmetric) {
  for (std::uint32_t word = 1; word < 0x80000000U; word = word * 3 + 1) {
    const auto pair = normal_pair(word), opposite = normal_pair(word ^ 1U << 20);
    EXPECT_EQ(pair[0], -opposite[0]);
    EXPECT_EQ(pair[1], -opposite[1]);
  }
}

// Over all words the shares of deviates below a bound are those of the distribution: every direction with 1,024
// lengths.
TEST(NormalPair, IsDistributedAsItShould) {
  constexpr int kBounds = 81;
  std::array<std::int64_t, kBounds + 1> below{};
  std::int64_t count = 0;
  for (std::uint32_t direction = 0; direction < 1U << 12; ++direction) {
    for (std::uint32_t u = direction * 389 % 1024; u < 1U << 20; u += 1024) {
      for (const float x : normal_pair(direction << 20 | u)) {
        ++below[static_cast<std::size_t>(std::clamp(std::ceil(x * 10 + 40), 0.0f, static_cast<float>(kBounds)))];
      }
      count += 2;
    }
  }
  std::int64_t sum = 0;
  double largest = 0;
  for (int k = 0; k < kBounds; ++k) {
    sum += below[static_cast<std::size_t>(k)];
    const double share = static_cast<double>(sum) / static_cast<double>(count);
    largest = std::max(largest, std::abs(share - 0.5 * std::erfc(-(k - 40) / 10.0 / std::sqrt(2.0))));
  }
  std::printf("largest error of the distribution: %.3g\n", largest);
  EXPECT_LT(largest, 1e-5);
}

// Fixed key; for 2^20 normal deviates the four moments lie within 4.5 standard errors: false alarms about 3 in 100 000.
TEST(NormalPair, HasTheMomentsOfNormalDeviates) {
  constexpr int kGroups = 1 << 17;
  double sum[5] = {};
  for (std::uint64_t step = 0; step < kGroups; ++step) {
    for (const std::uint32_t word : random_words({.seed = 42, .stream = 9, .step = step, .group = 3})) {
      for (const double x : normal_pair(word)) {
        for (int k = 1; k <= 4; ++k) sum[k] += std::pow(x, k);
      }
    }
  }
  constexpr double n = 8.0 * kGroups;
  EXPECT_NEAR(sum[1] / n, 0, 4.5 * std::sqrt(1 / n));
  EXPECT_NEAR(sum[2] / n, 1, 4.5 * std::sqrt(2 / n));
  EXPECT_NEAR(sum[3] / n, 0, 4.5 * std::sqrt(15 / n));
  EXPECT_NEAR(sum[4] / n, 3, 4.5 * std::sqrt(96 / n));
}

// Correlations between neighbouring steps, streams, words and the two of a word, and of the squares of the two, of 2^16
// pairs, within 4.5 standard errors.
TEST(NormalPair, NeighboursAreNotCorrelated) {
  constexpr int kPairs = 1 << 16;
  double by_step = 0, by_stream = 0, by_word = 0, within = 0, squares = 0;
  for (std::uint64_t k = 0; k < kPairs; ++k) {
    const auto here = random_words({.seed = 1, .stream = 2, .step = k});
    const auto [x, y] = normal_pair(here[0]);
    by_step += x * normal_pair(random_words({.seed = 1, .stream = 2, .step = k + 1})[0])[0];
    by_stream += x * normal_pair(random_words({.seed = 1, .stream = 3, .step = k})[0])[0];
    by_word += x * normal_pair(here[1])[0];
    within += x * y;
    squares += (x * x - 1) * (y * y - 1) / 2;
  }
  const double bound = 4.5 / std::sqrt(static_cast<double>(kPairs));
  for (const double sum : {by_step, by_stream, by_word, within, squares}) EXPECT_LT(std::abs(sum) / kPairs, bound);
}

}  // namespace
}  // namespace wisp::random_test
