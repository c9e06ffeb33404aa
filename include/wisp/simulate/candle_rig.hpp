#pragma once
// A candle in wind: a planar, reacting, buoyant flow at low Mach number, advanced one video frame at a time.
//
// A marker-and-cell grid carries mixture fraction, unburnt fuel, temperature and soot; the flow expands where it is
// heated, rises where it is hot, and is made to obey ∇·u = expansion by a pressure solve. A wick gives off fuel while
// it is warm, so a flame that is blown away from it goes out, and one that is lit again burns on.
// docs/explanation/candle-rig.md has the equations, says which parameters are physics and which are calibrated, and
// what was measured.

#include <memory>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// Grids whose parameters have been calibrated together. The tip's height depends on cell and time step, so take one
/// of these and change what you must.
enum class CandleGrid {
  kCoarse,  ///< 64 × 128 cells of 0.667 mm, 1200 steps a second: the demo's
  kFine,    ///< 112 × 192 cells of 0.417 mm, 600 steps a second
};

/// The rig. Lengths in millimetres, all else in SI units. "Calibrated" is said where a number was chosen for the
/// flame to look and lean like a real one, not taken from a property of matter.
struct CandleRigOptions {
  // The grid and its time.
  int columns = 64;              ///< 16 … 1024
  int rows = 128;                ///< 16 … 1024
  double cell_mm = 2.0 / 3;      ///< 0.1 … 2; a flame is about 6 mm wide
  double rate_hz = 60;           ///< frames a second, 1 … 1000
  double steps_a_second = 1200;  ///< 100 … 100000, rounded to whole steps a frame: the flame depends on the step, not
                                 ///< on the camera's rate

  // The candle.
  double position = 0.35;       ///< of the candle's axis, as a share of the width, 0.1 … 0.9: room on the lee side
  double candle_width_mm = 12;  ///< of the wax, solid
  double candle_height_mm = 10;
  double wick_gap_mm = 4;         ///< from the wax to the box that gives off fuel
  double wick_width_mm = 5;       ///< calibrated: of that box; at 6 mm the flame is near puffing
  double wick_height_mm = 4;      ///< calibrated
  double wick_damping = 80;       ///< 1/s, calibrated: drag of the wick; without it the flame dies at 0.5 m/s
  double wick_time = 0.15;        ///< s, calibrated: how slowly the fuel follows the wick's heat
  double wick_cold = 500;         ///< K, calibrated: surroundings of the wick at which it gives off nothing
  double wick_warm = 900;         ///< K, calibrated: and at which it gives off all it can
  double fuel_rate = 1.35e-4;     ///< m²/s, calibrated: volume of cold vapour a second per depth of a warm wick
  double fuel_temperature = 600;  ///< K

  // The gas.
  double diffusivity = 2.0e-5;   ///< m²/s at 300 K; grows as T^1.75
  double viscosity = 1.5e-5;     ///< m²/s at 300 K
  double stoichiometric = 0.08;  ///< mixture fraction where fuel and oxygen match
  double flame_heating = 1700;   ///< K of heating there
  double reaction_rate = 2000;   ///< 1/s at full temperature
  double ignition_low = 900;     ///< K: below it nothing burns
  double ignition_high = 1300;   ///< K: above it the reaction has its full rate
  double updraught = 0.25;       ///< m/s, calibrated: the air that rises with a candle
  double most_expansion = 1500;  ///< 1/s: ∇·u is held to it

  // The wind, and soot as a camera sees it.
  double wind_share = 0.4;    ///< calibrated: how much of the wind reaches the flame, most of it goes around
  double wind_rate = 20;      ///< 1/s, calibrated: how fast the air at the flame takes it up
  double soot_rate = 60;      ///< 1/s, calibrated
  double soot_burnout = 400;  ///< 1/s, calibrated
  double exposure = 0.5;      ///< share of a frame's time that its shutter is open, (0, 1]

  double pressure_tolerance = 0.5;  ///< 1/s, root mean square of what the flow still diverges too much
};

/// Steps that a frame is simulated in.
int steps_per_frame(const CandleRigOptions& options);

/// The options of a calibrated grid.
CandleRigOptions candle_rig_options(CandleGrid grid);

/// Light that the flame gave off while the shutter was open, cell by cell from the lower left, and where it was.
struct FlameLight {
  int columns = 0;
  int rows = 0;
  double cell_mm = 0;
  double wick_x_mm = 0;     ///< of the candle's axis, from the grid's left edge
  double wick_y_mm = 0;     ///< of the candle's upper rim, from the grid's lower edge
  std::vector<float> soot;  ///< yellow light of glowing soot; about 1 in the body of a calm flame
  std::vector<float> blue;  ///< faint blue of the reaction itself, 1/s of fuel burnt
};

/// What the rig is doing, as of the last frame.
struct CandleState {
  double seconds = 0;              ///< since the rig was made
  bool lit = false;                ///< burns at least a tenth of what a calm flame burns
  double fuel = 0;                 ///< what the wick gives off, as a share of fuel_rate
  double burning = 0;              ///< what is burnt, as a share of a calm flame's fuel
  double wick_temperature = 0;     ///< K, mean within 2 mm of the wick's box
  double hottest = 0;              ///< K
  double fastest = 0;              ///< m/s
  bool finite = true;              ///< no NaN or infinity anywhere: false would be a defect
  double pressure_iterations = 0;  ///< mean a step
};

/// One candle. Results are the same bits for the same options and wind.
class CandleRig {
 public:
  /// A lit candle in still air that has just been lit; it burns evenly after about a second.
  /// Errors: an option outside its range, or a candle that does not fit into the grid.
  static Result<CandleRig> create(const CandleRigOptions& options = {});

  CandleRig(CandleRig&&) noexcept;
  CandleRig& operator=(CandleRig&&) noexcept;
  ~CandleRig();

  /// One frame of 1/rate_hz under a wind in m/s, positive towards +x, that goes in a straight line from the last
  /// frame's value to this one. Held to ±10 m/s; NaN counts as calm.
  void step_frame(double wind);

  /// Holds a flame to the wick for a quarter of a second.
  void light();

  CandleState state() const;
  const CandleRigOptions& options() const;

  /// Light of the last frame.
  const FlameLight& light_of_frame() const;

 private:
  struct Parts;
  explicit CandleRig(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace wisp
