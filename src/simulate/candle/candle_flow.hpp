#pragma once
// Flow of the candle: the state of the grid, advanced by one time step.

#include <vector>

#include "simulate/candle/flow_equations.hpp"
#include "wisp/simulate/candle_clip.hpp"

namespace wisp::flow {

// Millimetres. "Calibrated" values, here and in other constants of the rig, were chosen so that the flame looks and
// leans like a real one; the others are material properties.
inline constexpr double kCandleWidthMm = 12;  ///< width of the solid wax
inline constexpr double kCandleHeightMm = 10;
inline constexpr double kWickGapMm = 4;     ///< from the wax to the box that emits fuel
inline constexpr double kWickWidthMm = 5;   ///< calibrated: width of that box; at 6 mm the flame is near puffing
inline constexpr double kWickHeightMm = 4;  ///< calibrated

struct CandleBody {
  Plane open_x, open_y;         ///< 1 on faces open to air, 0 on those of the wax
  Plane fuel_share;             ///< per cell, 1/m²: sums to 1 over the area
  Plane drag;                   ///< per cell, 0 … 1: share of its area in the wick's box
  std::vector<int> fuel_cells;  ///< cells with a fuel share
  std::vector<int> near_wick;   ///< cells within 2 mm of the box and outside the wax
  float axis = 0;               ///< position of the candle's axis, metres from the left edge
  float rim = 0;                ///< position of the candle's upper rim, metres from the lower edge
};

/// Returns the number of simulation steps per frame.
int steps_per_frame(const CandleRigOptions& options);

/// Results of one step.
struct FlowStep {
  double burnt = 0;  ///< m²/s of cold fuel burnt
  PressureSolve pressure;
};

class CandleFlow {
 public:
  explicit CandleFlow(const CandleRigOptions& options);

  /// Advances one step with a wind in m/s. While `exposed`, light is accumulated.
  FlowStep step(float wind, bool exposed);

  /// Heats the surroundings of the wick to at least 1500 K and supplies fuel, like a lighter.
  void hold_flame_to_wick();

  const FlowGrid& grid() const { return grid_; }
  const CandleBody& body() const { return body_; }
  float wick_temperature() const;
  float fuel() const { return fuel_; }
  float hottest() const;
  float fastest() const;
  bool finite() const;

  /// Returns the light accumulated since the last call of clear_light(), over `exposed_steps` steps.
  const Plane& glow() const { return glow_; }
  const Plane& blue() const { return blue_; }
  int exposed_steps() const { return exposed_steps_; }
  void clear_light();

 private:
  void set_drag();
  void feed_wick();
  void move();
  void take_temperature();
  void set_conductance();
  void set_scalar_fluxes();
  void set_scale(float material, int offset, const Plane* open);
  void mix();
  void release_fuel();
  void push(float wind);
  PressureSolve project();
  void set_divergence();
  void apply_pressure();

  CandleRigOptions options_;
  FlowGrid grid_;
  float step_;
  CandleBody body_;
  Combustion combustion_;
  PressureSolver pressure_;

  ScalarPlane cells_, cells_scratch_;
  Plane u_, v_, u_scratch_, v_scratch_;
  Plane way_x_, way_y_;
  Plane temperature_;              // cells, with copies of the rim around them
  Plane moved_temperature_;        // after advection, before combustion
  Plane keep_u_, keep_v_;          // factor of drag on a velocity per step
  Plane conductance_, corner_;     // (T/T0)^0.75 in cells, and at their lower left corners
  Plane flux_x_, flux_y_, scale_;  // for diffusion
  Plane fuel_source_;              // 1/s
  Plane glow_, blue_;
  float fuel_ = 0;  // m²/s
  int exposed_steps_ = 0;
};

}  // namespace wisp::flow
