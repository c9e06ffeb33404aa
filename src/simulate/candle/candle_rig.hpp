#pragma once
// A candle in wind: a planar, reacting, buoyant flow at low Mach number, advanced one video frame at a time.
//
// A marker-and-cell grid carries mixture fraction, unburnt fuel, temperature and soot; the flow expands where it is
// heated, rises where it is hot, and satisfies ∇·u = expansion by a pressure solve. A wick emits fuel while it is warm,
// so a flame that is blown away from it is extinguished, and a relit one keeps burning. docs/explanation/candle-rig.md
// has the equations, the physical and the calibrated parameters, and measurements.

#include <vector>

#include "simulate/candle/candle_flow.hpp"
#include "wisp/base/result.hpp"
#include "wisp/simulate/candle_clip.hpp"

namespace wisp {

/// Light of the flame during the exposure, cell by cell from the lower left, and the candle's position.
struct RigLight {
  int columns = 0;
  int rows = 0;
  double cell_mm = 0;
  double wick_x_mm = 0;     ///< x of the candle's axis, from the grid's left edge
  double wick_y_mm = 0;     ///< y of the candle's upper rim, from the grid's lower edge
  std::vector<float> soot;  ///< yellow light of glowing soot; about 1 in the body of a calm flame
  std::vector<float> blue;  ///< faint blue of the reaction itself, 1/s of fuel burnt
};

/// State of the rig after the last frame.
struct CandleState {
  double seconds = 0;              ///< time since the rig was created
  bool lit = false;                ///< burns at least a tenth of a calm flame's fuel
  double fuel = 0;                 ///< emitted by the wick, as a share of fuel_rate
  double burning = 0;              ///< fuel burnt, as a share of a calm flame's
  double wick_temperature = 0;     ///< K, mean within 2 mm of the wick's box
  double hottest = 0;              ///< maximum temperature, K
  double fastest = 0;              ///< maximum speed, m/s
  bool finite = true;              ///< no NaN or infinity anywhere: false would be a defect
  double pressure_iterations = 0;  ///< mean per step
};

/// One candle. Equal options and winds give equal bits.
class CandleRig {
 public:
  /// Creates a candle just lit in still air; it burns steadily after about a second.
  /// Errors: an option outside its range, or a candle that does not fit into the grid.
  static Result<CandleRig> create(const CandleRigOptions& options = {});

  /// Simulates one frame of 1/rate_hz with a wind in m/s, positive towards +x, that changes linearly from the last
  /// frame's value to this one. Clamped to ±10 m/s; NaN counts as calm.
  void step_frame(double wind);

  /// Holds a lighter's flame to the wick for a quarter of a second.
  void light();

  CandleState state() const;
  const CandleRigOptions& options() const { return options_; }

  /// Returns the light of the last frame.
  const RigLight& light_of_frame() const { return light_; }

 private:
  explicit CandleRig(const CandleRigOptions& options);

  CandleRigOptions options_;
  flow::CandleFlow flow_;
  RigLight light_;
  long long frames_ = 0;
  int lighter_steps_ = 0;
  double wind_ = 0;
  double burning_ = 0;
  double iterations_ = 0;
};

}  // namespace wisp
