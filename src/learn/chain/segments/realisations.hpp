#pragma once
// Realisations of modes. Source: section 2.2 of the paper, which names splines, linear systems, differential equations
// and chains besides segments. Learning converts each into segments, so that a model stores and plays segments only.

#include <cstdint>
#include <span>
#include <vector>

#include "learn/chain/motion/segmentation.hpp"

namespace wisp::chain {

/// Segments of motion, sorted into modes.
struct SortedSegments {
  const Motion& motion;
  std::span<const Segment> segments;
  std::span<const std::uint16_t> mode;
  int modes;
};

/// Segments, modes and motion after a realisation replaced the recorded segments.
struct RealisedSegments {
  Motion motion;
  std::vector<Segment> segments;
  std::vector<std::uint16_t> mode;
  int modes = 0;
};

/// Each segment as a cubic B-spline: its mode's mean plus its projection on the mode's 12 largest principal components.
RealisedSegments spline_segments(const SortedSegments& from, bool heading_free);

/// Segments simulated by a system of each mode, from the recorded initial states and as long: velocities in body axes
/// as a linear system with noise (degree 1), or as a differential equation with products of velocities (degree 2).
/// Errors: motion without orientation, a mode with fewer rows than a fit needs.
Result<RealisedSegments> system_segments(const SortedSegments& from, int degree, std::uint64_t seed);

/// Halves of the segments, each half of a mode clustered into two: a mode then is a chain of four modes.
/// Errors: more than 64 modes in total.
Result<RealisedSegments> half_segments(const SortedSegments& from, bool heading_free, std::uint64_t seed);

}  // namespace wisp::chain
