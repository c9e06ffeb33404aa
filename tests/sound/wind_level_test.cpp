#include "wisp/sound/wind_level.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <vector>

#include "sound/wind_sounds.hpp"

namespace wisp::wind_level_test {
namespace {

using sounds::Samples;
using ::testing::HasSubstr;

WindLevel make(const SoundFormat& format, const WindOptions& options = {}) {
  auto wind = WindLevel::create(format, options);
  EXPECT_TRUE(wind) << wind.error().message;
  return std::move(wind).value();
}

/// All frames of a sound, fed in blocks of `block` samples.
template <class Sample>
std::vector<WindFrame> hear(WindLevel& wind, const std::vector<Sample>& sound, std::size_t block = 1 << 20) {
  std::vector<WindFrame> all;
  std::vector<WindFrame> some(7);
  std::span<const Sample> left = sound;
  while (!left.empty()) {
    const WindFed fed = wind.feed(left.first(std::min(block, left.size())), some);
    left = left.subspan(fed.samples);
    all.insert(all.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(fed.frames));
  }
  return all;
}

std::vector<WindFrame> hear(const SoundFormat& format, const Samples& sound, const WindOptions& options = {}) {
  WindLevel wind = make(format, options);
  return hear(wind, sound);
}

bool same_bits(const std::vector<WindFrame>& a, const std::vector<WindFrame>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const WindFrame& x = a[i];
    const WindFrame& y = b[i];
    const float left[] = {x.rms, x.rms_clean, x.level, x.speed, x.wind, x.confidence, x.background, x.clipped};
    const float right[] = {y.rms, y.rms_clean, y.level, y.speed, y.wind, y.confidence, y.background, y.clipped};
    if (x.index != y.index || std::memcmp(left, right, sizeof left) != 0) return false;
  }
  return true;
}

/// Room, then three gusts and a voice: something of everything.
Samples scene(double rate_hz) {
  Samples sound = sounds::room(8, rate_hz, 1e-3);
  sounds::add(sound, sounds::steady_blowing(1, rate_hz, 0.05), 1, rate_hz);
  sounds::add(sound, sounds::voice(2, rate_hz, 130, 0.05), 3, rate_hz);
  sounds::add(sound, sounds::steady_blowing(0.7, rate_hz, 0.1, 5), 6, rate_hz);
  return sound;
}

double mean_of(const std::vector<WindFrame>& frames, float WindFrame::*field, double from, double to) {
  double sum = 0;
  double all = 0;
  for (const WindFrame& frame : frames) {
    const double seconds = (static_cast<double>(frame.index) + 0.5) / 60;
    if (seconds < from || seconds >= to) continue;
    sum += static_cast<double>(frame.*field);
    all += 1;
  }
  return sum / all;
}

/// Mean wind after the first fifth of the frames.
double settled_wind(const std::vector<WindFrame>& frames) {
  double sum = 0;
  const std::size_t first = frames.size() / 5;
  for (std::size_t k = first; k < frames.size(); ++k) sum += static_cast<double>(frames[k].wind);
  return sum / static_cast<double>(frames.size() - first);
}

TEST(WindLevel, LatencyIsThatOfTheFiltersAndTheSmoothing) {
  for (const double rate : {8000.0, 16000.0, 44100.0, 48000.0, 96000.0, 192000.0}) {
    WindOptions smooth;
    smooth.smoothing_seconds = 0.1;
    const double filters = make({rate, 1}).latency_seconds();
    EXPECT_GT(filters, 0.0001) << rate;
    EXPECT_LT(filters, 0.005) << rate;  // half of a low-pass of some tens of taps
    EXPECT_NEAR(make({rate, 1}, smooth).latency_seconds(), filters + 0.1, 1e-12) << rate;
  }
}

TEST(WindLevel, SilenceIsNoWind) {
  for (const WindFrame& frame : hear({48000, 1}, Samples(48000, 0.0F))) {
    EXPECT_EQ(frame.rms, 0.0F);
    EXPECT_EQ(frame.speed, 0.0F);
    EXPECT_EQ(frame.wind, 0.0F);
    EXPECT_LT(frame.confidence, 0.01F);
  }
}

TEST(WindLevel, RmsIsThatOfTheFramesSamples) {
  const double rate = 44100;
  const Samples sound = scene(rate);
  const auto frames = hear({rate, 1}, sound, {.frame_rate_hz = 30});
  ASSERT_EQ(frames.size(), 240U);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const double exact = sounds::rms_of(std::span(sound).subspan(k * 1470, 1470));
    // 1470 squares summed in single precision, in pieces: a few roundings of 6e-8 each.
    EXPECT_NEAR(frames[k].rms, exact, 3e-6 * exact);
  }
}

