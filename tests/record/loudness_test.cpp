// How loud an input was where it is 1, and one scale for what one microphone heard.

#include "record/loudness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wisp::loudness_test {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

Recording heard(double rms) {
  Recording out{.source = "a.csv", .rate_hz = 60};
  out.channels = {{"wind", "1", Role::kInput, {0, 1, kMissing}}, {"y", "", Role::kOutput, {1, 2, 3}}};
  if (rms > 0) set_one_rms(out, "wind", rms);
  return out;
}

TEST(Loudness, IsReadBackAsItWasSaid) {
  EXPECT_EQ(**one_rms(heard(0.0421), "wind"), 0.0421);
  EXPECT_FALSE(*one_rms(heard(0), "wind"));
  EXPECT_FALSE(*one_rms(heard(0.1), "wind.heard"));
}

// A quarter of the sound's size is half the speed.
TEST(Loudness, WhatWasHeardMoreSoftlyIsLessOnALouderScale) {
  const Recording soft = *heard_at(heard(0.1), "wind", 0.4);
  EXPECT_DOUBLE_EQ(soft.channels[0].samples[1], 0.5);
  EXPECT_EQ(soft.channels[0].samples[0], 0);
  EXPECT_TRUE(std::isnan(soft.channels[0].samples[2]));
  EXPECT_EQ(soft.channels[1].samples, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(**one_rms(soft, "wind"), 0.4);
  EXPECT_EQ(heard_at(soft, "wind", 0.4)->channels[0].samples[1], soft.channels[0].samples[1]);
}

TEST(Loudness, WhatDoesNotSayHowLoudItWasStaysAsItIs) {
  EXPECT_EQ(heard_at(heard(0), "wind", 0.4)->channels[0].samples[1], 1);
  EXPECT_EQ(heard_at(heard(0.1), "draught", 0.4)->channels[0].samples[1], 1);
}

TEST(Loudness, AnythingButOneNumberAboveZeroIsRefused) {
  for (const char* bad : {"", "0", "-1", "0.1 0.2"}) {
    Recording recording = heard(0);
    recording.attributes.push_back({"wind.one_rms", bad});
    const auto found = heard_at(recording, "wind", 0.4);
    ASSERT_FALSE(found) << bad;
    EXPECT_EQ(found.error().message,
              "a.csv: \"# wind.one_rms\" holds \"" + std::string(bad) + "\", expected one number above 0");
  }
  Recording recording = heard(0);
  recording.attributes.push_back({"wind.one_rms", "loud"});
  EXPECT_FALSE(one_rms(recording, "wind"));
}

}  // namespace
}  // namespace wisp::loudness_test
