#pragma once
// Who follows whom so that no segment is played much oftener than others of its mode. A segment whose beginning lies in
// the midst of many would else follow most of them, and such segments are not like all: of a leaf they are the long
// ones, so that its play stalled too seldom.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace wisp::chain {

/// A segment that may follow another one, and how badly it joins.
struct Successor {
  double misfit = 0;
  std::uint16_t segment = 0;

  friend bool operator<(const Successor& a, const Successor& b) {
    return a.misfit < b.misfit || (a.misfit == b.misfit && a.segment < b.segment);
  }
};

/// For each segment and mode, all that may follow: [segment × modes + mode].
using Successors = std::vector<std::vector<Successor>>;

/// Chooses `breadth` of each, the best first, the same again where there are fewer. Segments that a long walk plays
/// oftener, among those of their mode, than as one that stands for `weight` of them are made more expensive, until
/// those that remain too often join much better than the rest. `chances`: segments × modes, how likely each mode is
/// after each segment.
std::vector<std::uint16_t> balanced_successors(const Successors& successors, std::span<const std::uint16_t> mode,
                                               std::span<const double> weight, std::span<const double> chances,
                                               int modes, int breadth);

}  // namespace wisp::chain
