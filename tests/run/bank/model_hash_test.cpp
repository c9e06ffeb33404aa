// A saved bank is of one model: where one number of what is played differs, it is of another.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "model/sample_chain.hpp"
#include "model/sample_switched.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::model_hash_test {
namespace {

// What is changed, and how.
using Changes = std::vector<std::pair<std::string, std::function<void(Model&)>>>;

Bank bank_of(const Model& model) {
  auto bank = Bank::create(model);
  EXPECT_TRUE(bank) << bank.error().message;
  bank->spawn();
  return std::move(bank).value();
}

void expect_others(const Model& model, const Changes& changes) {
  const Bank bank = bank_of(model);
  std::vector<std::byte> saved(bank.save_bytes());
  bank.save(saved);
  EXPECT_TRUE(bank_of(model).restore(saved));
  for (const auto& [what, change] : changes) {
    Model other = model;
    change(other);
    const auto outcome = bank_of(other).restore(saved);
    ASSERT_FALSE(outcome) << what;
    EXPECT_THAT(outcome.error().message, testing::HasSubstr("of another model")) << what;
  }
}

ArxModel& arx(Model& model) { return std::get<ArxModel>(model.dynamics); }
ResampledResiduals& resampled(Model& model) { return arx(model).noise.resampled; }
SwitchedArxModel& switched(Model& model) { return std::get<SwitchedArxModel>(model.dynamics); }
ChainModel& chain(Model& model) { return std::get<ChainModel>(model.dynamics); }

TEST(ModelHash, TellsFlamesApart) {
  Model flame = flame_model({.wind = InputShape::kEvenOdd});
  flame.extinction.emplace();
  flame.inputs.push_back({"more", "", -1, 1, InputShape::kLinear});
  for (auto& row : arx(flame).theta) row.push_back(0.01);
  const OrderMatrix nb = arx(flame).orders.nb;
  arx(flame).orders = {arx(flame).orders.na, OrderMatrix(16, 7, 1), OrderMatrix(16, 7)};
  for (int i = 0; i < 16; ++i) {
    for (int k = 0; k < 6; ++k) arx(flame).orders.nb(i, k) = nb(i, k);
  }
  arx(flame).input_mean.push_back(0);
  expect_others(flame, {
                           {"coefficient", [](Model& m) { arx(m).theta[5][2] += 1e-6; }},
                           {"constant", [](Model& m) { arx(m).constant[3] = 0.001; }},
                           {"deviation", [](Model& m) { arx(m).noise.sd[3] *= 1.01; }},
                           {"delay", [](Model& m) { ++arx(m).orders.nk(4, 3); }},
                           {"output's mean", [](Model& m) { arx(m).output_mean[3] += 0.01; }},
                           {"output's range", [](Model& m) { m.outputs[3].highest += 0.01; }},
                           {"input's mean", [](Model& m) { arx(m).input_mean[0] += 0.01; }},
                           {"input's range", [](Model& m) { m.inputs[0].lowest -= 0.01; }},
                           {"inputs' order", [](Model& m) { std::swap(m.inputs[0], m.inputs[1]); }},
                           {"input of extinction", [](Model& m) { m.extinction->input = 1; }},
                           {"level", [](Model& m) { m.extinction->level *= 1.01; }},
                           {"seconds", [](Model& m) { m.extinction->seconds *= 1.01; }},
                           {"haste", [](Model& m) { m.extinction->haste *= 1.01; }},
                           {"recovery", [](Model& m) { m.extinction->recovery *= 1.01; }},
                           {"dying",
                            [](Model& m) {
                              m.extinction->dying = {{9, 8}, {2}};
                            }},
                           {"catching",
                            [](Model& m) {
                              m.extinction->catching = {{9, 8}, {1, 2}};
                            }},
                           {"no extinction", [](Model& m) { m.extinction.reset(); }},
                       });
}

TEST(ModelHash, TellsResampledResidualsApart) {
  expect_others(flame_model({.wind = InputShape::kEvenOdd, .resampled_rows = 60}),
                {
                    {"toward", [](Model& m) { ++resampled(m).toward; }},
                    {"longest", [](Model& m) { --resampled(m).longest; }},
                    {"row", [](Model& m) { ++resampled(m).rows[100]; }},
                    {"scale", [](Model& m) { resampled(m).scale[3] *= 1.01; }},
                    {"wind", [](Model& m) { ++resampled(m).winds[9]; }},
                    {"wind's scale", [](Model& m) { resampled(m).wind_scale *= 1.01; }},
                    {"lag",
                     [](Model& m) {
                       resampled(m).lags = {0, 1, 3, 4};
                     }},
                    {"tolerance", [](Model& m) { resampled(m).tolerance *= 1.01; }},
                    {"margin", [](Model& m) { resampled(m).margin *= 1.01; }},
                    {"end", [](Model& m) { ++resampled(m).ends[0]; }},
                    {"mirror's sign", [](Model& m) { resampled(m).mirror[2] *= -1; }},
                    {"mirror's output", [](Model& m) { std::swap(resampled(m).mirror[0], resampled(m).mirror[2]); }},
                });
}

TEST(ModelHash, TellsSwitchedModelsApart) {
  expect_others(sample_switched(), {
                                       {"coefficient", [](Model& m) { switched(m).modes[2].theta[0][1] += 0.01; }},
                                       {"shock", [](Model& m) { switched(m).modes[1].shock[0] += 0.01; }},
                                       {"first mode",
                                        [](Model& m) {
                                          switched(m).initial = {0.25, 0.25, 0.5};
                                        }},
                                       {"transition",
                                        [](Model& m) {
                                          switched(m).transitions[0] -= 0.01;
                                          switched(m).transitions[1] += 0.01;
                                        }},
                                   });
}

TEST(ModelHash, TellsChainsApart) {
  Model model = windy_chain();
  chain(model).segments.height = {20000, 19000, 18500};
  chain(model).segments.height_scale = 1e-4;
  chain(model).gust->ground.press = chain(model).gust->vertical.press = 0.2;
  expect_others(
      model, {
                 {"position", [](Model& m) { ++chain(m).segments.rows[7]; }},
                 {"rate", [](Model& m) { ++chain(m).segments.rates[7]; }},
                 {"row scale", [](Model& m) { chain(m).segments.row_scale[0] *= 1.01; }},
                 {"rate scale", [](Model& m) { chain(m).segments.rate_scale[0] *= 1.01; }},
                 {"spin scale", [](Model& m) { chain(m).segments.rate_scale[1] *= 1.01; }},
                 {"heading", [](Model& m) { chain(m).heading_free = false; }},
                 {"blend", [](Model& m) { ++chain(m).blend_steps; }},
                 {"successor", [](Model& m) { std::swap(chain(m).segments.follow[0], chain(m).segments.follow[1]); }},
                 {"height", [](Model& m) { ++chain(m).segments.height[1]; }},
                 {"height scale", [](Model& m) { chain(m).segments.height_scale *= 1.01; }},
                 {"gust's change", [](Model& m) { chain(m).gust->ground.change += 0.01; }},
                 {"gust's wind", [](Model& m) { chain(m).gust->vertical.wind += 0.01; }},
                 {"gust's press", [](Model& m) { chain(m).gust->vertical.press += 0.01; }},
                 {"lead", [](Model& m) { ++chain(m).drift->lead[4]; }},
                 {"lead scale", [](Model& m) { chain(m).drift->lead_scale *= 1.01; }},
                 {"drift", [](Model& m) { chain(m).drift->drift[2] *= 1.01; }},
                 {"spread over ground", [](Model& m) { chain(m).drift->spread_ground *= 1.01; }},
                 {"spread of height", [](Model& m) { chain(m).drift->spread_height *= 1.01; }},
                 {"memory", [](Model& m) { chain(m).drift->memory_seconds *= 1.01; }},
                 {"first mode",
                  [](Model& m) {
                    chain(m).initial = {0.5, 0.5};
                  }},
                 {"probability", [](Model& m) { chain(m).probabilities[8] = chain(m).probabilities[9] = 0.5; }},
                 {"history",
                  [](Model& m) {
                    chain(m).history = 1;
                    chain(m).probabilities.resize(4);
                  }},
                 {"width", [](Model& m) { std::get<PoseView>(m.view).half_width *= 1.01; }},
                 {"length", [](Model& m) { std::get<PoseView>(m.view).half_length *= 1.01; }},
             });
}

}  // namespace
}  // namespace wisp::model_hash_test
