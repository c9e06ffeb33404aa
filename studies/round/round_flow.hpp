#pragma once
// A candle in wind from any direction: the flow of the candle rig (docs/explanation/candle-rig.md) on a coarse grid of
// three dimensions, for studies of flames in the round. Slow, and no more exact than its grid.

#include <array>
#include <vector>

#include "simulate/candle/candle_rig.hpp"
#include "simulate/candle/flow_equations.hpp"

namespace wisp::flow {

/// Cells a side; the grid is twice as high as it is wide. A step is steps_a_second of a second.
struct RoundOptions {
  int side = 36;
  double cell_mm = 1.25;
  double steps_a_second = 240;
};

/// Axis and radii of what glows, level by level, in millimetres: x to the right of the camera at azimuth 0, y above the
/// candle's rim, z towards that camera.
struct RoundSection {
  double y = 0, x = 0, z = 0, radius = 0;
};

class RoundFlow {
 public:
  explicit RoundFlow(const RoundOptions& options);

  /// One step under a level wind in m/s.
  void step(float wind_x, float wind_z);

  /// What a level camera at that azimuth sees of the present state, summed along its lines of sight.
  RigLight seen_from(double azimuth_degrees) const;

  /// Sections whose light is more than a fifth of the brightest's.
  std::vector<RoundSection> sections() const;

  double hottest() const;

 private:
  int at(int i, int j, int k) const { return grid_.at(i, j * side_ + k); }
  template <class Visit>
  void each_inner(Visit visit) const;
  Float4 sample(const ScalarPlane& plane, float x, float y, float z) const;
  void place_wick();
  void move();
  void mix();
  void feed();
  void burn_and_push(float wind_x, float wind_z);
  void project();
  double glow_of(int cell) const;

  RoundOptions options_;
  int side_, high_;
  FlowGrid grid_;
  float step_;
  Combustion combustion_;
  ScalarPlane cells_, cells_scratch_, air_, air_scratch_;
  Plane moved_temperature_, theta_, phi_, right_, source_, share_, keep_;
  std::vector<int> fuel_cells_, near_wick_;
};

}  // namespace wisp::flow
