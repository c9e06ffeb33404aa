#include "learn/chain/chain_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "learn/chain/chain_fidelity.hpp"
#include "learn/chain/made_falls.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"

namespace wisp::chain::chain_fit_test {
namespace {

using testing::HasSubstr;

const EventSpec kHorizontal{EventKind::kMinimum, "horizontal_speed"};

// Cut where a leaf stalls.
Result<ChainFit> learned(const Recording& recording, ChainRecipe recipe = {}, EventSpec event = {}) {
  recipe.event = std::move(event);
  return fit_chain(std::span(&recording, 1), recipe);
}

TEST(FitChain, WhatIsLearnedFallsAsWhatWasRecorded) {
  auto fit = learned(made_falls({.falls = 60}), {.modes = 4, .holdout = 0.5});
  ASSERT_TRUE(fit) << fit.error().message;
  const auto fidelity = chain_fidelity(fit->model, fit->held_out, {});
  ASSERT_TRUE(fidelity) << fidelity.error().message;
  EXPECT_NEAR(fidelity->synthesized.descent_speed, fidelity->real.descent_speed, 0.05 * fidelity->real.descent_speed);
  EXPECT_NEAR(fidelity->synthesized.event_seconds, fidelity->real.event_seconds, 0.1 * fidelity->real.event_seconds);
  EXPECT_LT(fidelity->energy_distance.value, 0.05);
  EXPECT_LT(fidelity->energy_distance.value, fidelity->energy_distance.ceiling);
}

TEST(FitChain, AnotherFallIsToldFromWhatWasLearned) {
  auto fit = learned(made_falls({.falls = 40}), {.modes = 4});
  ASSERT_TRUE(fit);
  const Recording other = made_falls({.falls = 20, .swing_seconds = 1.0, .seed = 4});
  const auto fidelity = chain_fidelity(fit->model, std::span(&other, 1), {});
  ASSERT_TRUE(fidelity);
  EXPECT_GT(fidelity->energy_distance.value, 0.1);
}

TEST(FitChain, PositionsAloneAreEnough) {
  auto fit = learned(made_falls({.falls = 40, .orientation = false}), {.modes = 3, .holdout = 0.5}, kHorizontal);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_TRUE(std::holds_alternative<PositionView>(fit->model.view));
  EXPECT_EQ(fit->model.outputs.size(), 3U);
  const auto fidelity = chain_fidelity(fit->model, fit->held_out, {.segmentation = {kHorizontal}});
  ASSERT_TRUE(fidelity) << fidelity.error().message;
  EXPECT_NEAR(fidelity->synthesized.descent_speed, fidelity->real.descent_speed, 0.05 * fidelity->real.descent_speed);
}

TEST(FitChain, TheSameDataAndSeedMakeTheSameFile) {
  const Recording recording = made_falls();
  const auto a = learned(recording), b = learned(recording);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(*model_bytes(a->model), *model_bytes(b->model));
}

TEST(FitChain, StoredSegmentsPlayWhatWasRecorded) {
  const Recording recording = made_falls({.falls = 4});
  const auto fit = learned(recording, {.modes = 1, .blend = 0, .holdout = 0});
  ASSERT_TRUE(fit);
  const auto& segments = std::get<ChainModel>(fit->model.dynamics).segments;
  const auto motion = motion_of(std::span(&recording, 1));
  const auto cut = segment(*motion, std::span(&recording, 1), {});
  ASSERT_EQ(segments.size(), cut->segments.size());
  const auto first = segment_rows(segments);
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const Segment& one = cut->segments[k];
    const MotionPiece& piece = motion->pieces[one.piece];
    const auto row = static_cast<std::size_t>(std::lround(one.begin));
    const Triple from = piece.position[row], to = piece.position[row + static_cast<std::size_t>(one.steps)];
    const std::int16_t* end = &segments.rows[(first[k + 1] - 1) * 7];
    const double scale = segments.row_scale[0];
    // Half a unit of sixteen bits on each axis.
    EXPECT_NEAR(scale * std::hypot(end[0], end[1]), std::hypot(to[0] - from[0], to[1] - from[1]), scale);
    EXPECT_NEAR(scale * end[2], to[2] - from[2], scale);
  }
}

TEST(FitChain, JoinsJumpNoMoreThanRowsOfTheRecordingDo) {
  const auto fit = learned(made_falls({.falls = 60}), {.modes = 4, .holdout = 0.5});
  ASSERT_TRUE(fit);
  const auto fidelity = chain_fidelity(fit->model, fit->held_out, {});
  ASSERT_TRUE(fidelity);
  EXPECT_LE(fidelity->join_defect.position, 0.01);
  EXPECT_LE(fidelity->join_defect.rotation, 0.01);
}

// How far 400 falls are, on average, from a height of 5.8 m below where they began after six seconds: made falls keep
// their heading, and can only be hastened.
double mean_miss(const Model& model, bool steered) {
  constexpr int kFalls = 400;
  auto bank = Bank::create(model, {.capacity = kFalls});
  std::vector<float> poses(7 * kFalls);
  for (int k = 0; k < kFalls; ++k) {
    const InstanceId id = bank->spawn();
    if (steered) {
      EXPECT_TRUE(bank->chain()->steer(id, {.position = {0, 0, -5.8f}, .in = std::chrono::seconds(6)}));
    }
  }
  for (int step = 0; step < 360; ++step) bank->step();
  bank->outputs(poses);
  double sum = 0;
  for (std::size_t k = 0; k < kFalls; ++k) sum += std::abs(poses[7 * k + 2] + 5.8);
  return sum / kFalls;
}

TEST(FitChain, WhatIsSteeredComesNearerToItsTarget) {
  const auto fit = learned(made_falls({.falls = 60}), {.modes = 4, .holdout = 0});
  ASSERT_TRUE(fit);
  // Made falls leave little to choose; leaves come four times nearer.
  EXPECT_LT(mean_miss(fit->model, true), 0.9 * mean_miss(fit->model, false));
}

TEST(FitChain, ModesAreRealisedInOtherWaysToo) {
  const Recording recording = made_falls({.falls = 40});
  for (Realisation realisation : {Realisation::kLinear, Realisation::kOde, Realisation::kChain, Realisation::kSpline}) {
    const auto fit = learned(recording, {.modes = 3, .realisation = realisation, .best_of = 0});
    ASSERT_TRUE(fit) << fit.error().message;
    const auto fidelity = chain_fidelity(fit->model, fit->held_out, {});
    ASSERT_TRUE(fidelity) << fidelity.error().message;
    EXPECT_NEAR(fidelity->synthesized.descent_speed, fidelity->real.descent_speed, 0.3 * fidelity->real.descent_speed)
        << word_of(realisation);
    const auto& chain = std::get<ChainModel>(fit->model.dynamics);
    EXPECT_TRUE(chain.drift);
    EXPECT_GE(chain.modes, realisation == Realisation::kChain ? 4 : 3);
    EXPECT_EQ(fit->summary.modes, 3);
  }
}

TEST(FitChain, WhatModesCannotBeRealisedByIsAnError) {
  EXPECT_THAT(learned(made_falls({.falls = 10, .orientation = false}), {.modes = 2, .realisation = Realisation::kOde},
                      kHorizontal)
                  .error()
                  .message,
              HasSubstr("no orientation"));
  EXPECT_THAT(
      learned(made_falls({.falls = 1, .seconds = 3}), {.modes = 2, .realisation = Realisation::kOde, .holdout = 0})
          .error()
          .message,
      HasSubstr("rows, expected at least"));
}

TEST(FitChain, TheStoreStaysBelowMaxBytes) {
  const auto fit = learned(made_falls({.falls = 40}), {.modes = 3, .max_bytes = 20'000});
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->summary.stored, fit->summary.segments);
  // Tables and provenance come on top.
  EXPECT_LT(model_bytes(fit->model)->size(), 26'000U);
}

TEST(FitChain, ASingleSegmentIsPlayedForEver) {
  const Recording recording = made_falls({.falls = 1, .seconds = 1.1});
  const auto fit = learned(recording, {.holdout = 0});
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->summary.segments, 1U);
  EXPECT_FALSE(fit->model.training.usable.verdict);
  auto bank = Bank::create(fit->model);
  ASSERT_TRUE(bank);
  bank->spawn();
  std::array<float, 7> pose{};
  for (int step = 0; step < 1000; ++step) bank->step();
  bank->outputs(pose);
  EXPECT_LT(pose[2], -5);
}

TEST(FitChain, MoreModesThanSegmentsIsAnError) {
  const auto fit = learned(made_falls({.falls = 1, .seconds = 3}), {.modes = 50, .holdout = 0});
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, HasSubstr("segments in all, expected at least as many as modes, 50"));
}

TEST(FitChain, AVeryLongSegmentIsAnError) {
  const Recording recording = made_falls({.falls = 1, .seconds = 5000, .orientation = false, .swing_seconds = 1500});
  const auto fit = learned(recording, {.modes = 1}, kHorizontal);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, HasSubstr("rows between two events of horizontal_speed, expected at most 65535"));
}

