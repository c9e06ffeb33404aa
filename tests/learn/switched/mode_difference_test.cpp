#include "learn/switched/mode_difference.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "learn/switched/made_switched.hpp"
#include "learn/switched/switched_fit.hpp"

namespace wisp::mode_difference_test {
namespace {

using testing::HasSubstr;

// Two modes that take turns by chance, with shocks of 0.1 and 0.1 · `louder`, of one output.
SwitchedFit fit_of_turns(const MadeMode& quiet, const MadeMode& loud, double louder) {
  MadeSwitched made = record_switched({quiet, loud}, 3000, 1, 0.1, [](int mode, double, double, double chance) {
    return chance < 0.97 ? mode : 1 - mode;
  });
  auto& y = made.recording.channels[1].samples;
  const auto& u = made.recording.channels[0].samples;
  const std::vector<double> first = y;
  for (std::size_t t = 1; t < y.size(); ++t) {
    const MadeMode& mode = made.modes[t] == 1 ? loud : quiet;
    const double shock = first[t] - (mode.a * first[t - 1] + mode.b * u[t - 1] + mode.c);
    y[t] = mode.a * y[t - 1] + mode.b * u[t - 1] + mode.c + (made.modes[t] == 1 ? louder : 1) * shock;
  }
  const auto fit =
      fit_switched({&made.recording, 1}, {{"u"}, {"y"}},
                   {.orders = first_order(), .switching = Switching::kMarkov, .modes = 2, .max_modes = 2, .starts = 4});
  EXPECT_TRUE(fit) << fit.error().message;
  return *fit;
}

// The seed is fixed; of seeds 1 to 40 two gave a false alarm (one of three coefficients at 3.2 standard errors), since
// standard errors are a little small where rows are shared out.
TEST(ModeDifference, ModesThatDifferInNoiseAloneAreSaidToDoSo) {
  const SwitchedFit fit = fit_of_turns({0.7, 0.5, 0.1}, {0.7, 0.5, 0.1}, 5);
  ASSERT_EQ(fit.summary.differences.size(), 1U);
  const ModeDifference& pair = fit.summary.differences[0];
  EXPECT_TRUE(pair.same_coefficients()) << pair.most_std_errors;
  EXPECT_EQ(pair.compared, 3U);
  EXPECT_NEAR(std::max(pair.noise_ratio, 1 / pair.noise_ratio), 5, 0.75);
  EXPECT_TRUE(fit.summary.usable.verdict) << fit.summary.usable.reason;
  EXPECT_THAT(fit.summary.usable.reason, HasSubstr("by the size of its noise alone"));
}

TEST(ModeDifference, CoefficientsThatDifferAreCountedAndTheConstantIsOneOfThem) {
  const SwitchedFit all = fit_of_turns({0.7, 0.5, 0}, {-0.2, 1, 0.6}, 1);
  ASSERT_EQ(all.summary.differences.size(), 1U);
  EXPECT_EQ(all.summary.differences[0].coefficients, 3U);
  EXPECT_GT(all.summary.differences[0].most_std_errors, 30);
  EXPECT_THAT(all.summary.usable.reason, HasSubstr("predicts rows held out better"));
  const SwitchedFit constant = fit_of_turns({0.7, 0.5, -0.5}, {0.7, 0.5, 0.5}, 1);
  EXPECT_EQ(constant.summary.differences[0].coefficients, 1U);
}

TEST(ModeDifference, EveryPairIsComparedByItsOwnErrors) {
  SwitchedArxModel model;
  model.orders = first_order();
  for (double a : {0.5, 0.52, 0.9}) {
    model.modes.push_back({{{a, 1}}, {{0.01, 0.1}}, {0}, {a}});
  }
  const auto pairs = mode_differences(model, std::vector<std::vector<double>>(3, {0.1}));
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_TRUE(pairs[0].same_coefficients());  // 0.02 is 1.4 standard errors of a difference
  EXPECT_NEAR(pairs[0].most_std_errors, std::sqrt(2), 1e-9);
  EXPECT_EQ(pairs[1].coefficients, 1U);
  EXPECT_EQ(pairs[2].coefficients, 1U);
  EXPECT_NEAR(pairs[1].noise_ratio, 0.9 / 0.5, 1e-9);
}

}  // namespace
}  // namespace wisp::mode_difference_test