// The level band is flat below 300 Hz but for the high-pass at 100 Hz (0.914 at 150 Hz), rises as x(t) − z x(t−1)
// above, and is 0.914 of that at 600 Hz by the low-pass at 900 Hz.
TEST(WindLevel, LowSoundCountsNearlyAsMuchAsItsRms) {
  for (const double rate : {8000.0, 44100.0, 96000.0}) {
    const auto level_of = [rate](double hz) {
      Samples sound = sounds::room(2, rate, 1e-4);
      for (std::size_t i = 0; i < sound.size() / 2; ++i)
        sound[sound.size() / 2 + i] +=
            0.1F * static_cast<float>(std::sin(2 * std::numbers::pi * hz * static_cast<double>(i) / rate));
      return mean_of(hear({rate, 1}, sound), &WindFrame::level, 1.2, 1.6);
    };
    EXPECT_NEAR(level_of(300), 0.1 / std::numbers::sqrt2, 0.002) << rate;
    EXPECT_NEAR(level_of(150) / level_of(300), 0.73, 0.02) << rate;
    EXPECT_NEAR(level_of(600) / level_of(300), 1.45, 0.05) << rate;
  }
}

TEST(WindLevel, FramesEndWhereTheVideosDo) {
  WindLevel wind = make({44100, 1}, {.frame_rate_hz = 30000.0 / 1001});
  const auto frames = hear(wind, Samples(44100 * 20, 0.0F));
  EXPECT_EQ(frames.size(), 599U);  // 20 s · 29.97 = 599.4
  EXPECT_EQ(frames.back().index, 598);
}

TEST(WindLevel, BlocksOfAnySizeGiveTheSameBits) {
  const Samples sound = scene(44100);
  WindLevel whole = make({44100, 1});
  const auto expected = hear(whole, sound);
  for (const std::size_t block : {1U, 17U, 441U, 1024U, 65537U}) {
    WindLevel wind = make({44100, 1});
    EXPECT_TRUE(same_bits(hear(wind, sound, block), expected)) << block;
  }
}

TEST(WindLevel, SixteenBitSamplesAreThoseSamplesOver32768) {
  std::vector<std::int16_t> integers;
  Samples floats;
  for (const float x : scene(16000)) {
    integers.push_back(static_cast<std::int16_t>(std::lround(x * 32767)));
    floats.push_back(static_cast<float>(integers.back()) / 32768);
  }
  WindLevel one = make({16000, 1});
  WindLevel other = make({16000, 1});
  EXPECT_TRUE(same_bits(hear(one, integers), hear(other, floats)));
}

TEST(WindLevel, StopsWhenFramesAreFullAndGoesOnWithTheRest) {
  WindLevel wind = make({48000, 1});
  const Samples sound(48000, 0.1F);
  std::vector<WindFrame> three(3);
  const WindFed fed = wind.feed(std::span<const float>(sound), three);
  EXPECT_EQ(fed.frames, 3U);
  EXPECT_EQ(fed.samples, 4U * 800 - 1);  // the fourth frame's last sample would need a fourth place
  const WindFed rest = wind.feed(std::span<const float>(sound).subspan(fed.samples, 1), three);
  EXPECT_EQ(rest.frames, 1U);
  EXPECT_EQ(three[0].index, 3);
  EXPECT_EQ(wind.latest().index, 3);
}

