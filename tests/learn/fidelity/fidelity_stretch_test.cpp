#include "learn/fidelity/fidelity_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

namespace wisp::fidelity_stretch_test {
namespace {

Recording two_channels() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Recording recording;
  recording.source = "made.csv";
  recording.rate_hz = 10;
  recording.channels = {{"a", "", Role::kOutput, {1, 2, nan, 4, 5, 6}},
                        {"b", "", Role::kOutput, {7, 8, 9, 10, 11, 12}}};
  recording.episode_ids = {0, 0, 0, 0, 1, 1};
  return recording;
}

TEST(FidelityStretch, MissingSamplesAndEpisodesEndAStretch) {
  const auto stretches = stretches_of(two_channels(), std::vector<std::string>{"b", "a"});
  ASSERT_TRUE(stretches);
  ASSERT_EQ(stretches->size(), 3u);
  EXPECT_EQ((*stretches)[0].values, (std::vector<double>{7, 1, 8, 2}));
  EXPECT_EQ((*stretches)[1].values, (std::vector<double>{10, 4}));
  EXPECT_EQ((*stretches)[2].values, (std::vector<double>{11, 5, 12, 6}));
}

TEST(FidelityStretch, AMissingChannelIsNamedWithItsRecording) {
  const auto stretches = stretches_of(two_channels(), std::vector<std::string>{"c"});
  ASSERT_FALSE(stretches);
  EXPECT_EQ(stretches.error().message, "made.csv: there is no channel c");
}

TEST(FidelityStretch, HalvesCutTheStretchInTheMiddle) {
  const std::vector stretches{Stretch{1, {1, 2}}, Stretch{1, {3, 4, 5, 6}}};
  const Halves halves = halves_of(stretches);
  ASSERT_EQ(halves.first.size(), 2u);
  EXPECT_EQ(halves.first[1].values, (std::vector<double>{3}));
  ASSERT_EQ(halves.second.size(), 1u);
  EXPECT_EQ(halves.second[0].values, (std::vector<double>{4, 5, 6}));
}

TEST(FidelityStretch, LongStretchesAreCutAndTheRemainderKept) {
  const auto pieces = cut_to(std::vector{Stretch{1, {1, 2, 3, 4, 5}}}, 2);
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_EQ(pieces[2].values, (std::vector<double>{5}));
}

TEST(FidelityStretch, ShufflingKeepsWholeRows) {
  Stretch counted{2, {}};
  for (int t = 0; t < 100; ++t) counted.values.insert(counted.values.end(), {1.0 * t, -1.0 * t});
  const auto mixed = shuffled(std::vector{counted}, 1);
  ASSERT_EQ(mixed.front().rows(), 100u);
  EXPECT_NE(mixed.front().values, counted.values);
  for (std::size_t t = 0; t < 100; ++t) EXPECT_EQ(mixed.front()(t, 0), -mixed.front()(t, 1));
  auto sorted = channel_of(mixed, 0).front();
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(sorted, channel_of({&counted, 1}, 0).front());
}

TEST(FidelityStretch, TheSameSeedShufflesAlike) {
  const std::vector stretches{Stretch{1, {1, 2, 3, 4, 5, 6, 7, 8, 9}}};
  EXPECT_EQ(shuffled(stretches, 4).front().values, shuffled(stretches, 4).front().values);
  EXPECT_NE(shuffled(stretches, 4).front().values, shuffled(stretches, 5).front().values);
}

}  // namespace
}  // namespace wisp::fidelity_stretch_test
