#pragma once
// Dynamics of an outline: ARX over components of its shape, or over its control points (Reissell and Pai, 2001).
//
// A flame is nearly mirror-symmetric. The principal components of its shape coordinates are therefore symmetric
// (height, width, bulge) or antisymmetric (lean, bend), and a system that commutes with the mirror has two blocks:
// symmetric components depend on symmetric ones and even functions of the wind, antisymmetric components on
// antisymmetric ones and odd functions (for such block structure M. Golubitsky, I. Stewart, "The Symmetry Perspective",
// 2002, chapter 1). The shape at rest is as recorded, asymmetric where wicks or trackers lean.
//
// Without wind no coefficient is estimated: recorded rows are replayed (run/arx/lookup_lanes.hpp), deviations decay.

#include <span>
#include <vector>

#include "learn/judge/prediction.hpp"
#include "learn/outline/outline_preparation.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/model/shape_components.hpp"

namespace wisp {

/// Dynamics, with the shape components they act on.
struct OutlineDynamics {
  ArxModel arx;
  ShapeComponents shape;    ///< empty: dynamics act on the control points
  double ridge = 0;         ///< regularisation of whitened components, in rows
  bool stabilised = false;  ///< whether the first estimate was unstable
  std::size_t rows = 0;     ///< number of rows in the estimation
};

/// Estimates dynamics from prepared recordings or parts of them. `paper` > 0: one system per control point with that
/// many lags (4 in section 3.4 of the paper) and independent Gaussian noise. 0: shape components, of order 2 with
/// inputs, decaying exponentially without. Errors: an outline that never moves; too few complete rows; as fit_arx().
Result<OutlineDynamics> fit_dynamics(std::span<const Recording> recordings, const PreparedOutlines& prepared,
                                     int paper);

/// Projects the shape coordinates of a planar outline on the components.
///
/// Precondition: the shape's basis has orthogonal columns, as that of fit_dynamics().
std::vector<double> components_of(const ShapeComponents& shape, std::span<const double> coordinates);

/// Returns a prepared recording with outputs c0, c1, …, the shape components; unchanged where the shape is empty.
Recording moved_recording(const ShapeComponents& shape, const Recording& recording, const PreparedOutlines& prepared);

/// Output and input channels of moved_recording().
ChannelChoice moved_channels(const ShapeComponents& shape, const PreparedOutlines& prepared);

/// Predictions of a prepared recording's control points. Errors: as predict().
Result<std::vector<std::vector<double>>> predict_outline(const OutlineDynamics& dynamics, const Recording& recording,
                                                         const PreparedOutlines& prepared,
                                                         const PredictOptions& options);

/// Standard deviations of predictions of control points, as prediction_sd(), neglecting covariances between components.
std::vector<std::vector<double>> outline_prediction_sd(const OutlineDynamics& dynamics, int steps);

}  // namespace wisp