TEST(WindLevel, TwoEqualChannelsAreOne) {
  const Samples mono = scene(48000);
  Samples stereo;
  for (const float x : mono) stereo.insert(stereo.end(), {x, x});
  const auto one = hear({48000, 1}, mono);
  const auto two = hear({48000, 2}, stereo);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_NEAR(two[i].rms, one[i].rms, 1e-6);
    EXPECT_NEAR(two[i].wind, one[i].wind, 1e-4);
    EXPECT_NEAR(two[i].confidence, one[i].confidence, 1e-3);
  }
}

TEST(WindLevel, PowerIsTheMeanOfTheChannels) {
  Samples stereo;
  for (const float x : sounds::steady_blowing(2, 48000, 0.1)) stereo.insert(stereo.end(), {x, 0.0F});
  const auto frames = hear({48000, 2}, stereo);
  EXPECT_NEAR(mean_of(frames, &WindFrame::rms, 0.5, 2), 0.1 / std::sqrt(2), 0.003);
}

TEST(WindLevel, AVoiceOfOppositeSignsInBothChannelsIsStillAVoice) {
  Samples stereo;
  for (const float x : sounds::voice(6, 48000, 120, 0.1)) stereo.insert(stereo.end(), {x, -x});
  EXPECT_LT(mean_of(hear({48000, 2}, stereo), &WindFrame::confidence, 0, 6), 0.05);
}

TEST(WindLevel, NumbersThatAreNoneAndHugeOnesDoNoLastingHarm) {
  Samples sound = scene(48000);
  sound[50] = std::numeric_limits<float>::quiet_NaN();
  sound[51] = std::numeric_limits<float>::infinity();
  sound[52] = -std::numeric_limits<float>::infinity();
  sound[53] = 3e38F;
  const auto harmed = hear({48000, 1}, sound);
  const auto sound_ones = hear({48000, 1}, scene(48000));
  for (const WindFrame& frame : harmed) {
    EXPECT_TRUE(std::isfinite(frame.rms) && std::isfinite(frame.speed) && std::isfinite(frame.confidence));
  }
  EXPECT_NEAR(harmed.back().rms, sound_ones.back().rms, 1e-6);
  EXPECT_NEAR(mean_of(harmed, &WindFrame::wind, 6.1, 6.6), mean_of(sound_ones, &WindFrame::wind, 6.1, 6.6), 0.05);
}

TEST(WindLevel, ClippedSamplesAreCounted) {
  Samples sound(4800, 0.5F);
  for (std::size_t i = 0; i < 1200; ++i) sound[i] = i % 2 == 0 ? 1.0F : -1.0F;
  const auto frames = hear({48000, 1}, sound, {.frame_rate_hz = 10});
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_FLOAT_EQ(frames[0].clipped, 0.25F);
}

TEST(WindLevel, SpeedIsProportionalToWindWhosePressureGoesWithItsSquare) {
  Samples sound = sounds::room(14, 44100, 1e-4);
  const auto steps = [](double t) { return t < 3 ? 1.0 : t < 6 ? 0.5 : t < 9 ? 0.25 : 0.0; };
  sounds::add(sound, sounds::blowing(10, 44100, 0.1, steps), 2, 44100);
  const auto frames = hear({44100, 1}, sound, {.floor_rise_db_per_second = 0});
  const double full = mean_of(frames, &WindFrame::wind, 4, 5);
  // The gain may still be settling between these stretches, hence ratios of speeds and no more than 8 %.
  EXPECT_NEAR(mean_of(frames, &WindFrame::wind, 6, 8) / full, 0.5, 0.04);
  EXPECT_NEAR(mean_of(frames, &WindFrame::wind, 9, 11) / full, 0.25, 0.02);
  EXPECT_NEAR(mean_of(frames, &WindFrame::wind, 12, 14), 0, 1e-3);
}

TEST(WindLevel, TheExponentIsWhatTheMicrophoneHas) {
  Samples sound = sounds::room(8, 44100, 1e-4);
  sounds::add(sound, sounds::blowing(6, 44100, 0.1, [](double t) { return t < 3 ? 1.0 : 0.5; }), 2, 44100);
  const auto frames = hear({44100, 1}, sound, {.exponent = 1, .floor_rise_db_per_second = 0});
  EXPECT_NEAR(mean_of(frames, &WindFrame::speed, 6, 8) / mean_of(frames, &WindFrame::speed, 4, 5), 0.25, 0.02);
}

