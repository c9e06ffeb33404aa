#include "learn/chain/segments/segment_traits.hpp"

#include <algorithm>
#include <cmath>

namespace wisp::chain {
namespace {

Traits traits_of(const MotionPiece& piece, const Segment& segment) {
  const Triple from = at_row(piece.position, segment.begin), to = at_row(piece.position, segment.end);
  const double rows = segment.end - segment.begin;
  return {std::hypot(to[0] - from[0], to[1] - from[1]) / rows, (to[2] - from[2]) / rows, rows};
}

// One-way analysis of variance of one trait, among stretches and within them.
struct Variances {
  double among = 0;   // squares of the means of stretches, each as often as it has segments
  double within = 0;  // squares of segments about those means
  double stretches = 0;
  double segments = 0;

  double within_stretches() const { return within / (segments - stretches); }
  double reliability() const { return std::max(0.0, 1 - within_stretches() / (among / (stretches - 1))); }
};

}  // namespace

std::vector<Traits> segment_traits(const Motion& motion, std::span<const Segment> segments) {
  std::vector<Traits> own, out(segments.size());
  for (const Segment& one : segments) own.push_back(traits_of(motion.pieces[one.piece], one));
  for (std::size_t trait = 0; trait < kTraits; ++trait) {
    double mean = 0;
    for (const Traits& one : own) mean += one[trait] / static_cast<double>(own.size());
    Variances found{.segments = static_cast<double>(own.size())};
    for (std::size_t first = 0, end = 0; first < own.size(); first = end, ++found.stretches) {
      double sum = 0;
      for (end = first; end < own.size() && segments[end].piece == segments[first].piece; ++end) sum += own[end][trait];
      const double level = sum / static_cast<double>(end - first);
      for (std::size_t k = first; k < end; ++k) {
        out[k][trait] = level - mean;
        found.among += std::pow(level - mean, 2);
        found.within += std::pow(own[k][trait] - level, 2);
      }
    }
    const double factor = found.within > 0 ? found.reliability() / std::sqrt(found.within_stretches()) : 0;
    for (Traits& one : out) one[trait] *= factor;
  }
  return out;
}

}  // namespace wisp::chain
