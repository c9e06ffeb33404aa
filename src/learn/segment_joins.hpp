#pragma once
// Which segments join which with the least to smooth over.

#include <cstdint>
#include <span>
#include <vector>

#include "wisp/learn/motion.hpp"
#include "wisp/learn/segmentation.hpp"
#include "wisp/model/chain.hpp"

namespace wisp {

/// For each segment and mode the `breadth` segments of that mode whose beginning is nearest to its end, nearest first
/// (a mode with fewer repeats them): by attitude, velocity and angular velocity, in the body's own axes where the chain
/// is free of heading, each over its standard deviation. A segment does not follow itself where its mode has others.
/// Those that a walk with these transitions (modes × modes) would play too often give way to others, as in
/// balanced_followers().
///
/// Precondition: every mode below `modes` has a segment; breadth > 0.
std::vector<std::uint16_t> best_followers(const Motion& motion, std::span<const Segment> segments,
                                          std::span<const std::uint16_t> mode, int modes, bool heading_free,
                                          int breadth, const ChainBlend& blend, std::span<const double> transitions);

}  // namespace wisp
