#pragma once
// Obstacles and sources in the flow: the solid wax and the box around the wick, which emits fuel.

#include <vector>

#include "simulate/candle/candle_rig.hpp"
#include "simulate/candle/flow_grid.hpp"

namespace wisp::flow {

struct CandleBody {
  Plane open_x, open_y;         ///< 1 on faces that air passes, 0 on those of the wax
  Plane fuel_share;             ///< per cell, 1/m²: sums to 1 over the area
  Plane drag;                   ///< per cell, 0 … 1: its share in the wick's box
  std::vector<int> fuel_cells;  ///< cells with a fuel share
  std::vector<int> near_wick;   ///< cells within 2 mm of the box and not in the wax
  float axis = 0;               ///< metres from the left edge
  float rim = 0;                ///< metres from the lower edge
};

CandleBody candle_body(const FlowGrid& grid, const CandleRigOptions& options);

}  // namespace wisp::flow
