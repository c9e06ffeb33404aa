#pragma once
// The modes of a chain as systems: how velocities change from row to row in all recorded segments of a mode, fitted by
// least squares.
//
// Source: section 2.2 of the paper names linear systems and differential equations as realisations of a mode. A body's
// own axes are those of Kirchhoff's equations, in which forces of the air are products of velocities, and so terms of
// degree 2.

#include <span>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/segments/segmentation.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/mode_systems.hpp"

namespace wisp::chain {

struct ModeSystemOptions {
  int degree = 1;     ///< 1 or 2
  bool noisy = true;  ///< whether what the fit leaves over is played as noise
};

/// `cluster` gives each segment's mode.
/// Errors: motion without orientation, a mode with fewer rows than a fit needs.
Result<ModeSystems> fit_mode_systems(const Motion& motion, std::span<const Segment> segments,
                                     std::span<const std::uint16_t> cluster, int modes,
                                     const ModeSystemOptions& options);

}  // namespace wisp::chain