/// A quiet room of three seconds, then a second of blowing at each of these levels, every two seconds.
Samples blows_of(const std::vector<double>& levels) {
  Samples sound = sounds::room(3 + 2 * static_cast<double>(levels.size()), 44100, 3e-4);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    sounds::add(sound, sounds::steady_blowing(1, 44100, levels[i], 10 + i), 3 + 2 * static_cast<double>(i), 44100);
  }
  return sound;
}

double blow_mean(const std::vector<WindFrame>& frames, double blow) {
  return mean_of(frames, &WindFrame::wind, 3.2 + 2 * blow, 3.9 + 2 * blow);
}

TEST(WindLevel, AHardBlowIsNotMeasuredByItself) {
  const auto frames = hear({44100, 1}, blows_of({0.3, 0.3, 0.3}));
  for (const int blow : {0, 1, 2}) EXPECT_GT(blow_mean(frames, blow), 1.7) << blow;
  EXPECT_NEAR(blow_mean(frames, 0) / mean_of(frames, &WindFrame::wind, 3.6, 3.9), 1, 0.1);  // nor does it wear off
}

TEST(WindLevel, WhatIsLoudForATenthOfASecondIsNoStrongWind) {
  const auto strongest_after = [](double seconds) {
    Samples sound = sounds::room(4, 44100, 3e-4);
    sounds::add(sound, sounds::steady_blowing(seconds, 44100, 0.6), 3, 44100);
    float strongest = 0;
    for (const WindFrame& frame : hear({44100, 1}, sound)) strongest = std::max(strongest, frame.wind);
    return strongest;
  };
  EXPECT_LE(strongest_after(0.05), 1);
  EXPECT_GT(strongest_after(0.3), 2);
}

TEST(WindLevel, ARoomThatHasBecomeLouderIsToldOf) {
  WindLevel wind = make({44100, 1});
  hear(wind, sounds::room(3, 44100, 1e-3));
  EXPECT_LT(wind.room_rise_db(), 1);
  hear(wind, sounds::steady_blowing(2, 44100, 0.1));  // a breath is not the room
  EXPECT_LT(wind.room_rise_db(), 4);
  hear(wind, sounds::room(3, 44100, 1e-3));
  EXPECT_LT(wind.room_rise_db(), 1);
  hear(wind, sounds::room(9, 44100, 3e-2));  // a fan that was switched on
  EXPECT_GT(wind.room_rise_db(), 6);
  hear(wind, sounds::room(9, 44100, 1e-3));
  EXPECT_LT(wind.room_rise_db(), 1);
}

TEST(WindLevel, SoftBreathIsSoftFromTheFirst) {
  const auto frames = hear({44100, 1}, blows_of({0.01, 0.01, 0.01}));
  for (const int blow : {0, 1, 2}) {
    EXPECT_GT(blow_mean(frames, blow), 0.3) << blow;
    EXPECT_LT(blow_mean(frames, blow), 1) << blow;
  }
}

TEST(WindLevel, AModestBlowAfterSoftBreathsIsAHardOne) {
  EXPECT_LT(blow_mean(hear({44100, 1}, blows_of({0.05})), 0), 1.27);
  EXPECT_GT(blow_mean(hear({44100, 1}, blows_of({0.01, 0.01, 0.05})), 2), 1.27);
}

TEST(WindLevel, AGuidedCalibrationTellsASoftBreathAtAHotMicrophone) {
  const auto breath_of = [](bool guided) {
    WindLevel wind = make({44100, 1});
    hear(wind, sounds::room(2.1, 44100, 1e-3));
    if (guided) {
      wind.calibrate(WindAsk::kBreatheGently, 1);
      EXPECT_FALSE(wind.calibrated());
      hear(wind, sounds::steady_blowing(1.1, 44100, 0.1, 4));
      EXPECT_TRUE(wind.calibrated());
    }
    hear(wind, sounds::room(1, 44100, 1e-3));
    return settled_wind(hear(wind, sounds::steady_blowing(1, 44100, 0.1, 9)));
  };
  EXPECT_GT(breath_of(false), 1.27);
  EXPECT_LT(breath_of(true), 1);
}

