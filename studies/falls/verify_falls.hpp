#pragma once
// What the parts of the long check of learned falls share.

#include <span>
#include <vector>

#include "learn/chain/chain_fidelity.hpp"
#include "learn/chain/chain_fit.hpp"
#include "studies/verify_bounds.hpp"

namespace wisp::verify {

using namespace chain;

/// The default leaf's falls, and a chain of six modes learned from 156 of them.
struct LearnedLeaf {
  ChainFit fit;
  SegmentationOptions segmentation;
};

/// Learned once, then kept.
const LearnedLeaf& learned_leaf();

/// What an eye follows of falls, and in windows of how many rows.
std::vector<Stretch> series_of(std::span<const Recording> falls, const LearnedLeaf& leaf);
std::size_t window_rows(const LearnedLeaf& leaf);

/// The parts of the check.
void gusts(Bounds& bounds);
void paper(Bounds& bounds);
void spread(Bounds& bounds);
void steering(Bounds& bounds);

/// Says what is wrong and ends the program.
[[noreturn]] void give_up(const Error& error);

}  // namespace wisp::verify
