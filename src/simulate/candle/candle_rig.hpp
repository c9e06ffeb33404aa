#pragma once
// A candle in wind: a planar, reacting, buoyant flow at low Mach number, advanced one video frame at a time.
//
// A marker-and-cell grid carries mixture fraction, unburnt fuel, temperature and soot; the flow expands where it is
// heated, rises where it is hot, and is made to obey ∇·u = expansion by a pressure solve. A wick gives off fuel while
// it is warm, so a flame that is blown away from it goes out, and one that is lit again burns on.
// docs/explanation/candle-rig.md has the equations, says which parameters are physics and which are calibrated, and
// what was measured.

#include <vector>

#include "simulate/candle/candle_flow.hpp"
#include "wisp/base/result.hpp"
#include "wisp/simulate/candle_clip.hpp"

namespace wisp {

/// Light of the flame while the shutter was open, cell by cell from the lower left, and the candle's place.
struct RigLight {
  int columns = 0;
  int rows = 0;
  double cell_mm = 0;
  double wick_x_mm = 0;     ///< of the candle's axis, from the grid's left edge
  double wick_y_mm = 0;     ///< of the candle's upper rim, from the grid's lower edge
  std::vector<float> soot;  ///< yellow light of glowing soot; about 1 in the body of a calm flame
  std::vector<float> blue;  ///< faint blue of the reaction itself, 1/s of fuel burnt
};

/// State of the rig after the last frame.
struct CandleState {
  double seconds = 0;              ///< since the rig was made
  bool lit = false;                ///< burns at least a tenth of what a calm flame burns
  double fuel = 0;                 ///< emitted by the wick, as a share of fuel_rate
  double burning = 0;              ///< fuel burnt, as a share of a calm flame's
  double wick_temperature = 0;     ///< K, mean within 2 mm of the wick's box
  double hottest = 0;              ///< K
  double fastest = 0;              ///< m/s
  bool finite = true;              ///< no NaN or infinity anywhere: false would be a defect
  double pressure_iterations = 0;  ///< mean a step
};

/// One candle. The same options and wind give the same bits.
class CandleRig {
 public:
  /// A candle lit just now in still air; it burns evenly after about a second.
  /// Errors: an option outside its range, or a candle that does not fit into the grid.
  static Result<CandleRig> create(const CandleRigOptions& options = {});

  /// One frame of 1/rate_hz under a wind in m/s, positive towards +x, that goes in a straight line from the last
  /// frame's value to this one. Clamped to ±10 m/s; NaN counts as calm.
  void step_frame(double wind);

  /// Holds a flame to the wick for a quarter of a second.
  void light();

  CandleState state() const;
  const CandleRigOptions& options() const { return options_; }

  /// Light of the last frame.
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