// A hard blow of 0.6 clips most microphones: it is 12 dB over a breath of 0.15, and no 21 dB.
TEST(WindLevel, AGuidedCalibrationKeepsTheBreathSoftWhereTheHardBlowIsNotMuchHarder) {
  for (std::uint64_t seed = 20; seed < 26; ++seed) {
    WindLevel wind = make({44100, 1});
    hear(wind, sounds::room(2.1, 44100, 1e-3));
    wind.calibrate(WindAsk::kBreatheGently, 1);
    hear(wind, sounds::steady_blowing(1.1, 44100, 0.15, 4));
    hear(wind, sounds::room(1, 44100, 1e-3));
    wind.calibrate(WindAsk::kBlowHard, 1);
    hear(wind, sounds::steady_blowing(1.1, 44100, 0.6, 5));
    hear(wind, sounds::room(1, 44100, 1e-3));
    const double soft = settled_wind(hear(wind, sounds::steady_blowing(1, 44100, 0.15, seed)));
    hear(wind, sounds::room(1, 44100, 1e-3));
    const double hard = settled_wind(hear(wind, sounds::steady_blowing(1, 44100, 0.6, seed + 10)));
    EXPECT_LT(soft, 0.8) << seed;
    EXPECT_GT(hard, 1.3) << seed;
  }
}

TEST(WindLevel, AGuidedCalibrationSaysThatNobodyBlew) {
  WindLevel wind = make({44100, 1});
  const float before = wind.calibration().gust_rms;
  wind.calibrate(WindAsk::kBlowHard, 1);
  hear(wind, sounds::room(1.1, 44100, 1e-3));
  EXPECT_FALSE(wind.calibrating());
  EXPECT_FALSE(wind.calibrated());
  EXPECT_EQ(wind.calibration().gust_rms, before);
}

TEST(WindLevel, WhatIsSteadyInTheRoomIsNoWindThoughItSwells) {
  const auto swell = [](double t) { return 0.8 + 0.2 * std::sin(2 * std::numbers::pi * 0.5 * t); };
  WindLevel wind = make({44100, 1});
  const auto frames = hear(wind, sounds::blowing(12, 44100, 0.1, swell));
  EXPECT_LT(mean_of(frames, &WindFrame::wind, 0, 12), 0.02);
}

TEST(WindLevel, ACarThatPassesIsNoWind) {
  Samples sound = sounds::room(20, 44100, 1e-3);
  const auto pass = [](double t) { return std::exp(-(t - 10) * (t - 10) / 18); };
  sounds::add(sound, sounds::blowing(20, 44100, 0.1, pass), 0, 44100);
  EXPECT_LT(mean_of(hear({44100, 1}, sound), &WindFrame::wind, 2, 18), 0.05);
}

TEST(WindLevel, BackgroundIsTheMeanOfTheQuiet) {
  const auto frames = hear({44100, 1}, scene(44100));
  EXPECT_NEAR(frames[170].background, 1e-3, 5e-5);
  EXPECT_NEAR(mean_of(frames, &WindFrame::rms_clean, 2.5, 3), 0, 3e-5);
  EXPECT_NEAR(mean_of(frames, &WindFrame::rms_clean, 1.2, 1.9), 0.05, 0.01);
}

TEST(WindLevel, AQuieterRoomIsLearnedAfterALongBlow) {
  Samples sound = sounds::room(20, 16000, 1e-3);
  sounds::add(sound, sounds::steady_blowing(12, 16000, 0.1), 1, 16000);
  const auto frames = hear({16000, 1}, sound, {.floor_rise_db_per_second = 6});
  EXPECT_GT(mean_of(frames, &WindFrame::background, 12, 13), 0.05);  // no pause for so long: it passes for a fan
  EXPECT_NEAR(mean_of(frames, &WindFrame::background, 15, 16), 1e-3, 1e-4);
}

