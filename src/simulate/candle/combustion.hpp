#pragma once
// One-step combustion of a mixture fraction, soot, and the light that both give off.

#include "simulate/candle/candle_rig.hpp"
#include "simulate/candle/flow_grid.hpp"

namespace wisp::flow {

struct Combustion {
  explicit Combustion(const CandleRigOptions& options, float step);

  /// Burns fuel, makes and burns soot, in all hot cells. Where `blue` is given, adds to it the fuel burnt a second.
  /// Returns the fuel burnt, as a volume of cold gas, summed over cells.
  double burn(const FlowGrid& grid, ScalarPlane& cells, Plane* blue) const;

  /// Adds to `light` what soot of that temperature glows.
  void add_glow(const FlowGrid& grid, const ScalarPlane& cells, Plane& light) const;

 private:
  float burn_cell(Float4& cell) const;
  void soot_cell(Float4& cell, float oxygen) const;
  float glow(float temperature) const;

  float step_;
  float stoichiometric_, heat_, rate_, ignition_low_, ignition_width_, soot_rate_, soot_burnout_;
  Plane glow_;  // table over temperature
};

}  // namespace wisp::flow
