// Preparations of recordings: what they do to known signals, and that models keep them.

#include "wisp/learn/prepare.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "learn/arx/made_system.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/model/file.hpp"

namespace wisp::prepare_test {
namespace {

using testing::HasSubstr;

// A tone about a level with a slope, 100 samples a second.
Recording tone(double hz, double slope = 0, std::size_t rows = 2000) {
  Recording recording{.source = "tone", .rate_hz = 100};
  std::vector<double> y(rows);
  for (std::size_t t = 0; t < rows; ++t) {
    const double seconds = static_cast<double>(t) / 100;
    y[t] = 5 + std::sin(2 * std::numbers::pi * hz * seconds) + slope * seconds;
  }
  recording.channels = {{"y", "", Role::kOutput, std::move(y)}};
  return recording;
}

const std::vector<double>& samples(const Result<Recording>& recording) { return recording->channels[0].samples; }

// Amplitude of a tone, from its middle half.
double amplitude(const std::vector<double>& y) {
  const std::size_t first = y.size() / 4, last = 3 * y.size() / 4;
  double sum = 0, square = 0;
  for (std::size_t t = first; t < last; ++t) sum += y[t], square += y[t] * y[t];
  const double n = static_cast<double>(last - first);
  return std::sqrt(2 * (square / n - sum / n * (sum / n)));
}

double mean_of(const std::vector<double>& y) {
  double sum = 0;
  for (double one : y) sum += one;
  return sum / static_cast<double>(y.size());
}

TEST(Prepare, WordsSayWhatIsDoneAndReadBack) {
  const auto read = parse_preparation({"resample:20", "detrend", "lowpass:7.5"});
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, (Preparation{.detrend = true, .lowpass_hz = 7.5, .resample_hz = 20}));
  EXPECT_EQ(text_of(*read), "detrend,lowpass:7.5,resample:20");
  for (const char* bad : {"lowpas:5", "lowpass", "lowpass:x", "lowpass:-1", "lowpass:0", "lowpass:inf", "detrend:1"}) {
    EXPECT_FALSE(parse_preparation({bad})) << bad;
  }
  EXPECT_THAT(parse_preparation({"lowpass:1", "lowpass:2"}).error().message, HasSubstr("twice"));
}

TEST(Prepare, ALineIsTakenOffAndTheMeanStays) {
  const Recording drifting = tone(1, 0.7);
  const auto out = prepare(drifting, {.detrend = true});
  ASSERT_TRUE(out);
  EXPECT_NEAR(mean_of(samples(out)), mean_of(drifting.channels[0].samples), 1e-9);
  EXPECT_NEAR(amplitude(samples(out)), 1, 0.03);
  EXPECT_GT(amplitude(drifting.channels[0].samples), 2);
}

TEST(Prepare, FiltersAreThreeDecibelsDownAtTheirFrequencyAndDoNotDelay) {
  for (const auto& [hz, low, high] :
       {std::tuple{2.0, 1.0, 0.0}, {10.0, std::sqrt(0.5), std::sqrt(0.5)}, {40.0, 0.0, 1.0}}) {
    const auto lowpass = prepare(tone(hz), {.lowpass_hz = 10}), highpass = prepare(tone(hz), {.highpass_hz = 10});
    ASSERT_TRUE(lowpass && highpass);
    EXPECT_NEAR(amplitude(samples(lowpass)), low, 0.01) << hz;
    EXPECT_NEAR(amplitude(samples(highpass)), high, 0.01) << hz;
    EXPECT_NEAR(mean_of(samples(highpass)), 5, 0.02);
  }
  const auto slow = prepare(tone(2), {.lowpass_hz = 10});
  for (std::size_t t = 500; t < 1500; ++t) {
    EXPECT_NEAR(samples(slow)[t], tone(2).channels[0].samples[t], 0.005);
  }
}

TEST(Prepare, AnotherRateKeepsWhatItCanShow) {
  for (const double rate : {40.0, 30.0, 250.0}) {
    const auto out = prepare(tone(3), {.resample_hz = rate});
    ASSERT_TRUE(out);
    EXPECT_EQ(out->rate_hz, rate);
    EXPECT_EQ(out->rows(), static_cast<std::size_t>(19.99 * rate) + 1);
    for (std::size_t t = out->rows() / 4; t < 3 * out->rows() / 4; ++t) {
      const double want = 5 + std::sin(2 * std::numbers::pi * 3 * static_cast<double>(t) / rate);
      EXPECT_NEAR(samples(out)[t], want, 0.02) << rate << " " << t;
    }
  }
  const auto folded = prepare(tone(38), {.resample_hz = 40});  // would be 2 Hz
  EXPECT_LT(amplitude(samples(folded)), 0.05);
}

TEST(Prepare, MissingSamplesStayMissingAndEpisodesApart) {
  Recording recording = tone(2);
  recording.channels[0].samples[700] = std::nan("");
  recording.episode_ids.assign(2000, 0);
  for (std::size_t t = 1000; t < 2000; ++t) {
    recording.episode_ids[t] = 1;
    recording.channels[0].samples[t] += 100;
  }
  const auto out = prepare(recording, {.lowpass_hz = 10});
  ASSERT_TRUE(out);
  EXPECT_TRUE(std::isnan(samples(out)[700]));
  EXPECT_NEAR(samples(out)[701], recording.channels[0].samples[701], 0.01);
  EXPECT_NEAR(samples(out)[999], recording.channels[0].samples[999], 0.05);
  EXPECT_NEAR(samples(out)[1000], recording.channels[0].samples[1000], 0.05);
  const auto half = prepare(recording, {.resample_hz = 50});
  ASSERT_TRUE(half);
  EXPECT_EQ(episodes(*half).size(), 2u);
  EXPECT_EQ(half->rows(), 1000u);
}

TEST(Prepare, WhatCannotBeDoneIsAnErrorThatNamesTheRecording) {
  for (const Preparation& bad : {Preparation{.lowpass_hz = 50},
                                 {.highpass_hz = 60},
                                 {.resample_hz = 1e5},
                                 {.highpass_hz = 5, .lowpass_hz = 4},
                                 {.resample_hz = 0.01}}) {
    const auto out = prepare(tone(1), bad);
    ASSERT_FALSE(out) << text_of(bad);
    EXPECT_THAT(out.error().message, HasSubstr("tone: "));
  }
}

// A system whose input and output both drift.
Recording drifting(unsigned seed) {
  Recording recording = record_system(made_system(), 2000, seed);
  for (std::size_t c = 2; c < 4; ++c) {
    for (std::size_t t = 0; t < 2000; ++t) recording.channels[c].samples[t] += 0.02 * static_cast<double>(t);
  }
  return recording;
}

TEST(Prepare, AModelRemembersAndItsRecordingsArePreparedAlike) {
  const ArxModel made = made_system();
  const ArxRecipe recipe{.name = "made",
                         .inputs = {"u1", "u2"},
                         .outputs = {"y1", "y2"},
                         .preparation = {.detrend = true},
                         .na = made.orders.na,
                         .nb = made.orders.nb,
                         .nk = made.orders.nk};
  const auto fit = learn(drifting(21), recipe);
  ASSERT_TRUE(fit) << fit.error().message;
  const auto stored = parse_model(*model_bytes(fit->model), "made");
  ASSERT_TRUE(stored) << stored.error().message;
  EXPECT_EQ(stored->training.preparation, recipe.preparation);
  const auto fits = [](const Result<Report>& report) {
    return std::get<double>(report->sections.front().tables.front().rows.front()[1]);
  };
  const Recording other = drifting(22);
  const auto alike = validate(*stored, other, {.steps = {kFreeRun}});
  ASSERT_TRUE(alike);
  EXPECT_GT(fits(alike), 80);
  Model unprepared = *stored;
  unprepared.training.preparation = {};
  EXPECT_LT(fits(validate(unprepared, other, {.steps = {kFreeRun}})), 30);
  const auto compared = compare(std::vector<NamedModel>{{"one", *stored}, {"other", unprepared}}, other);
  ASSERT_FALSE(compared);
  EXPECT_THAT(compared.error().message, HasSubstr("different recordings"));
}

TEST(Prepare, AModelOfAnotherRateTakesRecordingsAtTheirOwn) {
  const ArxRecipe recipe{.name = "made", .inputs = {"u1", "u2"}, .outputs = {"y1"}, .preparation = {.resample_hz = 5}};
  const Recording recording = record_system(made_system(), 2000, 23);
  const auto fit = learn(recording, recipe);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->model.rate_hz, 5);
  const auto table = predict(fit->model, recording);
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_EQ(table->rate_hz, 5);
  EXPECT_EQ(table->rows(), 1000u);
}

}  // namespace
}  // namespace wisp::prepare_test
