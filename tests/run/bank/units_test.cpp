// A model in another unit plays the same in that unit: to the last bit where units are powers of two, since what a
// bank steps is measured in ranges.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/sample_switched.hpp"
#include "run/flame_model.hpp"
#include "run/state/channels.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::units_test {
namespace {

// What a number becomes where the unit is so many times smaller.
struct Units {
  double input;
  double output;
};

void scale(std::vector<double>& numbers, double factor) {
  for (double& x : numbers) x *= factor;
}

template <class Channel>
void scale(std::vector<Channel>& channels, double factor) {
  for (Channel& channel : channels) {
    channel.lowest *= factor;
    channel.highest *= factor;
  }
}

// What becomes of each of an input's regressors.
std::vector<double> regressor_units(const Model& model, double unit) {
  std::vector<double> units;
  for (const RegressorForm& form : regressor_forms(model.inputs[0].shape)) {
    units.push_back(form.power == RegressorPower::kRoot     ? std::sqrt(unit)
                    : form.power == RegressorPower::kSquare ? unit * unit
                                                            : unit);
  }
  return units;
}

// Coefficients of A take outputs to outputs, those of B inputs.
void scale_b(std::vector<double>& row, const ArxOrders& orders, int i, double output,
             const std::vector<double>& inputs) {
  auto at = row.begin();
  for (int j = 0; j < orders.outputs(); ++j) at += orders.na(i, j);
  for (int k = 0; k < orders.inputs(); ++k) {
    for (int lag = 0; lag < orders.nb(i, k); ++lag) *at++ *= output / inputs[k];
  }
}

Model in_units(Model model, Units units) {
  const std::vector<double> inputs = regressor_units(model, units.input);
  scale(model.inputs, units.input);
  scale(model.outputs, units.output);
  if (model.extinction) model.extinction->level *= units.input;
  if (auto* arx = std::get_if<ArxModel>(&model.dynamics)) {
    for (int i = 0; i < arx->orders.outputs(); ++i) scale_b(arx->theta[i], arx->orders, i, units.output, inputs);
    for (auto* numbers : {&arx->constant, &arx->output_mean, &arx->noise.sd}) {
      scale(*numbers, units.output);
    }
    for (std::size_t k = 0; k < inputs.size(); ++k) arx->input_mean[k] *= inputs[k];
    ResampledResiduals& resampled = arx->noise.resampled;
    scale(resampled.scale, units.output);
    for (double* number : {&resampled.wind_scale, &resampled.tolerance, &resampled.margin}) *number *= units.input;
    return model;
  }
  auto& switched = std::get<SwitchedArxModel>(model.dynamics);
  for (ArxMode& mode : switched.modes) {
    for (int i = 0; i < 2; ++i) scale_b(mode.theta[i], switched.orders, i, units.output, inputs);
    for (auto* numbers : {&mode.constant, &mode.shock}) scale(*numbers, units.output);
  }
  scale(switched.output_mean, units.output);
  scale(switched.input_mean, units.input);
  return model;
}

// All outputs of some instances in a wind that comes from both sides, in the unit that the model has.
std::vector<float> played(const Model& model, Units units) {
  constexpr int kInstances = 5;
  auto bank = Bank::create(model, {.capacity = kInstances});
  EXPECT_TRUE(bank) << bank.error().message;
  for (int k = 0; k < kInstances; ++k) bank->spawn();
  std::vector<float> all, wind(kInstances), outputs(static_cast<std::size_t>(kInstances) * bank->output_count());
  for (int step = 0; step < 400; ++step) {
    for (int k = 0; k < kInstances; ++k) {
      wind[k] = static_cast<float>(units.input * ((step / 7 * 5 + k) % 17 - 8) / 8);
    }
    bank->set_inputs(wind);
    bank->step();
    bank->outputs(outputs);
    for (float output : outputs) all.push_back(static_cast<float>(output / units.output));
  }
  return all;
}

// In a range of 2^10 the unit of such an input has a root that is a power of two.
Model in_half_a_wind(Model model) {
  model.inputs[0].lowest = -(model.inputs[0].highest = 0.5);
  std::get<ArxModel>(model.dynamics).input_mean = {0.125, 0.25, 0.0625, 0.125, 0.25, 0.0625};
  return model;
}

TEST(Units, NoUnitChangesWhatIsPlayed) {
  Model mortal = in_half_a_wind(default_flame_model());
  mortal.extinction->level = 0.5;
  Model powers = in_half_a_wind(coupled_flame_model());
  powers.extinction.reset();
  for (const Model& model : {in_half_a_wind(flame_model({.wind = InputShape::kEvenOdd})),
                             in_half_a_wind(flame_model({.wind = InputShape::kEvenOdd, .resampled_rows = 600})), mortal,
                             powers, sample_switched()}) {
    const std::vector<float> expected = played(model, {1, 1});
    for (const Units units : {Units{1024, 1}, Units{1, 1024}, Units{0x1p-10, 0x1p-12}}) {
      EXPECT_EQ(played(in_units(model, units), units), expected)
          << model.name << ' ' << units.input << ' ' << units.output;
    }
  }
}

}  // namespace
}  // namespace wisp::units_test
