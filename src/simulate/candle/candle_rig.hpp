#pragma once
// A candle in wind: a planar, reacting, buoyant flow at low Mach number, advanced one video frame at a time.
//
// A marker-and-cell grid carries mixture fraction, unburnt fuel, temperature and soot; the flow expands where it is
// heated, rises where it is hot, and satisfies ∇·u = expansion by a pressure solve. A wick emits fuel while it is warm,
// so a flame that is blown away from it is extinguished, and a relit one keeps burning. docs/explanation/candle-rig.md
// has the equations, the physical and the calibrated parameters, and measurements.

#include <vector>

#include "simulate/candle/flow_equations.hpp"
#include "wisp/base/result.hpp"
#include "wisp/simulate/candle_clip.hpp"

namespace wisp::flow {

// Millimetres. "Calibrated" constants, here and elsewhere in the rig, make the flame look and lean like a real one; the
// others are material properties.
inline constexpr double kCandleWidthMm = 12;  ///< width of the solid wax
inline constexpr double kCandleHeightMm = 10;
inline constexpr double kWickGapMm = 4;     ///< distance from the wax to the box around the wick that emits fuel
inline constexpr double kWickWidthMm = 5;   ///< calibrated: width of the box; at 6 mm the flame is near puffing
inline constexpr double kWickHeightMm = 4;  ///< calibrated: height of the box

struct CandleBody {
  Plane open_x, open_y;         ///< 1 on faces open to air, 0 on those of the wax
  Plane fuel_share;             ///< per cell, 1/m²: proportional to `drag`, with integral 1
  Plane drag;                   ///< per cell, 0 … 1: a smooth hump over the wick's box
  std::vector<int> fuel_cells;  ///< cells with a fuel share
  std::vector<int> near_wick;   ///< cells within 2 mm of the box and outside the wax
  float axis = 0;               ///< position of the candle's axis, metres from the left edge
  float rim = 0;                ///< position of the candle's upper rim, metres from the lower edge
};

/// Returns the number of simulation steps per frame.
int steps_per_frame(const CandleRigOptions& options);

class CandleFlow {
 public:
  explicit CandleFlow(const CandleRigOptions& options);

  /// Advances one step with a wind in m/s. While `exposed`, light is accumulated. Returns m²/s of cold fuel burnt.
  double step(float wind, bool exposed);

  /// Heats the surroundings of the wick to at least 1500 K and supplies fuel, like a lighter.
  void hold_flame_to_wick();

  const FlowGrid& grid() const { return grid_; }
  const CandleBody& body() const { return body_; }
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
  float wick_temperature() const;
  void feed_wick();
  void move();
  void take_temperature();
  void set_conductance();
  void set_scalar_fluxes();
  void set_scale(float material, int offset, const Plane* open);
  void mix();
  void release_fuel();
  void push(float wind);
  void project();
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
  Plane temperature_;              // of cells; border: copies of the rim left, right and above, ambient below
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

namespace wisp {

/// Mean light of the flame during the exposure, row by row from the lower left cell, and the candle's position.
struct RigLight {
  int columns = 0;
  int rows = 0;
  double cell_mm = 0;
  double wick_x_mm = 0;     ///< x of the candle's axis, from the grid's left edge
  double wick_y_mm = 0;     ///< y of the candle's upper rim, from the grid's lower edge
  std::vector<float> soot;  ///< yellow light of glowing soot; about 1 in the body of a calm flame
  std::vector<float> blue;  ///< fuel burnt, 1/s: the reaction itself glows faintly blue
};

/// State of the rig after the last frame.
struct CandleState {
  bool lit = false;    ///< burns at least a tenth of fuel_rate (a calm flame burns fuel_rate)
  double fuel = 0;     ///< emitted by the wick, as a share of fuel_rate
  double burning = 0;  ///< fuel burnt, as a share of fuel_rate
  double hottest = 0;  ///< maximum temperature, K
  double fastest = 0;  ///< maximum speed, m/s
  bool finite = true;  ///< false: the flow has NaN or infinity, which would be a defect
};

/// One candle. Equal options and winds give equal bits.
class CandleRig {
 public:
  /// Creates a candle just lit in still air; it burns steadily after about a second.
  /// Errors: an option outside its range, or a candle that does not fit into the grid.
  static Result<CandleRig> create(const CandleRigOptions& options = {});

  /// Simulates one frame of 1/rate_hz. The wind, m/s, positive towards +x, changes linearly from the last call's value
  /// to this one. Winds are clamped to ±10 m/s; NaN counts as calm.
  void step_frame(double wind);

  /// Holds a lighter's flame to the wick for a quarter of a second.
  void light();

  CandleState state() const;
  const CandleRigOptions& options() const { return options_; }

  const RigLight& light_of_frame() const { return light_; }

 private:
  explicit CandleRig(const CandleRigOptions& options);

  CandleRigOptions options_;
  flow::CandleFlow flow_;
  RigLight light_;
  int lighter_steps_ = 0;
  double wind_ = 0;
  double burning_ = 0;
};

}  // namespace wisp
