#pragma once
// Realisations of modes. Source: section 2.2 of the paper, which names splines, linear systems, differential equations
// and chains of their own beside segments. Each is turned into segments when a model is learned, so that a model holds
// and plays segments only.

#include <cstdint>
#include <span>
#include <vector>

#include "learn/chain/motion/segmentation.hpp"

namespace wisp::chain {

/// Segments of some motion in their modes.
struct SortedSegments {
  const Motion& motion;
  std::span<const Segment> segments;
  std::span<const std::uint16_t> mode;
  int modes;
};

/// The same, made of others.
struct RealisedSegments {
  Motion motion;
  std::vector<Segment> segments;
  std::vector<std::uint16_t> mode;
  int modes = 0;
};

/// Each segment as a cubic B-spline: the mean of its mode plus what the 12 largest principal components of its mode say
/// of it.
RealisedSegments spline_segments(const SortedSegments& from, bool heading_free);

/// Segments that a system of each mode makes, from where the recorded ones begin and as long: velocities in the body's
/// axes as a linear system with noise (degree 1), or as a differential equation with products of velocities (degree 2).
/// Errors: motion without orientation, a mode with fewer rows than a fit needs.
Result<RealisedSegments> system_segments(const SortedSegments& from, int degree, std::uint64_t seed);

/// Halves of the segments, in two kinds of each mode and half: a mode is then a chain of its own.
/// Errors: more than 64 kinds.
Result<RealisedSegments> half_segments(const SortedSegments& from, bool heading_free, std::uint64_t seed);

}  // namespace wisp::chain
