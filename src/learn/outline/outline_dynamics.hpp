#pragma once
// The dynamics of an outline: ARX over components of its shape, or over its control points as in the paper.
//
// A flame is nearly its own mirror image. The principal components of its shape coordinates are therefore symmetric
// (height, width, bulge) or antisymmetric (lean, bend) ones, and a system that commutes with the mirror has two blocks:
// symmetric components hear symmetric ones and even functions of the wind, antisymmetric components antisymmetric ones
// and odd functions (for such block structure M. Golubitsky, I. Stewart, "The Symmetry Perspective", 2002, chapter 1).
// The shape at rest is as it was recorded: wicks and trackers lean.
//
// Without wind nothing is estimated: recorded rows are played as they were (run/arx/lookup_lanes.hpp), and the dynamics
// only let deviations from them fade.

#include <span>
#include <vector>

#include "learn/arx/judge/prediction.hpp"
#include "learn/outline/outline_preparation.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/model/shape_components.hpp"

namespace wisp {

/// Dynamics and what they move.
struct OutlineDynamics {
  ArxModel arx;
  ShapeComponents shape;    ///< empty: the control points themselves
  double ridge = 0;         ///< on whitened components, in rows
  bool stabilised = false;  ///< whether the first estimate was unstable
  std::size_t rows = 0;     ///< that it was estimated from
};

/// Estimates dynamics from prepared recordings or the first parts of them. `paper`: lags of the paper's point systems
/// (its section 3.4 has 4), whose noise is Gaussian and independent; 0: components of the shape, order 2, or fading
/// ones where there are no inputs. Errors: too few complete rows; as fit_arx().
Result<OutlineDynamics> fit_dynamics(std::span<const Recording> recordings, const PreparedOutlines& prepared,
                                     int paper);

/// A prepared recording with components c0, c1, … of the shape in the place of its control points; as it is where the
/// shape is empty.
Recording moved_recording(const ShapeComponents& shape, const Recording& recording, const PreparedOutlines& prepared);

/// The channels that the dynamics move in such recordings.
ChannelChoice moved_channels(const ShapeComponents& shape, const PreparedOutlines& prepared);

/// Predictions of a prepared recording's control points. Errors: as predict().
Result<std::vector<std::vector<double>>> predict_outline(const OutlineDynamics& dynamics, const Recording& recording,
                                                         const PreparedOutlines& prepared,
                                                         const PredictOptions& options);

/// Standard deviations of predictions of control points, as prediction_sd(). Covariances between components are left
/// out.
std::vector<std::vector<double>> outline_prediction_sd(const OutlineDynamics& dynamics, int steps);

}  // namespace wisp
