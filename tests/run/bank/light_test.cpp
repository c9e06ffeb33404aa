// The light of a flame, what has happened to it, and the longest advance.

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>

#include "paths.hpp"
#include "run/flame_model.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/body_facet.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::light_test {
namespace {

Model shipped_flame() { return *read_model(WISP_SOURCE_DIR "/apps/web/public/models/flame.wisp"); }

Bank bank_of(const Model& model, BankOptions options = {.capacity = 9, .seed = 3}) {
  auto bank = Bank::create(model, options);
  EXPECT_TRUE(bank) << bank.error().message;
  for (int k = 0; k < options.capacity; ++k) bank->spawn();
  return std::move(bank).value();
}

TEST(FlameLight, IsOneAtRestInTheMiddleOfTheFlame) {
  const Bank bank = bank_of(shipped_flame());
  const FlameLight light = *bank.light(bank.at(8));
  EXPECT_NEAR(light.intensity, 1, 1e-5);
  EXPECT_NEAR(light.kelvin, 1900, 0.1);
  EXPECT_NEAR(light.position[0], 0, 0.1);
  EXPECT_GT(light.position[1], 0.3);
  EXPECT_LT(light.position[1], 0.6);
  EXPECT_EQ(light.position[2], 0);
}

TEST(FlameLight, FollowsTheOutlinesAreaAndCentroid) {
  Bank bank = bank_of(shipped_flame());
  bank.set_common_inputs(std::array{0.7f});
  std::vector<float> line(static_cast<std::size_t>(2 * bank.polyline_points()));
  const auto area_of_polyline = [&] {
    bank.polyline(bank.at(0), line);
    double area = 0, x = 0;
    for (std::size_t k = 0; k < line.size(); k += 2) {
      const std::size_t n = (k + 2) % line.size();
      const double cross = double{line[k]} * line[n + 1] - double{line[n]} * line[k + 1];
      area += cross / 2, x += (line[k] + line[n]) * cross / 6;
    }
    return std::array{std::abs(area), x / area};
  };
  const double rest = area_of_polyline()[0];
  double least = 9, most = 0;
  for (int frame = 0; frame < 200; ++frame) {
    bank.step();
    const FlameLight light = *bank.light(bank.at(0));
    const auto [area, x] = area_of_polyline();
    EXPECT_NEAR(light.intensity, area / rest, 0.1) << frame;
    EXPECT_NEAR(light.position[0], x, 0.06) << frame;
    least = std::min(least, double{light.intensity}), most = std::max(most, double{light.intensity});
  }
  EXPECT_GT(most - least, 0.03);
}

TEST(FlameLight, LeansIntoDepthInTheRoundAndFadesRedWhenItGoesOut) {
  Bank bank = bank_of(*in_the_round(shipped_flame()));
  bank.set_common_inputs(std::array{0.0f, 0.6f});
  for (int frame = 0; frame < 60; ++frame) bank.step();
  bank.body()->look(0, -1);  // no matter from where it is seen
  const FlameLight light = *bank.light(bank.at(1));
  EXPECT_GT(light.position[2], 0.05);
  EXPECT_LT(std::abs(light.position[0]), light.position[2]);
  bank.extinction()->extinguish(bank.at(1));
  float before = light.kelvin;
  for (int frame = 0; frame < 3; ++frame) {
    bank.step();
    EXPECT_LE(bank.light(bank.at(1))->kelvin, before);
    before = bank.light(bank.at(1))->kelvin;
  }
  for (int frame = 0; frame < 60; ++frame) bank.step();
  EXPECT_EQ(bank.light(bank.at(1))->intensity, 0);
  EXPECT_EQ(bank.light(bank.at(1))->kelvin, 0);
  EXPECT_FALSE(bank.light({}));
}

TEST(FlameEvents, AreOfTheLastCallOnce) {
  Bank bank = bank_of(shipped_flame());
  const auto state = [&] { return *bank.extinction()->state_of(bank.at(2)); };
  bank.set_inputs(bank.at(2), std::array{9.0f});
  int outs = 0;
  for (int frame = 0; frame < 120; ++frame) {
    const bool lit = state().lit;
    bank.advance(0.02);
    EXPECT_EQ(state().went_out, lit && !state().lit) << frame;
    outs += state().went_out ? 1 : 0;
  }
  EXPECT_EQ(outs, 1);
  bank.set_inputs(bank.at(2), std::array{0.0f});
  bank.extinction()->relight(bank.at(2));
  EXPECT_TRUE(state().relit);
  EXPECT_FALSE(bank.extinction()->state_of(bank.at(1))->relit);
  bank.advance(0.02);
  EXPECT_FALSE(state().relit);
  bank.step(60);
  bank.extinction()->extinguish(bank.at(2));
  EXPECT_TRUE(state().went_out);
  bank.step();
  EXPECT_FALSE(state().went_out);
}

TEST(LongestAdvance, CutsAPause) {
  Bank bank = bank_of(shipped_flame(), {.capacity = 1, .longest_advance = std::chrono::milliseconds(100)});
  EXPECT_EQ(bank.advance(5.0), 5);  // of 16.67 ms
  EXPECT_LE(bank.advance(std::chrono::hours(1)), 6);
  for (const auto wrong :
       {std::chrono::nanoseconds(0), std::chrono::nanoseconds(-1), std::chrono::nanoseconds(11'000'000'000)}) {
    const auto bank_or_not = Bank::create(shipped_flame(), {.longest_advance = wrong});
    ASSERT_FALSE(bank_or_not);
    EXPECT_NE(bank_or_not.error().message.find("longest advance"), std::string::npos);
  }
}

}  // namespace
}  // namespace wisp::light_test
