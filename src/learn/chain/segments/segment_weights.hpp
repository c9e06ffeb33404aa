#pragma once
// How many segments each recorded one stands for. What lasts long is cut off by a recording's end more often than what
// lasts short, and what was cut off is no segment: of short recordings those that were seen whole are the short ones.
//
// Source: E. L. Kaplan & P. Meier, Nonparametric estimation from incomplete observations, J. American Statistical
// Association 53 (1958); weights as J. M. Robins & A. Rotnitzky, Recovery of information and adjustment for dependent
// censoring using surrogate markers (1992): one over the probability that the recording was still going on.

#include <span>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/segments/segmentation.hpp"

namespace wisp::chain {

/// Weights of whole segments, 1 in the mean; 1 each where fewer than one in twenty that began was cut off.
///
/// Precondition: segments in order, those of one piece one after the other.
std::vector<double> segment_weights(const Motion& motion, std::span<const Segment> segments);

}  // namespace wisp::chain
