#include "wisp/run/random.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "run/lanes/random_lanes.hpp"

namespace wisp {
namespace {

using Block = std::array<std::uint32_t, 4>;

// Philox with any counter and key, through the kernel.
Block philox_of(const Block& counter, std::uint64_t key) {
  Words<LiveNumbers> words[4];
  for (int k = 0; k < 4; ++k) words[k] = all<Words<LiveNumbers>>(counter[k]);
  philox<LiveNumbers>(random_keys(key), words);
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

double upper_tail(double x) { return 0.5 * std::erfc(x / std::sqrt(2.0)); }

// x with upper_tail(x) = p, by Newton's method from `guess`.
double inverse_tail(double p, double guess) {
  double x = guess;
  for (int k = 0; k < 4; ++k) {
    const double density = std::exp(-0.5 * x * x) / std::sqrt(2 * std::acos(-1.0));
    x += (upper_tail(x) - p) / density;
  }
  return x;
}

double error_at(std::uint32_t word) {
  const double deviate = normal(word);
  const double p = (static_cast<double>(~word) + 0.5) * 0x1p-32;  // of being larger
  return deviate < 0 ? deviate + inverse_tail(1 - p, -deviate) : deviate - inverse_tail(p, deviate);
}

// The documented bound. Words: every octave of either tail, 4096 places in each, and every word of the outermost 4096.
TEST(Normal, IsTheInverseOfTheDistributionWithinItsStatedError) {
  double largest = 0;
  for (std::uint32_t word = 0; word < 4096; ++word) {
    largest = std::max({largest, std::abs(error_at(word)), std::abs(error_at(~word))});
  }
  for (int octave = 12; octave < 31; ++octave) {
    for (std::uint32_t place = 0; place < 4096; ++place) {
      const std::uint32_t word = (1U << octave) + static_cast<std::uint32_t>((std::uint64_t{place} << octave) >> 12);
      largest = std::max({largest, std::abs(error_at(word)), std::abs(error_at(~word))});
    }
  }
  RecordProperty("largest_error", std::to_string(largest));
  std::printf("largest error of normal(): %.3g\n", largest);
  EXPECT_LT(largest, 1.5e-6);
  EXPECT_GT(largest, 1e-7);  // that the check looks at something
}

TEST(Normal, ReachesTheTailOfTheLastWord) {
  EXPECT_NEAR(normal(0xffffffffU), 6.3379, 1e-4);  // upper tail 2^-33
  EXPECT_EQ(normal(0), -normal(0xffffffffU));
}

TEST(Normal, IsSymmetric) {
  for (std::uint32_t word = 1; word < 0x80000000U; word = word * 3 + 1) EXPECT_EQ(normal(word), -normal(~word));
}

TEST(Normal, RisesWithTheWord) {
  // Where segments meet, their errors may differ: a fall of twice the error would be allowed; none is larger than that.
  float before = normal(0);
  for (std::uint64_t word = 0; word <= 0xffffffffU; word += 65521) {
    const float now = normal(static_cast<std::uint32_t>(word));
    EXPECT_GE(now, before - 3e-6f) << word;
    before = now;
  }
}

// Fixed key; for 2^20 normal deviates the four moments lie within 4.5 standard errors: false alarms about 3 in 100 000.
TEST(Normal, HasTheMomentsOfANormalDeviate) {
  constexpr int kGroups = 1 << 18;
  double sum[5] = {};
  for (std::uint64_t step = 0; step < kGroups; ++step) {
    for (std::uint32_t word : random_words({.seed = 42, .stream = 9, .step = step, .group = 3})) {
      const double x = normal(word);
      for (int k = 1; k <= 4; ++k) sum[k] += std::pow(x, k);
    }
  }
  constexpr double n = 4.0 * kGroups;
  EXPECT_NEAR(sum[1] / n, 0, 4.5 * std::sqrt(1 / n));
  EXPECT_NEAR(sum[2] / n, 1, 4.5 * std::sqrt(2 / n));
  EXPECT_NEAR(sum[3] / n, 0, 4.5 * std::sqrt(15 / n));
  EXPECT_NEAR(sum[4] / n, 3, 4.5 * std::sqrt(96 / n));
}

// Correlations between neighbouring steps, streams and channels of 2^16 pairs, within 4.5 standard errors.
TEST(Normal, NeighboursAreNotCorrelated) {
  constexpr int kPairs = 1 << 16;
  double by_step = 0, by_stream = 0, by_channel = 0;
  for (std::uint64_t k = 0; k < kPairs; ++k) {
    const auto here = random_words({.seed = 1, .stream = 2, .step = k});
    const double x = normal(here[0]);
    by_step += x * normal(random_words({.seed = 1, .stream = 2, .step = k + 1})[0]);
    by_stream += x * normal(random_words({.seed = 1, .stream = 3, .step = k})[0]);
    by_channel += x * normal(here[1]);
  }
  const double bound = 4.5 / std::sqrt(static_cast<double>(kPairs));
  EXPECT_LT(std::abs(by_step) / kPairs, bound);
  EXPECT_LT(std::abs(by_stream) / kPairs, bound);
  EXPECT_LT(std::abs(by_channel) / kPairs, bound);
}

}  // namespace
}  // namespace wisp