TEST(WindLevel, WhatIsHeardFirstIsTheRoomFromTheFirst) {
  WindLevel wind = make({44100, 1});
  hear(wind, sounds::room(1.5, 44100, 2e-3));
  EXPECT_NEAR(wind.calibration().background_rms, 2e-3, 2e-5);
  EXPECT_NEAR(wind.latest().background, 2e-3, 2e-5);
  WindLevel rain = make({44100, 1});
  float strongest = 0;
  for (const WindFrame& frame : hear(rain, sounds::steady_blowing(20, 44100, 0.1)))
    strongest = std::max(strongest, frame.wind);
  EXPECT_LT(strongest, 0.02);
}

TEST(WindLevel, AKnownCalibrationSparesTheFinding) {
  const double rate = 44100;
  WindLevel before = make({rate, 1});
  hear(before, sounds::room(2.1, rate, 2e-3));
  hear(before, sounds::steady_blowing(1, rate, 0.2));
  hear(before, sounds::room(1, rate, 2e-3));
  WindLevel after = make({rate, 1});
  after.set_calibration(before.calibration());
  hear(after, sounds::room(0.5, rate, 2e-3));
  const auto frames = hear(after, sounds::steady_blowing(1, rate, 0.2, 9));
  EXPECT_NEAR(settled_wind(frames), settled_wind(hear(before, sounds::steady_blowing(1, rate, 0.2, 9))), 0.02);
  EXPECT_NE(before.calibration().gust_rms, WindLevel(make({rate, 1})).calibration().gust_rms);
  EXPECT_NEAR(frames[30].background, 2e-3, 2e-5);
}

TEST(WindLevel, ResetIsANewBeginning) {
  WindLevel wind = make({16000, 1});
  const auto first = hear(wind, scene(16000));
  wind.reset();
  EXPECT_TRUE(same_bits(hear(wind, scene(16000)), first));
}

TEST(WindLevel, SmoothingSteadiesTheLevel) {
  const auto spread = [](double smoothing) {
    Samples sound = sounds::room(7, 44100, 1e-4);
    sounds::add(sound, sounds::steady_blowing(6, 44100, 0.1), 1, 44100);
    const auto frames = hear({44100, 1}, sound, {.smoothing_seconds = smoothing});
    const double mean = mean_of(frames, &WindFrame::level, 2, 6);
    double squares = 0;
    for (std::size_t i = 120; i < frames.size(); ++i)
      squares += std::pow(static_cast<double>(frames[i].level) - mean, 2);
    return std::sqrt(squares / static_cast<double>(frames.size() - 120)) / mean;
  };
  EXPECT_LT(spread(0.1), 0.6 * spread(0));
}

TEST(WindLevel, SaysWhatItCannotDo) {
  const auto message = [](const SoundFormat& format, const WindOptions& options) {
    auto wind = WindLevel::create(format, options);
    return wind ? std::string() : wind.error().message;
  };
  EXPECT_EQ(message({7999, 1}, {}), "wind level: the sound's rate is 7999 Hz, expected 8000 to 192000 Hz");
  EXPECT_THAT(message({48000, 0}, {}), HasSubstr("the number of channels is 0, expected 1 to 8"));
  EXPECT_THAT(message({48000, 1}, {.frame_rate_hz = 0.5}),
              HasSubstr("the frame rate is 0.5 Hz, expected 1 to 1000 Hz"));
  EXPECT_THAT(message({48000, 1}, {.exponent = 3}), HasSubstr("the exponent is 3, expected 0.1 to 2"));
  EXPECT_THAT(message({48000, 1}, {.smoothing_seconds = -1}), HasSubstr("the smoothing is -1 s"));
  EXPECT_THAT(message({std::nan(""), 1}, {}), HasSubstr("the sound's rate is nan Hz"));
  EXPECT_EQ(message({8000, 8}, {.frame_rate_hz = 1000}), "");
}

}  // namespace
}  // namespace wisp::wind_level_test
