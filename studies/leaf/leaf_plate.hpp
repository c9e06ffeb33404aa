#pragma once
// A thin plate falling in a plane: the published model that the leaf in space descends from, for checking.
//
// Source: A. Andersen, U. Pesavento & Z. J. Wang, Unsteady aerodynamics of fluttering and tumbling plates, J. Fluid
// Mech. 541 (2005), with the coefficients of their numerical study. Lengths are in half widths of the plate, speeds in
// √((ρs/ρf − 1) g b) with b its half thickness, times in their ratio.

#include "wisp/base/result.hpp"

namespace wisp {

/// The plate's motion, without units.
struct PlateState {
  double x = 0, y = 0;           ///< place; y is up
  double angle = 0;              ///< of the plate against the horizontal, radians, not wrapped
  double along = 0, across = 0;  ///< velocity along the plate and across it
  double spin = 0;               ///< radians a unit of time
};

/// How it falls in the long run.
enum class PlateRegime {
  kFlutter,  ///< from side to side, never over
  kTumble,   ///< over and over, always the same way round
  kMixed,    ///< both in turns
};

struct PlateFall {
  PlateRegime regime = PlateRegime::kFlutter;
  double period = 0;          ///< from side to side and back; of half a turn where it tumbles; 0 where it does both
  double stall_interval = 0;  ///< mean time between zeros of the velocity along the plate
};

/// How a state changes, in its own layout. `inertia` is I*: the plate's mass against the fluid's.
///
/// Precondition: inertia > 0.
PlateState plate_rate(double inertia, const PlateState& state);

/// Lets a plate fall from a slight tilt and watches it between two times, with classical Runge–Kutta steps of 0.001.
/// Errors: inertia outside 0.01 … 100, or times that are not 0 < from < to <= 100000.
Result<PlateFall> watch_plate(double inertia, double from = 200, double to = 600);

}  // namespace wisp
