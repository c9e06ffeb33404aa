// `--input-curve`: learned, described, validated and played.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "cli/program.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::input_curve_test {
namespace {

using testing::HasSubstr;

class InputCurve : public InFolder {
 protected:
  // y(t) = 0.8 y(t−1) + u(t−1)²/2 + e, u from 0 to 2.
  void SetUp() override {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    Recording recording{
        .source = "", .rate_hz = 10, .channels = {{"push", "N", Role::kInput, {}}, {"place", "m", Role::kOutput, {}}}};
    auto &u = recording.channels[0].samples, &y = recording.channels[1].samples;
    for (int t = 0; t < 2000; ++t) {
      y.push_back((t > 0 ? 0.8 * y.back() + u.back() * u.back() / 2 : 0) + 0.05 * normal(random));
      u.push_back(static_cast<double>(random() % 2001) / 1000);
    }
    ASSERT_TRUE(write_csv(folder_ / "system.csv", recording));
  }

  Said learn(const std::string& model, const std::string& more) {
    return wisp("learn arx " + at("system.csv") + " -o " + at(model) +
                " --inputs push --outputs place --na 1 --nb 1 --nk 1 --json " + more);
  }

  double simulated(const std::string& model) {
    const Said said = wisp("validate " + at(model) + " " + at("system.csv") + " --steps inf --json");
    EXPECT_EQ(said.status, 0) << said.err;
    return said.json()["channels"][0]["fit_percent"]["inf"];
  }
};

TEST_F(InputCurve, IsLearnedDescribedValidatedAndPlayed) {
  const Said said = learn("bent.wisp", "--input-curve auto");
  ASSERT_EQ(said.status, 0) << said.err;
  const auto curve = said.json()["input_curve"];
  EXPECT_GE(curve["knots"], 3);
  EXPECT_THAT(curve["reason"].get<std::string>(), HasSubstr("inputs are bent by curves of"));
  const auto &at_knots = curve["curves"][0]["at"], &value = curve["curves"][0]["value"];
  for (std::size_t k = 1; k + 1 < at_knots.size(); ++k) {
    const double u = at_knots[k];
    EXPECT_NEAR(value[k].get<double>(), u * u / 2, 0.1) << u;  // a chord of the square lies that much above it
  }
  const Said info = wisp("info --json " + at("bent.wisp"));
  ASSERT_EQ(info.status, 0) << info.err;
  EXPECT_EQ(info.json()["inputs"][0]["shape"], "linear bent by a curve");
  EXPECT_EQ(info.json()["inputs"][0]["curve"]["at"], at_knots);
  ASSERT_EQ(learn("plain.wisp", "").status, 0);
  EXPECT_GT(simulated("bent.wisp"), simulated("plain.wisp") + 10);
  const Said run = wisp("run " + at("bent.wisp") + " --frames 200 --noise off --wind 1 -o " + at("out.csv"));
  ASSERT_EQ(run.status, 0) << run.err;
  const auto played = read_csv(folder_ / "out.csv", {});
  ASSERT_TRUE(played) << played.error().message;
  // At rest under 1: 0.5 / (1 − 0.8), but for the chord.
  EXPECT_NEAR(played->channels.back().samples.back(), 2.5, 0.4);
}

TEST_F(InputCurve, IsRefusedWhereItMeansNothing) {
  EXPECT_THAT(learn("m.wisp", "--input-curve 2").err, HasSubstr("a curve of 2 knots was requested"));
  EXPECT_THAT(learn("m.wisp", "--input-curve 4 --offset none").err, HasSubstr("--offset mean or estimate"));
  EXPECT_THAT(learn("m.wisp", "--input-curve 4 --partial " + at("p.part")).err, HasSubstr("without --partial"));
}

}  // namespace
}  // namespace wisp::input_curve_test
