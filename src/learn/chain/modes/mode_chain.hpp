#pragma once
// The Markov chain over modes, estimated from sequences of them: of fixed order, or of variable order with back-off.
//
// Sources: section 4.2 of the paper (p_ij = M_ij / M_i); I. H. Witten & T. C. Bell, The zero-frequency problem, IEEE
// Trans. Information Theory 37 (1991), method C, for how much an unseen event is worth: P(m | history) =
// (count(m) + kinds · P(m | shorter history)) / (count + kinds), kinds being how many different modes have followed.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "wisp/model/chain.hpp"

namespace wisp::chain {

/// Sequences of modes, one a stretch of segments that follow each other.
using ModeSequences = std::vector<std::vector<std::uint16_t>>;

/// For each mode of the sequences, how many it stands for (> 0); empty: one each.
using ModeWeights = std::vector<std::vector<double>>;

struct ModeChainOptions {
  int history = 1;            ///< longest history, 1 … 16
  bool back_off = false;      ///< Witten–Bell; otherwise counts as they are wherever the history was seen
  std::size_t min_count = 5;  ///< histories longer than one mode need as many successors, or say too little
};

struct ModeChain {
  std::vector<double> initial;         ///< per mode
  std::vector<ChainContext> contexts;  ///< every single mode, then longer histories
  std::vector<std::size_t> counts;     ///< modes × modes: transitions that were seen, unweighted
};

/// A mode that nothing followed (it only ends recordings) goes on as modes do on the whole, so that no walk is
/// stranded.
///
/// Precondition: all modes are below `modes`, and there is at least one; weights of the sequences' shape, or none.
ModeChain estimate_chain(const ModeSequences& sequences, int modes, const ModeChainOptions& options,
                         const ModeWeights& weights = {});

/// Mean natural logarithm of the probability that the chain gives each mode of the sequences that has one before it:
/// −ln(modes) for a chain that knows nothing. A probability of 0 counts as 1e-6. NaN where there is no transition.
double log_likelihood(const ModeChain& chain, const ModeSequences& sequences);

/// The options with which a chain learned from one part of the sequences gives most to the other, of histories 1 …
/// `most` with back-off; by fifths of the sequences.
ModeChainOptions best_history(const ModeSequences& sequences, int modes, int most);

}  // namespace wisp::chain