TEST(FitChain, WithOrientationASegmentIsFollowedByOneOfItsBestJoiningOnes) {
  const auto fit = learned(made_falls({.falls = 30}));
  ASSERT_TRUE(fit) << fit.error().message;
  const auto& chain = std::get<ChainModel>(fit->model.dynamics);
  EXPECT_EQ(chain.modes, 1);
  EXPECT_EQ(chain.segments.breadth, 4);
}

TEST(FitChain, WithoutOrientationASegmentOfTheNextModeFollows) {
  const auto fit = learned(made_falls({.falls = 30, .orientation = false}), {}, kHorizontal);
  ASSERT_TRUE(fit) << fit.error().message;
  const auto& chain = std::get<ChainModel>(fit->model.dynamics);
  EXPECT_EQ(chain.modes, 6);
  EXPECT_EQ(chain.segments.breadth, 0);
}

TEST(FitChain, AnySuccessorOfFewSegmentsIsEquallyProbable) {
  const auto fit = learned(made_falls({.falls = 1, .seconds = 3, .orientation = false}),
                           {.heading_free = false, .modes = 1, .holdout = 0}, kHorizontal);
  ASSERT_TRUE(fit) << fit.error().message;
  const auto& chain = std::get<ChainModel>(fit->model.dynamics);
  ASSERT_GT(chain.segments.size(), 1U);
  ASSERT_LT(chain.segments.size(), 8U);
  for (const std::int16_t lead : chain.drift->lead) EXPECT_NEAR(lead * chain.drift->lead_scale, 0, 1e-9);
}

TEST(FitChain, OptionsOutOfRangeAreErrors) {
  const Recording recording = made_falls({.falls = 2});
  EXPECT_FALSE(learned(recording, {.modes = -1}));
  EXPECT_FALSE(learned(recording, {.history = 99}));
  EXPECT_FALSE(learned(recording, {.blend = 0.7}));
  EXPECT_FALSE(learned(recording, {.holdout = 1}));
}

TEST(FitChain, CopiedStretchesAreFound) {
  // One recording and nothing but natural successors: the walk repeats it.
  const Recording recording = made_falls({.falls = 1, .seconds = 20});
  const auto fit = learned(recording, {.best_of = 1, .holdout = 0});
  ASSERT_TRUE(fit);
  const double copied = longest_verbatim_seconds(fit->model, fit->origin, 200, 1);
  const auto mixed = learned(recording, {.best_of = 0, .holdout = 0});
  EXPECT_GT(copied, 2 * longest_verbatim_seconds(mixed->model, mixed->origin, 200, 1));
}

}  // namespace
}  // namespace wisp::chain::chain_fit_test
