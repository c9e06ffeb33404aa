#pragma once
// Dynamics of a whole outline: all coordinates together, through the components of its shape.
//
// Control points played singly lose what they share: above 8 Hz the outline's coordinates no longer move together. A
// model in which every coordinate hears all others keeps that, but neighbouring points move nearly alike, so that least
// squares cannot tell their coefficients apart. In principal components, each scaled to a standard deviation of 1, the
// regressors of one lag are uncorrelated and a ridge bears on all alike (a dynamic texture's coordinates: S. Soatto,
// G. Doretto, Y. N. Wu, "Dynamic Textures", ICCV 2001, with all components kept). What is returned is an ordinary ARX
// model of the coordinates.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/outline/outline_preparation.hpp"
#include "wisp/base/result.hpp"

namespace wisp {

/// Shape components: an outline is rest + shape · component.
struct ShapeComponents {
  std::vector<std::string> names;  ///< of the components, as channels
  std::vector<double> rest;        ///< one an output: the calm shape, or the mean where it is never calm
  bool about_calm = false;         ///< whether it is the calm shape
  Eigen::MatrixXd shape;           ///< outputs × components
  Eigen::MatrixXd score;  ///< components × outputs: its pseudo-inverse, which does not look at the last point,
                          ///< that mirrors the first about the base
};

/// How the dynamics are estimated.
struct ComponentOptions {
  ArxOrders orders;          ///< of the coordinates: outline_orders() with OutlineCoupling::kFull
  double ridge = 0;          ///< ArxOptions::ridge
  double mirror_weight = 0;  ///< 0 to 1: of the mirror image of every row; 0: none is learned from
};

/// The components of what moves in prepared recordings.
///
/// Precondition: there is a complete row.
ShapeComponents shape_components(std::span<const Recording> recordings, const PreparedOutlines& prepared);

/// Fits an ARX model of all coordinates through their shape components. Standard errors are not known.
/// Errors: as fit_arx().
///
/// Precondition: the recordings are the prepared ones or parts of them, in their order.
Result<ArxFit> fit_components(std::span<const Recording> recordings, const PreparedOutlines& prepared,
                              const ComponentOptions& options);

}  // namespace wisp
