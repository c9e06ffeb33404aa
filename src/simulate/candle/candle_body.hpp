#pragma once
// Obstacles and sources in the flow: the solid wax and the box around the wick, which emits fuel.

#include <vector>

#include "simulate/candle/flow_grid.hpp"
#include "wisp/simulate/candle_clip.hpp"

namespace wisp::flow {

// Millimetres. "Calibrated" values, here and in other constants of the rig, were chosen so that the flame looks and
// leans like a real one; the others are properties of matter.
inline constexpr double kCandleWidthMm = 12;  ///< of the wax, solid
inline constexpr double kCandleHeightMm = 10;
inline constexpr double kWickGapMm = 4;     ///< from the wax to the box that gives off fuel
inline constexpr double kWickWidthMm = 5;   ///< calibrated: of that box; at 6 mm the flame is near puffing
inline constexpr double kWickHeightMm = 4;  ///< calibrated

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
