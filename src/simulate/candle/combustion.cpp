#include "simulate/candle/flow_equations.hpp"

#include <algorithm>
#include <cmath>

namespace wisp::flow {
namespace {

constexpr float kGlowFrom = 900.0F;  // K: a camera sees colder soot as black
constexpr float kGlowTo = 2500.0F;
constexpr float kGlowStep = 5.0F;
constexpr double kGlowActivation = 9000;  // K: second radiation constant over a wavelength of orange-red light,
                                          // including a soot absorption proportional to 1/wavelength; calibrated
constexpr double kGlowUnit = 1800;        // K: temperature at which soot of unit density has glow 1
constexpr float kMaxSoot = 1.2F;
constexpr float kStoichiometric = 0.08F;         // mixture fraction of stoichiometric combustion
constexpr float kHeat = 1700 / 0.08;             // K per unit of fuel burnt: 1700 K at stoichiometry
constexpr float kReactionRate = 2000.0F;         // 1/s at the full rate
constexpr float kIgnitionLow = 900.0F;           // K: no reaction below
constexpr float kIgnitionWidth = 400.0F;         // K: width of the rise to the full rate
constexpr float kSootRate = 60, kBurnout = 400;  // 1/s, calibrated

// Smooth step from 0 at a to 1 at a + width.
float smoothstep(float x, float a, float width) {
  const float t = std::clamp((x - a) / width, 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

// Approximates 1 − e^(−x) for x ≥ 0, to 0.2 % at 1 and never above 1, without a library's exponential, whose bits
// differ between machines.
float share_of_step(float x) {
  return 1.0F - 1.0F / (1.0F + x * (1.0F + x * (0.5F + x * (1.0F / 6 + x * (1.0F / 24)))));
}

}  // namespace

Combustion::Combustion(float step) : step_(step) {
  for (float t = kGlowFrom; t <= kGlowTo + 2 * kGlowStep; t += kGlowStep)
    glow_.push_back(static_cast<float>(std::exp(-kGlowActivation * (1.0 / static_cast<double>(t) - 1.0 / kGlowUnit))));
}

float Combustion::burn_cell(Float4& cell) const {
  const float oxygen_per_fuel = kStoichiometric / (1.0F - kStoichiometric);
  const float oxygen = (1.0F - cell[kMixture]) - (cell[kMixture] - cell[kFuel]) / oxygen_per_fuel;
  const float burnable = std::min(cell[kFuel], std::max(oxygen, 0.0F) * oxygen_per_fuel);
  const float hot = smoothstep(cell[kTemperature], kIgnitionLow, kIgnitionWidth);
  const float burnt = burnable * share_of_step(kReactionRate * step_ * hot);
  cell[kFuel] -= burnt;
  cell[kTemperature] += kHeat * burnt;
  soot_cell(cell, oxygen - burnt / oxygen_per_fuel);
  return burnt;
}

void Combustion::soot_cell(Float4& cell, float oxygen) const {
  const float richness = cell[kMixture] / kStoichiometric;
  const float temperature = cell[kTemperature];
  const float made = kSootRate * smoothstep(richness, 1.05F, 0.75F) * smoothstep(temperature, 1250.0F, 300.0F);
  const float lost = kBurnout * smoothstep(oxygen, 0.02F, 0.1F) * smoothstep(temperature, 1000.0F, 400.0F);
  cell[kSoot] = (cell[kSoot] + step_ * made * kMaxSoot) / (1.0F + step_ * (made + lost));
}

double Combustion::burn(const FlowGrid& grid, ScalarPlane& cells, Plane* blue) const {
  const float coldest = std::min(kIgnitionLow, 1000.0F);
  double total = 0;
  for (int j = 0; j < grid.ny; ++j) {
    float row_total = 0;
    for (int k = grid.at(0, j), end = k + grid.nx; k < end; ++k) {
      if (cells[k][kTemperature] <= coldest) continue;
      const float burnt = burn_cell(cells[k]);
      row_total += burnt * kAmbientTemperature / cells[k][kTemperature];
      if (blue) (*blue)[k] += burnt / step_;
    }
    total += static_cast<double>(row_total);
  }
  return total;
}

float Combustion::glow(float temperature) const {
  const float place = (std::min(temperature, kGlowTo) - kGlowFrom) / kGlowStep;
  const int index = static_cast<int>(place);
  return glow_[index] + (place - static_cast<float>(index)) * (glow_[index + 1] - glow_[index]);
}

void Combustion::add_glow(const FlowGrid& grid, const ScalarPlane& cells, Plane& light) const {
  for (int j = 0; j < grid.ny; ++j)
    for (int k = grid.at(0, j), end = k + grid.nx; k < end; ++k)
      if (cells[k][kTemperature] > kGlowFrom && cells[k][kSoot] > 1e-5F)
        light[k] += cells[k][kSoot] * glow(cells[k][kTemperature]);
}

}  // namespace wisp::flow
