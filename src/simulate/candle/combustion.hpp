#pragma once
// One-step combustion of a mixture fraction, soot, and the light of both.

#include "simulate/candle/flow_grid.hpp"

namespace wisp::flow {

struct Combustion {
  explicit Combustion(float step);

  /// Burns fuel, forms and burns soot in all hot cells. Adds the fuel burnt per second to `blue`, if given.
  /// Returns the volume of cold fuel burnt, summed over cells.
  double burn(const FlowGrid& grid, ScalarPlane& cells, Plane* blue) const;

  /// Adds the glow of hot soot to `light`.
  void add_glow(const FlowGrid& grid, const ScalarPlane& cells, Plane& light) const;

 private:
  float burn_cell(Float4& cell) const;
  void soot_cell(Float4& cell, float oxygen) const;
  float glow(float temperature) const;

  float step_;
  Plane glow_;  // table over temperature
};

}  // namespace wisp::flow
