// One scale for all recordings, or each its own: what one microphone heard, and what two did.

#include "learn/outline/outline_inputs.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "learn/outline/made_outline.hpp"
#include "learn/outline/outline_fit.hpp"
#include "learn/outline/outline_judgement.hpp"
#include "record/loudness.hpp"

namespace wisp::wind_gain_test {
namespace {

// A recording in which the tracker called 1 what is `gusts` times the strength of the other's, heard by a microphone of
// `gain`.
Recording heard(std::uint64_t seed, double gusts, double gain) {
  Recording out = made::outline_recording({.rows = 900, .shock = 0.003, .wind = true, .seed = seed});
  for (double& value : out.channels[*find_channel(out, "wind")].samples) value /= gusts;
  set_one_rms(out, "wind", 0.04 * gusts * gusts * gain);
  return out;
}

double wind_at(const Recording& recording, std::size_t row) {
  return recording.channels[*find_channel(recording, "wind")].samples[row];
}

const OutlineRecipe kQuick{.paper = 4};

TEST(WindGain, CommonGainIsThatOfTheLoudest) {
  const std::vector recordings{heard(1, 1, 1), heard(2, 2, 1)};
  const auto together = *at_common_gain(recordings);
  EXPECT_NEAR(wind_at(together[0], 40), wind_at(recordings[0], 40) / 2, 1e-12);
  EXPECT_EQ(wind_at(together[1], 40), wind_at(recordings[1], 40));
  EXPECT_EQ(*one_rms(together[0], "wind"), *one_rms(together[1], "wind"));
}

TEST(WindGain, ThereIsNothingToChooseWhereOneIsSilentAboutIt) {
  std::vector recordings{heard(1, 1, 1), heard(2, 2, 1)};
  recordings[1].attributes.clear();
  EXPECT_TRUE(common_gain_factors(recordings)->empty());
  EXPECT_EQ(wind_at(at_common_gain(recordings)->front(), 40), wind_at(recordings[0], 40));
  const std::vector alike{heard(1, 1, 1), heard(2, 1.01, 1)};
  EXPECT_TRUE(common_gain_factors(alike)->empty());
  EXPECT_TRUE(common_gain_factors(std::vector{heard(1, 1, 1)})->empty());
  EXPECT_NEAR(common_gain_factors(std::vector{heard(1, 1, 1), heard(2, 2.5, 1)})->front(), 0.4, 1e-12);
}

TEST(WindGain, ABadLoudnessIsAnError) {
  std::vector recordings{heard(1, 1, 1), heard(2, 2, 1)};
  recordings[1].attributes = {{"wind.one_rms", "-2"}};
  EXPECT_FALSE(common_gain_factors(recordings));
  EXPECT_FALSE(at_common_gain(recordings));
}

// A model knows how loud it was: what the same microphone hears later is as strong as it was then.
TEST(WindGain, ARecordingIsValidatedAsLoudAsTheTraining) {
  const auto fit = *fit_outline(std::vector{heard(1, 1, 1)}, kQuick);
  const Recording later = heard(3, 2.5, 1);
  EXPECT_NEAR(*factor_to_trained_gain(fit.model, later), 2.5, 1e-12);
  EXPECT_NEAR(wind_at(*at_trained_gain(fit.model, later), 40), 2.5 * wind_at(later, 40), 1e-9);
  const auto found = *judge_outline(fit.model, later, {.fidelity = false});
  const auto same = *judge_outline(fit.model, heard(3, 1, 1), {.fidelity = false});
  EXPECT_NEAR(found.figures.tip_fit_percent.back(), same.figures.tip_fit_percent.back(), 1e-6);
  Recording silent = later;
  silent.attributes.clear();
  EXPECT_EQ(*factor_to_trained_gain(fit.model, silent), 1);
  EXPECT_EQ(wind_at(*at_trained_gain(fit.model, silent), 40), wind_at(later, 40));
}

const std::string kWind[] = {"wind"};

TEST(WindGain, InModelUnitsTheTrainingsOneIsOne) {
  const auto fit = *fit_outline(std::vector{heard(1, 1, 1)}, kQuick);
  const double scale = fit.model.training.inputs[0].scale;
  EXPECT_GT(std::abs(scale - 1), 0.05);
  const Recording later = heard(3, 2.5, 1);
  const Recording driving = *in_model_units(fit.model, later, kWind);
  EXPECT_NEAR(wind_at(driving, 40), 2.5 * wind_at(later, 40) / scale, 1e-9);
  EXPECT_EQ(wind_at(*in_model_units(fit.model, driving, kWind), 40), wind_at(driving, 40));  // it is in them
  const Recording own = *in_model_units(fit.model, later, kWind, true);
  const Recording louder = *in_model_units(fit.model, heard(3, 1, 1), kWind, true);
  EXPECT_NEAR(wind_at(own, 40), wind_at(louder, 40), 1e-9);
}

TEST(WindGain, AColumnOfAnotherNameIsHeardAsLoud) {
  const auto fit = *fit_outline(std::vector{heard(1, 1, 1)}, kQuick);
  const Recording later = heard(3, 2.5, 1);
  Recording renamed = later;
  Channel& channel = renamed.channels[*find_channel(renamed, "wind")];
  channel.name = "breath";
  renamed.attributes.clear();
  set_one_rms(renamed, "breath", **one_rms(later, "wind"));
  const std::string name[] = {"breath"};
  ASSERT_TRUE(in_model_units(fit.model, renamed, name));
  const Recording driving = *in_model_units(fit.model, renamed, name);
  EXPECT_NEAR(driving.channels[*find_channel(driving, "breath")].samples[40],
              wind_at(*in_model_units(fit.model, later, kWind), 40), 1e-9);
}

TEST(WindGain, InModelUnitsARecordingStillSaysHowLoudItIs) {
  const auto fit = *fit_outline(std::vector{heard(1, 1, 1)}, kQuick);
  const Recording later = heard(3, 2.5, 1);
  const auto found = *judge_outline(fit.model, *in_model_units(fit.model, later, kWind), {.fidelity = false});
  const auto same = *judge_outline(fit.model, later, {.fidelity = false});
  EXPECT_NEAR(found.figures.tip_fit_percent.back(), same.figures.tip_fit_percent.back(), 1e-6);
  Recording bad = later;
  bad.attributes = {{"wind.one_rms", "-2"}};
  EXPECT_FALSE(in_model_units(fit.model, bad, kWind));
}

TEST(WindGain, ACalmRecordingHasNoGainOfItsOwn) {
  const auto fit = *fit_outline(std::vector{heard(1, 1, 1)}, kQuick);
  Recording calm = heard(3, 1, 1);
  for (double& value : calm.channels[*find_channel(calm, "wind")].samples) value = 0;
  EXPECT_EQ(wind_at(*in_model_units(fit.model, calm, kWind, true), 40), 0);
  const std::string other[] = {"breath"};
  EXPECT_NE(in_model_units(fit.model, calm, other).error().message.find("has no channel breath"), std::string::npos);
}

TEST(WindGain, AModelOfScalesOfTheirOwnKnowsNoLoudness) {
  const auto fit = *fit_outline(std::vector{heard(1, 1, 1), heard(2, 2, 1)}, kQuick);
  const Recording later = heard(3, 2.5, 1);
  EXPECT_EQ(wind_at(*at_trained_gain(fit.model, later), 40), wind_at(later, 40));
}

}  // namespace
}  // namespace wisp::wind_gain_test
