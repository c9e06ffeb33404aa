#include "learn/chain/segments/segment_store.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "learn/chain/modes/successor_modes.hpp"
#include "learn/chain/segments/join_jumps.hpp"
#include "learn/chain/segments/segment_features.hpp"
#include "learn/chain/segments/segment_joins.hpp"
#include "learn/chain/segments/segment_moments.hpp"
#include "learn/chain/segments/segment_weights.hpp"
#include "learn/fidelity/fidelity_shuffle.hpp"

namespace wisp::chain {
namespace {

constexpr double kMaxStored = 32767;
constexpr double kUsualShare = 0.99;
constexpr double kCalm = 0.95;

// What a segment consists of, in its own frame, before it is rounded.
struct Piece {
  std::vector<Triple> position;
  std::vector<Quad> orientation;
  std::array<Triple, 2> velocity;
  std::array<Triple, 2> spin;
};

Piece piece_of(const Motion& motion, const Segment& segment, bool heading_free) {
  const MotionPiece& from = motion.pieces[segment.piece];
  const double heading = heading_free ? heading_of(motion, segment) : 0;
  const double rows = segment.end - segment.begin, stretch = rows / segment.steps;
  const Triple origin = at_row(from.position, segment.begin);
  Piece piece;
  for (int step = 0; step <= segment.steps; ++step) {
    const double row = segment.begin + stretch * step;
    const Triple at = at_row(from.position, row);
    piece.position.push_back(turned_about_z(Triple{at[0] - origin[0], at[1] - origin[1], at[2] - origin[2]}, -heading));
    if (motion.has_orientation) piece.orientation.push_back(turned_about_z(at_row(from.orientation, row), -heading));
  }
  for (std::size_t end : {0U, 1U}) {
    const double row = end ? segment.end : segment.begin;
    piece.velocity[end] = turned_about_z(at_row(from.velocity, row), -heading);
    if (motion.has_orientation) piece.spin[end] = turned_about_z(at_row(from.spin, row), -heading);
    for (double& x : piece.velocity[end]) x *= stretch;
    for (double& x : piece.spin[end]) x *= stretch;
  }
  return piece;
}

double largest(double so_far, const Triple& vector) {
  for (double x : vector) so_far = std::max(so_far, std::abs(x));
  return so_far;
}

double scale_for(double most) { return most > 0 ? most / kMaxStored : 1.0 / kMaxStored; }

template <std::size_t kSize>
void put(const std::array<double, kSize>& values, double scale, std::vector<std::int16_t>& out) {
  for (double x : values) {
    out.push_back(static_cast<std::int16_t>(std::lround(std::clamp(x / scale, -kMaxStored, kMaxStored))));
  }
}

std::size_t bytes_of(const Segment& segment, bool pose, std::size_t successors) {
  const std::size_t channels = pose ? 7 : 3, rates = pose ? 12 : 6;
  return 2 * (static_cast<std::size_t>(segment.steps + 1) * channels + rates + 2 + successors);
}

// Most segments a mode may keep so that all fit: modes that have fewer leave their room to the others.
std::size_t cap_of(const std::vector<std::vector<std::size_t>>& members, std::size_t most) {
  std::size_t low = 1, high = most;
  while (low < high) {
    const std::size_t cap = (low + high + 1) / 2;
    std::size_t kept = 0;
    for (const auto& mode : members) kept += std::min(mode.size(), cap);
    (kept <= most ? low : high) = kept <= most ? cap : cap - 1;
  }
  return low;
}

// The segments from row to row of their recording. To play them from event to event their time would have to be
// stretched to whole steps, by a quarter where they have but a few, and what is stretched moves at another speed than
// what it joins.
std::vector<Segment> on_rows(const Motion& motion, std::span<const Segment> segments) {
  std::vector<Segment> out(segments.begin(), segments.end());
  for (Segment& one : out) {
    const auto last = static_cast<double>(motion.pieces[one.piece].rows() - 1);
    one.begin = std::min(std::round(one.begin), last - one.steps);
    one.end = one.begin + one.steps;
  }
  return out;
}

// Whether a segment's last row jumps no more than rows do but for the hundredth that jump most.
bool ends_calmly(const Motion& motion, const Segment& segment, const Jump& usual) {
  const auto end = static_cast<std::size_t>(segment.end);
  if (end < 2) return true;
  const Jump jump = jump_at(motion.pieces[segment.piece], end);
  return jump.position <= kCalm * usual.position && jump.rotation <= kCalm * usual.rotation;
}

// Segments that stay, by mode, and within a mode in the order of the recording. Where not all can, those go first that
// end with a jump: it would show at every join.
std::vector<std::size_t> kept_segments(const Motion& motion, std::span<const Segment> segments,
                                       std::span<const std::uint16_t> cluster, int modes, bool pose,
                                       const SegmentStoreOptions& options) {
  std::vector<std::vector<std::size_t>> members(static_cast<std::size_t>(modes));
  std::size_t bytes = 0;
  const auto successors = static_cast<std::size_t>(options.breadth > 0 ? options.breadth + 1 : 0) *
                          static_cast<std::size_t>(modes);  // and how likely each mode is
  for (std::size_t k = 0; k < segments.size(); ++k) {
    members[cluster[k]].push_back(k);
    bytes += bytes_of(segments[k], pose, successors);
  }
  const double share = std::min(1.0, static_cast<double>(options.max_bytes) / static_cast<double>(bytes));
  const auto room = static_cast<std::size_t>(share * static_cast<double>(segments.size()));
  const std::size_t cap = cap_of(members, std::clamp<std::size_t>(room, 1, kMostSegments - members.size()));
  std::mt19937_64 random(options.seed);
  const Jump usual = usual_jump(motion, kUsualShare);
  std::vector<std::size_t> kept;
  for (auto& mode : members) {
    shuffle(std::span(mode), random);
    std::stable_partition(mode.begin(), mode.end(),
                          [&](std::size_t k) { return ends_calmly(motion, segments[k], usual); });
    mode.resize(std::min(mode.size(), cap));
    std::sort(mode.begin(), mode.end());
    kept.insert(kept.end(), mode.begin(), mode.end());
  }
  return kept;
}

// Shares of the modes that follow each mode, modes × modes.
std::vector<double> transitions_of(std::span<const Segment> segments, std::span<const std::uint16_t> cluster,
                                   std::span<const double> weight, int modes) {
  const auto count = static_cast<std::size_t>(modes);
  std::vector<double> share(count * count);
  for (std::size_t k = 1; k < segments.size(); ++k) {
    if (segments[k].piece == segments[k - 1].piece) share[cluster[k - 1] * count + cluster[k]] += weight[k];
  }
  for (std::size_t from = 0; from < count; ++from) {
    const auto row = std::span(share).subspan(from * count, count);
    const double all = std::accumulate(row.begin(), row.end(), 0.0);
    // One that was only ever the last is followed by any.
    for (double& one : row) one = all > 0 ? one / all : 1.0 / modes;
  }
  return share;
}

// What follows each stored segment: which modes, and of each which segments.
void join_up(const Motion& motion, std::span<const Segment> segments, std::span<const std::uint16_t> cluster, int modes,
             const SegmentStoreOptions& options, SegmentStore& store) {
  const SegmentMoments moments = segment_moments(motion, segments, options.heading_free);
  const std::vector<double> weight = segment_weights(motion, segments);
  SuccessorModes onward =
      successor_modes(moments, cluster, weight, store.source, transitions_of(segments, cluster, weight, modes), modes);
  std::vector<Segment> kept;
  SegmentMoments own;
  std::vector<double> own_weight;
  for (std::size_t source : store.source) {
    kept.push_back(segments[source]);
    own.starts.push_back(moments.starts[source]);
    own.ends.push_back(moments.ends[source]);
    own_weight.push_back(weight[source]);
  }
  const SuccessorOptions joining{options.heading_free, options.breadth, options.blend};
  ChainSegments& out = store.segments;
  out.follow = best_successors(motion, kept, own, out.mode, modes, joining, own_weight, onward.chances);
  if (modes > 1) out.onward = std::move(onward.share);
}

}  // namespace

SegmentStore store_segments(const Motion& motion, std::span<const Segment> found,
                            std::span<const std::uint16_t> cluster, int modes, const SegmentStoreOptions& options) {
  const std::vector<Segment> segments = on_rows(motion, found);
  SegmentStore store;
  store.source = kept_segments(motion, segments, cluster, modes, motion.has_orientation, options);
  std::vector<Piece> pieces;
  double farthest = 0, fastest = 0, quickest = 0;
  for (std::size_t source : store.source) {
    pieces.push_back(piece_of(motion, segments[source], options.heading_free));
    for (const Triple& at : pieces.back().position) farthest = largest(farthest, at);
    for (const Triple& velocity : pieces.back().velocity) fastest = largest(fastest, velocity);
    for (const Triple& spin : pieces.back().spin) quickest = largest(quickest, spin);
  }
  ChainSegments& out = store.segments;
  out.row_scale = {scale_for(farthest)};
  out.rate_scale = {scale_for(fastest)};
  if (motion.has_orientation) {
    out.row_scale.push_back(1 / kMaxStored);
    out.rate_scale.push_back(scale_for(quickest));
  }
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    out.mode.push_back(cluster[store.source[k]]);
    out.steps.push_back(static_cast<std::uint16_t>(segments[store.source[k]].steps));
    for (std::size_t row = 0; row < pieces[k].position.size(); ++row) {
      put(pieces[k].position[row], out.row_scale[0], out.rows);
      if (motion.has_orientation) put(pieces[k].orientation[row], out.row_scale[1], out.rows);
    }
    for (std::size_t end : {0U, 1U}) {
      put(pieces[k].velocity[end], out.rate_scale[0], out.rates);
      if (motion.has_orientation) put(pieces[k].spin[end], out.rate_scale[1], out.rates);
    }
  }
  out.breadth = options.breadth;
  if (options.breadth > 0) join_up(motion, segments, cluster, modes, options, store);
  return store;
}

}  // namespace wisp::chain
