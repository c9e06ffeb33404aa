// Many falls as a recording.

#include "wisp/simulate/leaf_drops.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace wisp::leaf_drops_test {
namespace {

using testing::HasSubstr;

LeafDropsOptions few_drops() {
  LeafDropsOptions options;
  options.drops = 5;
  options.seconds = 2;
  return options;
}

const std::vector<double>& samples(const Recording& recording, const std::string& name) {
  return recording.channels[find_channel(recording, name).value()].samples;
}

std::vector<std::vector<double>> numbers(const Recording& recording) {
  std::vector<std::vector<double>> all;
  for (const Channel& channel : recording.channels) all.push_back(channel.samples);
  return all;
}

TEST(LeafDrops, AreOneEpisodeEachOfPositionAttitudeAndWind) {
  const auto recording = simulate_leaf_drops(few_drops());
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_TRUE(check(*recording));
  EXPECT_EQ(recording->rate_hz, 60);
  ASSERT_EQ(episodes(*recording).size(), 5u);
  for (const Episode& episode : episodes(*recording)) {
    EXPECT_EQ(episode.size(), 120u);
    EXPECT_EQ(samples(*recording, "pos.z")[episode.begin], 0);
    EXPECT_LT(samples(*recording, "pos.z")[episode.end - 1], -0.5);
  }
  EXPECT_EQ(channels_with_role(*recording, Role::kOutput).size(), 7u);
  EXPECT_EQ(channels_with_role(*recording, Role::kInput).size(), 3u);
}

TEST(LeafDrops, HaveUnitQuaternionsWhoseSignNeverJumps) {
  // At five rows a second a leaf that tumbles turns far enough between two rows for the nearer sign to be the other.
  LeafDropsOptions options = few_drops();
  options.seconds = 20;
  options.rate_hz = 5;
  const auto recording = simulate_leaf_drops(options);
  ASSERT_TRUE(recording);
  for (const Episode& episode : episodes(*recording)) {
    for (std::size_t row = episode.begin; row < episode.end; ++row) {
      double square = 0, along = 0;
      for (const char* name : {"q.w", "q.x", "q.y", "q.z"}) {
        const std::vector<double>& q = samples(*recording, name);
        square += q[row] * q[row];
        if (row > episode.begin) along += q[row] * q[row - 1];
      }
      ASSERT_NEAR(std::sqrt(square), 1, 1e-9);
      if (row > episode.begin) {
        ASSERT_GE(along, 0) << row;
      }
    }
  }
}

TEST(LeafDrops, AreTheSameOnAnyNumberOfThreads) {
  LeafDropsOptions options = few_drops();
  options.gusts = true;
  options.threads = 1;
  const auto alone = simulate_leaf_drops(options);
  options.threads = 3;
  const auto together = simulate_leaf_drops(options);
  ASSERT_TRUE(alone && together);
  EXPECT_EQ(numbers(*alone), numbers(*together));
}

TEST(LeafDrops, DifferByDropAndBySeed) {
  LeafDropsOptions options = few_drops();
  const auto first = simulate_leaf_drops(options);
  options.seed = 2;
  const auto second = simulate_leaf_drops(options);
  ASSERT_TRUE(first && second);
  EXPECT_NE(numbers(*first), numbers(*second));
  EXPECT_NE(samples(*first, "pos.z")[119], samples(*first, "pos.z")[239]);
}

TEST(LeafDrops, RecordTheWindWhereTheLeafIs) {
  LeafDropsOptions options = few_drops();
  options.track.rows = {{0, 2, 0}};
  const auto recording = simulate_leaf_drops(options);
  ASSERT_TRUE(recording);
  for (const double wind : samples(*recording, "wind.y")) ASSERT_NEAR(wind, 2, 1e-12);
  // A steady wind takes the leaf along.
  for (const Episode& episode : episodes(*recording))
    EXPECT_GT(samples(*recording, "pos.y")[episode.end - 1], 2) << episode.begin;
}

TEST(LeafPairs, AreAlikeUntilTheGustComes) {
  LeafPairsOptions options;
  options.drops.drops = 3;
  options.drops.seconds = 1.2;
  options.clones = 4;
  const auto pairs = simulate_leaf_pairs(options);
  ASSERT_TRUE(pairs) << pairs.error().message;
  ASSERT_EQ(episodes(pairs->windy).size(), 12u);
  EXPECT_EQ(find_attribute(pairs->windy, "pair"), find_attribute(pairs->calm, "pair"));
  EXPECT_EQ(find_attribute(pairs->windy, "clones"), "4");
  for (const Episode& episode : episodes(pairs->windy)) {
    std::size_t onset = episode.begin;
    const auto strength = [&](std::size_t row) {
      return std::hypot(samples(pairs->windy, "wind.x")[row], samples(pairs->windy, "wind.y")[row]);
    };
    while (onset < episode.end && strength(onset) == 0) ++onset;
    // Half a second, give or take a fifth, at 60 rows a second; the front takes up to 0.07 s to where the leaf is.
    EXPECT_GE(onset - episode.begin, 20u);
    EXPECT_LE(onset - episode.begin, 41u);
    for (std::size_t row = episode.begin; row < onset; ++row) {
      ASSERT_EQ(samples(pairs->windy, "pos.x")[row], samples(pairs->calm, "pos.x")[row]);
    }
    const std::size_t last = episode.end - 1;
    EXPECT_NE(samples(pairs->windy, "pos.x")[last], samples(pairs->calm, "pos.x")[last]);
    EXPECT_EQ(samples(pairs->calm, "wind.x")[onset], 0);
  }
}

TEST(LeafPairs, BlowALeafAlongWithTheGust) {
  LeafPairsOptions options;
  options.drops.drops = 8;
  options.drops.seconds = 1;
  const auto pairs = simulate_leaf_pairs(options);
  ASSERT_TRUE(pairs);
  double along = 0;
  for (const Episode& episode : episodes(pairs->windy)) {
    double x = 0, y = 0;
    for (std::size_t row = episode.begin; row < episode.end; ++row) {
      x += samples(pairs->windy, "wind.x")[row];
      y += samples(pairs->windy, "wind.y")[row];
    }
    const std::size_t last = episode.end - 1;
    const double dx = samples(pairs->windy, "pos.x")[last] - samples(pairs->calm, "pos.x")[last];
    const double dy = samples(pairs->windy, "pos.y")[last] - samples(pairs->calm, "pos.y")[last];
    along += (dx * x + dy * y) / std::hypot(x, y);
  }
  // A third of a second at about 1 m/s; over 8 × 32 falls the spread of 0.4 m is within 0.03 m of the mean's.
  EXPECT_GT(along / 256, 0.15);
  EXPECT_LT(along / 256, 0.6);
}

// A petal, confetti, a strip, and paper on a heavy planet.
TEST(LeafDrops, OfSmallLeavesStayFinite) {
  for (const Leaf& leaf :
       {Leaf{.length = 0.02, .width = 0.015}, Leaf{.length = 0.005, .width = 0.005},
        Leaf{.length = 0.001, .width = 0.001}, Leaf{.length = 0.3, .width = 0.01}, Leaf{.gravity = 40}}) {
    LeafDropsOptions options = few_drops();
    options.leaf = leaf;
    const auto made = simulate_leaf_drops(options);
    EXPECT_TRUE(made) << made.error().message;
  }
}

TEST(LeafDrops, ThatCannotBeMadeAreExplained) {
  const auto message = [](auto change) {
    LeafDropsOptions options = few_drops();
    change(options);
    const auto made = simulate_leaf_drops(options);
    return made ? std::string("made") : made.error().message;
  };
  EXPECT_THAT(message([](LeafDropsOptions& o) { o.drops = 0; }), HasSubstr("drops is 0"));
  EXPECT_THAT(message([](LeafDropsOptions& o) { o.seconds = -3; }), HasSubstr("seconds is -3"));
  EXPECT_THAT(message([](LeafDropsOptions& o) { o.leaf.areal_density = 5000; }), HasSubstr("areal density"));
  EXPECT_THAT(message([](LeafDropsOptions& o) { o.track.rows = {{0, 1e9, 0}}; }), HasSubstr("within 30 m/s"));
  EXPECT_THAT(message([](LeafDropsOptions& o) { o.drops = 100000, o.seconds = 3600; }), HasSubstr("too many"));
  LeafPairsOptions pairs;
  pairs.clones = 0;
  EXPECT_THAT(simulate_leaf_pairs(pairs).error().message, HasSubstr("clones"));
}

}  // namespace
}  // namespace wisp::leaf_drops_test
