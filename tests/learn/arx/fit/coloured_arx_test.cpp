// ARARX and ARMAX: known systems are recovered, the right class wins on held-out data, and what is played is the same
// model.

#include "wisp/learn/coloured_arx.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "wisp/learn/prediction.hpp"

namespace wisp {
namespace {

const ChannelChoice kChannels{{"u"}, {"y"}};
const ArxOrders kOrders{OrderMatrix(1, 1, 2), OrderMatrix(1, 1, 2), OrderMatrix(1, 1, 1)};
const std::vector<double> kTheta{-1.5, 0.7, 1.0, 0.5};
constexpr NoiseModel kWhite{};
constexpr NoiseModel kAr{NoiseColour::kAutoregressive, 1};
constexpr NoiseModel kMa{NoiseColour::kMovingAverage, 1};

// y − 1.5 y₁ + 0.7 y₂ = u₁ + 0.5 u₂ + v, with v = e / (1 + f q⁻¹) or v = e + f e₁.
Recording made(NoiseModel noise, double f, std::size_t rows, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Recording out{.source = "made", .rate_hz = 1};
  std::vector<double> u(rows), y(rows);
  double v = 0, before = 0;
  for (std::size_t t = 0; t < rows; ++t) {
    u[t] = normal(generator);
    const double e = 0.5 * normal(generator);
    v = noise.colour == NoiseColour::kAutoregressive ? e - f * v : e + f * before;
    before = e;
    y[t] = v;
    if (t >= 2) y[t] += 1.5 * y[t - 1] - 0.7 * y[t - 2] + u[t - 1] + 0.5 * u[t - 2];
  }
  out.channels = {{"u", "", Role::kInput, std::move(u)}, {"y", "", Role::kOutput, std::move(y)}};
  return out;
}

ColouredArxFit fitted(const Recording& recording, NoiseModel noise) {
  auto fit = fit_coloured_arx({&recording, 1}, kChannels, {.orders = kOrders, .noise = noise});
  EXPECT_TRUE(fit) << fit.error().message;
  return *std::move(fit);
}

// Of 500 coefficients 1.35 lie beyond three standard errors by chance; more than 7 do in one of 2000 such tests.
void expect_recovered(NoiseModel noise, double f) {
  int beyond = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const ColouredArxFit fit = fitted(made(noise, f, 1000, seed), noise);
    EXPECT_TRUE(fit.converged) << seed;
    const ColouredArx& model = fit.model;
    for (std::size_t k = 0; k < kTheta.size(); ++k) {
      beyond += std::abs(model.model.theta[0][k] - kTheta[k]) > 3 * model.model.std_error[0][k] ? 1 : 0;
    }
    beyond += std::abs(model.filter[0][0] - f) > 3 * model.filter_std_error[0][0] ? 1 : 0;
  }
  EXPECT_LE(beyond, 7);
}

TEST(ColouredArx, RecoversAnArmaxSystemWithinThreeStandardErrors) { expect_recovered(kMa, 0.8); }

TEST(ColouredArx, RecoversAnArarxSystemWithinThreeStandardErrors) { expect_recovered(kAr, -0.7); }

TEST(ColouredArx, LeastSquaresAloneIsBiasedThere) {
  const ColouredArxFit fit = fitted(made(kMa, 0.8, 4000, 1), kWhite);
  EXPECT_GT(std::abs(fit.model.model.theta[0][0] - kTheta[0]), 5 * fit.model.model.std_error[0][0]);
}

double held_out(NoiseModel truth, double f, NoiseModel taken) {
  const ColouredArxFit fit = fitted(made(truth, f, 3000, 1), taken);
  const Recording unseen = made(truth, f, 3000, 2);
  return *log_likelihood(fit.model, {&unseen, 1}, kChannels);
}

TEST(ColouredArx, TheWrongClassLosesOnHeldOutLikelihood) {
  EXPECT_GT(held_out(kMa, 0.8, kMa), held_out(kMa, 0.8, kAr) + 0.01);
  EXPECT_GT(held_out(kMa, 0.8, kMa), held_out(kMa, 0.8, kWhite) + 0.05);
  EXPECT_GT(held_out(kAr, -0.9, kAr), held_out(kAr, -0.9, kMa) + 0.01);
  EXPECT_GT(held_out(kAr, -0.9, kAr), held_out(kAr, -0.9, kWhite) + 0.05);
}

TEST(ColouredArx, IsPlayedAsAnArxModelWithTheSameErrors) {
  for (const auto& [noise, f] : {std::pair{kAr, -0.7}, {kMa, 0.8}}) {
    const Recording recording = made(noise, f, 2000, 3);
    const ColouredArxFit fit = fitted(recording, noise);
    const ArxModel white = as_white(fit.model);
    ASSERT_TRUE(check(white));
    EXPECT_LT(spectral_radius(white), 1);
    const auto predicted = predict(white, recording, kChannels);
    ASSERT_TRUE(predicted);
    double sum = 0;
    int rows = 0;
    for (std::size_t t = 100; t < 2000; ++t, ++rows) {
      sum += std::pow(recording.channels[1].samples[t] - (*predicted)[0][t], 2);
    }
    EXPECT_NEAR(std::sqrt(sum / rows), fit.model.model.noise.sd[0], 0.02 * fit.model.model.noise.sd[0]);
  }
}

TEST(ColouredArx, GapsAreNotCrossed) {
  Recording recording = made(kMa, 0.8, 3000, 5);
  recording.channels[1].samples[1500] = std::nan("");
  recording.channels[0].samples[1700] = std::nan("");
  const ColouredArxFit fit = fitted(recording, kMa);
  EXPECT_EQ(fit.samples_used, 3000u - 2 - 3 - 3);
  EXPECT_NEAR(fit.model.filter[0][0], 0.8, 0.06);
}

TEST(ColouredArx, NoiseModelsAreReadFromText) {
  EXPECT_EQ(*parse_noise_model("white"), kWhite);
  EXPECT_EQ(*parse_noise_model("ma:1"), kMa);
  EXPECT_EQ(*parse_noise_model("ar:12"), (NoiseModel{NoiseColour::kAutoregressive, 12}));
  for (const char* bad : {"", "ar", "ar:", "ma:0", "ma:65", "ar:2x", "pink"})
    EXPECT_FALSE(parse_noise_model(bad)) << bad;
}

TEST(ColouredArx, BadRequestsAreNamed) {
  const Recording recording = made(kMa, 0.8, 6, 1);
  EXPECT_FALSE(fit_coloured_arx({&recording, 1}, kChannels, {.orders = kOrders, .noise = kMa}));
  EXPECT_FALSE(fit_coloured_arx({}, kChannels, {.orders = kOrders}));
  EXPECT_FALSE(fit_coloured_arx({&recording, 1}, {{"w"}, {"y"}}, {.orders = kOrders}));
  EXPECT_FALSE(fit_coloured_arx({&recording, 1}, kChannels, {.orders = kOrders, .noise = {NoiseColour::kWhite, 2}}));
}

}  // namespace
}  // namespace wisp
