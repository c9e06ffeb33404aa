// An outline's last point is its first one mirrored: such outputs are not computed, and nobody can tell.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::arx_mirrored_test {
namespace {

// Outputs and polylines of some seconds in a wind that swings from side to side.
std::vector<float> played(const Model& model) {
  auto bank = Bank::create(model, {.capacity = 3});
  EXPECT_TRUE(bank) << bank.error().message;
  bank->spawn();
  bank->spawn();
  std::vector<float> all, frame(2 * 16), points(2 * 2 * bank->polyline_points());
  for (int k = 0; k < 300; ++k) {
    const float wind = static_cast<float>(k % 80 - 40) / 40.0f;
    bank->set_common_inputs({&wind, 1});
    bank->advance(std::chrono::nanoseconds(21'000'000));
    bank->outputs(frame);
    bank->polylines(points);
    all.insert(all.end(), frame.begin(), frame.end());
    all.insert(all.end(), points.begin(), points.end());
  }
  return all;
}

TEST(MirroredOutputs, AreTheBitsThatTheyWouldBeByThemselves) {
  const Model model = default_flame_model();
  Model computed = model;  // its range is another one, further away than it ever gets: it has no opposite any more
  for (int i : {14, 15}) computed.outputs[i].highest += 0.01;
  EXPECT_EQ(played(model), played(computed));
}

TEST(MirroredOutputs, AreNotThoseThatDifferInAnything) {
  const std::vector<float> mirrored = played(default_flame_model());
  const auto differs = [&](auto change) {
    Model model = default_flame_model();
    change(model, std::get<ArxModel>(model.dynamics));
    const std::vector<float> frames = played(model);
    bool any = false;
    for (std::size_t k = 14; k < 16; ++k) {
      for (std::size_t at = k; at < frames.size(); at += frames.size() / 300) any |= frames[at] != mirrored[at];
    }
    return any;
  };
  EXPECT_FALSE(differs([](Model&, ArxModel&) {}));
  EXPECT_TRUE(differs([](Model&, ArxModel& arx) { arx.theta[14][1] += 0.01; }));
  EXPECT_TRUE(differs([](Model&, ArxModel& arx) { arx.theta[14][5] += 0.01; }));
  EXPECT_TRUE(differs([](Model&, ArxModel& arx) { arx.constant[15] += 0.01; }));
  EXPECT_TRUE(differs([](Model&, ArxModel& arx) { arx.output_mean[14] += 0.01; }));
  EXPECT_TRUE(differs([](Model&, ArxModel& arx) {
    for (std::size_t row = 0; row < arx.noise.resampled.rows.size(); row += 16) arx.noise.resampled.rows[row + 14] = 99;
  }));
  EXPECT_TRUE(differs([](Model&, ArxModel& arx) { arx.noise.resampled.mirror[14] = 1; }));
  EXPECT_TRUE(
      differs([](Model& model, ArxModel&) { model.outputs[14].lowest = 0.49, model.outputs[14].highest = 0.5; }));
}

}  // namespace
}  // namespace wisp::arx_mirrored_test
