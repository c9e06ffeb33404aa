#include "learn/flame/flame_sizes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "learn/flame/made_blow_outs.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::flame_sizes_test {
namespace {

using testing::HasSubstr;

// Shrinks the outline of a row towards the middle of its base.
void scale_row(Recording& recording, std::size_t row, double size) {
  const OutlineLayout layout = *outline_layout(recording);
  const auto sample = [&](std::size_t k) -> double& { return recording.channels[layout.outputs[k]].samples[row]; };
  const std::size_t last = layout.outputs.size() - 2;
  const double base[] = {(sample(0) + sample(last)) / 2, (sample(1) + sample(last + 1)) / 2};
  for (std::size_t k = 0; k < layout.outputs.size(); ++k) sample(k) = base[k % 2] + size * (sample(k) - base[k % 2]);
}

// Deaths of which each takes `decay` seconds and re-ignitions that take `re_ignition`, beginning anywhere between two
// rows.
Recording decay_and_re_ignition(double decay, double re_ignition, std::uint64_t seed) {
  Recording recording = made::blow_out_recording({.rows = 5400, .shortest = 0.2, .seed = seed}).recording;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> between(0, 1);
  const auto ramp = [&](double seconds, std::size_t at, int way) {
    const double since = between(random);
    for (int k = 0;
         (k + since) / recording.rate_hz < seconds && at + static_cast<std::size_t>(way * k) < recording.rows(); ++k) {
      scale_row(recording, at + static_cast<std::size_t>(way * k), (k + since) / recording.rate_hz / seconds);
    }
  };
  const auto blow_outs = *find_blow_outs(recording, "wind");
  for (const BlowOut& blow_out : blow_outs) {
    ramp(decay, blow_out.gone - 1, -1);
    if (blow_out.back < recording.rows()) ramp(re_ignition, blow_out.back, 1);
  }
  return recording;
}

std::vector<SizeCurve> curves_of(const Recording& recording, SizeChange change) {
  const auto blow_outs = *find_blow_outs(recording, "wind");
  const auto sizes = flame_sizes(recording, blow_outs);
  EXPECT_TRUE(sizes) << sizes.error().message;
  return size_curves(recording, *sizes, blow_outs, change);
}

// That nobody sees when between two rows a change begins moves the mean start of re-ignition by half a row, since a
// bank's begins with a whole step, and a ramp through nothing answers with 1.5 times that: 0.75 rows. The starts'
// spread adds 3 · 1.5 · 0.29 / sqrt(8) = 0.46 for eight deaths, flicker of 3 % on twelve rows 3 · 144 · 0.03 / 25 /
// sqrt(8) = 0.2: together less than 1.5 rows.
TEST(FlameSizes, KnownDurationsAreFoundAgain) {
  constexpr double kRow = 1.0 / 60;
  for (const auto& [decay, re_ignition] : {std::pair{0.1, 0.2}, {0.2, 0.5}, {0.05, 1.0}}) {
    const Recording recording = decay_and_re_ignition(decay, re_ignition, 2);
    const auto out = learn_ramp(SizeChange::kDecay, curves_of(recording, SizeChange::kDecay));
    const auto in = learn_ramp(SizeChange::kReIgnition, curves_of(recording, SizeChange::kReIgnition));
    ASSERT_TRUE(out && in);
    ASSERT_GE(out->events, 8U);
    EXPECT_NEAR(out->seconds, decay, 1.5 * kRow);
    EXPECT_NEAR(in->seconds, re_ignition, 1.5 * kRow);
    for (const RampFit& fit : {*out, *in}) {
      EXPECT_LT(fit.seconds_ci95[0], fit.seconds);
      EXPECT_GT(fit.seconds_ci95[1], fit.seconds);
      EXPECT_LT(fit.seconds_ci95[1] - fit.seconds_ci95[0], 4 * kRow);
      EXPECT_LT(fit.error, 0.1);
    }
  }
}

TEST(FlameSizes, WhatGoesFromOneRowToTheNextTakesARow) {
  const Recording recording = made::blow_out_recording({.shortest = 0.2, .seed = 3}).recording;
  for (SizeChange change : {SizeChange::kDecay, SizeChange::kReIgnition}) {
    EXPECT_DOUBLE_EQ(learn_ramp(change, curves_of(recording, change))->seconds, 1.0 / 60);
  }
}

TEST(FlameSizes, ARampIsWhatABankShows) {
  for (double seconds : {0.01, 0.1, 0.137, 0.4}) {
    Model model = flame_model();
    model.rate_hz = 100;
    model.extinction = Extinction{.decay = seconds, .re_ignition = seconds};
    Bank bank = *Bank::create(model, {});
    const InstanceId id = bank.spawn();
    bank.extinction()->extinguish(id);
    std::vector<double> decay;
    for (bank.step(); bank.extinction()->state_of(id)->size > 1e-6; bank.step())
      decay.push_back(bank.extinction()->state_of(id)->size);
    for (std::size_t row = 0; row < decay.size(); ++row) {
      EXPECT_NEAR(ramp_size(SizeChange::kDecay, seconds, 100, row), decay[decay.size() - 1 - row], 1e-5) << seconds;
    }
    EXPECT_DOUBLE_EQ(ramp_size(SizeChange::kDecay, seconds, 100, decay.size()), 1);
    bank.extinction()->relight(id);
    for (std::size_t row = 0; row < 50; ++row) {
      bank.step();
      EXPECT_NEAR(ramp_size(SizeChange::kReIgnition, seconds, 100, row), bank.extinction()->state_of(id)->size, 1e-5)
          << seconds;
    }
  }
}

TEST(FlameSizes, WithoutADeathOrALightingThereIsNothingToLearn) {
  const Recording alight = made::blow_out_recording({.every = 0}).recording;
  EXPECT_FALSE(learn_ramp(SizeChange::kDecay, curves_of(alight, SizeChange::kDecay)));
  Recording once =
      made::blow_out_recording({.rows = 700, .every = 8, .weakest = 3.5, .shortest = 0.4, .seed = 4}).recording;
  const std::size_t gone = find_blow_outs(once, "wind")->front().gone;
  for (Channel& channel : once.channels) {
    if (channel.role == Role::kInput) continue;
    std::fill(channel.samples.begin() + static_cast<std::ptrdiff_t>(gone), channel.samples.end(),
              std::numeric_limits<double>::quiet_NaN());
  }
  EXPECT_EQ(learn_ramp(SizeChange::kDecay, curves_of(once, SizeChange::kDecay))->events, 1U);
  EXPECT_FALSE(learn_ramp(SizeChange::kReIgnition, curves_of(once, SizeChange::kReIgnition)));
}

TEST(FlameSizes, AStretchThatNobodyBlewIsNoDeath) {
  const Recording recording = made::blow_out_recording({.shortest = 0.2}).recording;
  auto blow_outs = *find_blow_outs(recording, "wind");
  const auto sizes = *flame_sizes(recording, blow_outs);
  const std::size_t all = size_curves(recording, sizes, blow_outs, SizeChange::kDecay).size();
  blow_outs[1].blown = false;
  EXPECT_EQ(size_curves(recording, sizes, blow_outs, SizeChange::kDecay).size(), all - 1);
  EXPECT_THAT(flame_sizes({.source = "numbers"}, {}).error().message, HasSubstr("numbers"));
}

}  // namespace
}  // namespace wisp::flame_sizes_test
