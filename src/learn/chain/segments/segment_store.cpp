#include "learn/chain/segments/modes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wisp::chain {
namespace {

// ---- Choice of the best-joining successors ----

// Attitude has more weight than velocity or spin: the eye sees a jump of attitude first.
constexpr double kAttitudeWeight = 1.5;

// Weight of height, above all others: play moves the body to make up for a step in height, but blends other steps.
constexpr double kHeightWeight = 3;

// States of a body at the ends of segments, in groups of three numbers. With orientation: velocity, angular velocity
// and attitude ("up" in body axes where heading is free, else the body's three axes in the world). Without: velocity
// and its change. A bounded height adds a group.
struct Moments {
  std::vector<double> weight;  // per group
  std::vector<double> values;  // moments × size
  std::size_t size() const { return 3 * weight.size(); }
  const double* at(std::size_t k) const { return values.data() + k * size(); }
};

void add_moment(const MotionPiece& from, double row, const SegmentStoreOptions& options, Moments& out) {
  const bool fresh = out.values.empty();
  const auto add = [&](const Triple& vector, double weight) {
    out.values.insert(out.values.end(), vector.begin(), vector.end());
    if (fresh) out.weight.push_back(weight);
  };
  const Triple velocity = at_row(from.velocity, row);
  if (from.orientation.empty()) {
    const double heading = options.heading_free ? std::atan2(velocity[1], velocity[0]) : 0;
    const Triple before = at_row(from.velocity, row - 1), after = at_row(from.velocity, row + 1);
    add(turned_about_z(velocity, -heading), 1);
    add(turned_about_z(Triple{after[0] - before[0], after[1] - before[1], after[2] - before[2]}, -heading), 1);
  } else {
    const Triple spin = at_row(from.spin, row);
    const Quad q = at_row(from.orientation, row);
    add(options.heading_free ? in_body_axes(q, velocity) : velocity, 1);
    add(options.heading_free ? in_body_axes(q, spin) : spin, 1);
    if (options.heading_free) add(in_body_axes(q, {0, 0, 1}), kAttitudeWeight);
    for (const Triple& axis : {Triple{1, 0, 0}, Triple{0, 1, 0}, Triple{0, 0, 1}}) {
      if (!options.heading_free) add(in_world_axes(q, axis), kAttitudeWeight);
    }
  }
  if (options.bounded_height) add({at_row(from.position, row)[2], 0, 0}, kHeightWeight);
}

// Weight of each number: its group's weight divided by the group's standard deviation, so that the axes of a group keep
// their proportions.
std::vector<double> weights_of(const Moments& moments) {
  const std::size_t count = moments.values.size() / moments.size();
  std::vector<double> weight;
  for (std::size_t group = 0; group < moments.weight.size(); ++group) {
    double spread = 0;
    for (std::size_t k = 3 * group; k < 3 * group + 3; ++k) {
      double mean = 0, square = 0;
      for (std::size_t row = 0; row < count; ++row) mean += moments.at(row)[k];
      mean /= static_cast<double>(count);
      for (std::size_t row = 0; row < count; ++row) square += std::pow(moments.at(row)[k] - mean, 2);
      spread += square / static_cast<double>(count);
    }
    weight.insert(weight.end(), 3, moments.weight[group] * (spread > 0 ? 1 / std::sqrt(spread) : 1));
  }
  return weight;
}

void scale(Moments& moments, const std::vector<double>& weight) {
  for (std::size_t k = 0; k < moments.values.size(); ++k) moments.values[k] *= weight[k % weight.size()];
}

double distance_of(const double* a, const double* b, std::size_t size) {
  double distance = 0;
  for (std::size_t k = 0; k < size; ++k) distance += (a[k] - b[k]) * (a[k] - b[k]);
  return distance;
}

std::vector<std::uint16_t> best_successors(const SortedSegments& from_all, const SegmentStoreOptions& options) {
  const auto& [motion, segments, mode, modes] = from_all;
  Moments starts, ends;
  for (const Segment& segment : segments) {
    add_moment(motion.pieces[segment.piece], segment.begin, options, starts);
    add_moment(motion.pieces[segment.piece], segment.end, options, ends);
  }
  const auto weight = weights_of(starts);
  scale(starts, weight);
  scale(ends, weight);
  std::vector<std::uint16_t> follow;
  std::vector<std::pair<double, std::uint16_t>> near;  // reused buffer: a list per segment would need quadratic memory
  for (std::size_t from = 0; from < segments.size(); ++from) {
    for (std::size_t begin = 0, end = 0; begin < segments.size(); begin = end) {
      near.clear();
      for (end = begin; end < segments.size() && mode[end] == mode[begin]; ++end) {
        if (end == from) continue;
        near.emplace_back(distance_of(ends.at(from), starts.at(end), starts.size()), static_cast<std::uint16_t>(end));
      }
      if (near.empty()) near.emplace_back(0.0, static_cast<std::uint16_t>(from));
      const std::size_t count = std::min(near.size(), static_cast<std::size_t>(options.breadth));
      std::partial_sort(near.begin(), near.begin() + static_cast<long>(count), near.end());
      for (std::size_t k = 0; k < static_cast<std::size_t>(options.breadth); ++k)
        follow.push_back(near[k % count].second);
    }
  }
  return follow;
}

constexpr double kMaxStored = 32767;
constexpr double kRowShare = 0.005;        // quantum of positions as a share of a usual step: 0.1 mm for a leaf
constexpr double kRateShare = 0.002;       // quantum of rates as a share of the usual rate
constexpr double kTurnScale = 1.0 / 4096;  // quantum of quaternion components: rounds an orientation by 0.03° at most

double largest(double so_far, const Triple& vector) {
  for (double x : vector) so_far = std::max(so_far, std::abs(x));
  return so_far;
}

// Quantum for 16-bit numbers up to `most`, at least `usual`.
double scale_for(double most, double usual) {
  return std::max(usual, most / kMaxStored) + (most > 0 ? 0 : 1.0 / kMaxStored);
}

template <std::size_t kSize>
void put(const std::array<double, kSize>& values, double scale, std::vector<std::int16_t>& out) {
  for (double x : values) {
    out.push_back(static_cast<std::int16_t>(std::lround(std::clamp(x / scale, -kMaxStored, kMaxStored))));
  }
}

// Root-mean-square speed and angular speed.
std::pair<double, double> usual_rates(const Motion& motion) {
  double speed = 0, spin = 0, rows = 0;
  for (const MotionPiece& piece : motion.pieces) {
    for (const Triple& v : piece.velocity) speed += dot(v, v);
    for (const Triple& w : piece.spin) spin += dot(w, w);
    rows += static_cast<double>(piece.rows());
  }
  return {std::sqrt(speed / rows), std::sqrt(spin / rows)};
}

// Approximate bytes per number and per successor in a file, packed by model/chain_rows.hpp.
constexpr double kNumberBytes = 0.97;
constexpr double kSuccessorBytes = 1.6;

double bytes_of(const Segment& segment, bool pose, double successors) {
  const double channels = pose ? 7 : 3, rates = pose ? 12 : 6;
  return kNumberBytes * ((segment.steps + 1.0) * channels + rates) + 4 + successors;
}

// Returns the largest number of segments per mode with at most `most` in all; smaller modes leave room to others.
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

// Segments aligned to whole rows of their recording. Playing from event to event would need their time stretched to
// whole steps, by up to a quarter for short ones, and stretching changes the speed at joins.
std::vector<Segment> on_rows(const Motion& motion, std::span<const Segment> segments) {
  std::vector<Segment> out(segments.begin(), segments.end());
  for (Segment& one : out) {
    const auto last = static_cast<double>(motion.pieces[one.piece].rows() - 1);
    one.begin = std::min(std::round(one.begin), last - one.steps);
    one.end = one.begin + one.steps;
  }
  return out;
}

// Extremes of a segment: least vertical velocity, largest speed over ground, and sum of the angular speeds of its rows.
std::array<double, 3> extremes_of(const Motion& motion, const Segment& segment) {
  const MotionPiece& piece = motion.pieces[segment.piece];
  const auto first = static_cast<std::size_t>(segment.begin), last = static_cast<std::size_t>(segment.end);
  std::array<double, 3> out{};
  for (std::size_t row = first; row <= last; ++row) {
    const Triple& v = piece.velocity[row];
    out[0] = row == first ? v[2] : std::min(out[0], v[2]);
    out[1] = std::max(out[1], std::hypot(v[0], v[1]));
    if (motion.has_orientation) out[2] += length_of(piece.spin[row]);
  }
  return out;
}

// Orders segments so that neighbours are similar: recursive halving by one extreme after another.
void order_alike(std::span<std::size_t> members, const std::vector<std::array<double, 3>>& extremes, std::size_t by) {
  if (members.size() < 2) return;
  const auto middle = members.begin() + static_cast<long>(members.size() / 2);
  std::nth_element(members.begin(), middle, members.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(extremes[a][by], a) < std::pair(extremes[b][by], b);
  });
  const std::size_t half = members.size() / 2, next = (by + 1) % extremes[0].size();
  order_alike(members.first(half), extremes, next);
  order_alike(members.subspan(half), extremes, next);
}

// `count` of the members, equally spaced.
std::vector<std::size_t> thinned(const std::vector<std::size_t>& members, std::size_t count) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < count; ++k) out.push_back(members[(2 * k + 1) * members.size() / (2 * count)]);
  return out;
}

// Indices of the segments to store, by mode and in recording order. Where not all fit, a stratified sample that
// preserves the distribution of dives, speeds and turns.
std::vector<std::size_t> kept_segments(const SortedSegments& from, const SegmentStoreOptions& options) {
  const std::span segments = from.segments;
  std::vector<std::vector<std::size_t>> members(static_cast<std::size_t>(from.modes));
  double bytes = 0;
  const double successors = kSuccessorBytes * options.breadth * from.modes + 6;  // 6 bytes of ChainDrift::lead
  for (std::size_t k = 0; k < segments.size(); ++k) {
    members[from.mode[k]].push_back(k);
    bytes += bytes_of(segments[k], from.motion.has_orientation, successors);
  }
  const double share = std::min(1.0, static_cast<double>(options.max_bytes) / bytes);
  const auto room = static_cast<std::size_t>(share * static_cast<double>(segments.size()));
  const std::size_t cap = cap_of(members, std::clamp<std::size_t>(room, 1, kMaxSegments - members.size()));
  std::vector<std::array<double, 3>> extremes;
  for (const Segment& one : segments) extremes.push_back(extremes_of(from.motion, one));
  std::vector<std::size_t> kept;
  for (auto& mode : members) {
    order_alike(mode, extremes, 0);
    mode = thinned(mode, std::min(mode.size(), cap));
    std::sort(mode.begin(), mode.end());
    kept.insert(kept.end(), mode.begin(), mode.end());
  }
  return kept;
}

void put_heights(const Motion& motion, std::span<const Segment> segments, SegmentStore& store) {
  std::vector<double> heights;
  for (std::size_t source : store.source) {
    const Segment& one = segments[source];
    heights.push_back(at_row(motion.pieces[one.piece].position, one.begin)[2]);
  }
  double highest = 0;
  for (double height : heights) highest = std::max(highest, std::abs(height));
  ChainSegments& out = store.segments;
  out.height_scale = scale_for(highest, out.row_scale[0]);
  for (double height : heights) put<1>({height}, out.height_scale, out.height);
}

}  // namespace

SegmentStore store_segments(const SortedSegments& found, const SegmentStoreOptions& options) {
  const Motion& motion = found.motion;
  const std::vector<Segment> segments = on_rows(motion, found.segments);
  SegmentStore store;
  store.source = kept_segments({motion, segments, found.mode, found.modes}, options);
  std::vector<MotionPiece> pieces;
  double farthest = 0, fastest = 0, quickest = 0;
  const auto [speed, spin_speed] = usual_rates(motion);
  for (std::size_t source : store.source) {
    pieces.push_back(cut_out(motion, segments[source], options.heading_free));
    for (const Triple& at : pieces.back().position) farthest = largest(farthest, at);
    for (const std::size_t row : {std::size_t{0}, pieces.back().rows() - 1}) {
      fastest = largest(fastest, pieces.back().velocity[row]);
      if (motion.has_orientation) quickest = largest(quickest, pieces.back().spin[row]);
    }
  }
  ChainSegments& out = store.segments;
  out.row_scale = {scale_for(farthest, kRowShare * speed / motion.rate_hz)};
  out.rate_scale = {scale_for(fastest, kRateShare * speed)};
  if (motion.has_orientation) {
    out.row_scale.push_back(kTurnScale);
    out.rate_scale.push_back(scale_for(quickest, kRateShare * spin_speed));
  }
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    out.mode.push_back(found.mode[store.source[k]]);
    out.steps.push_back(static_cast<std::uint16_t>(segments[store.source[k]].steps));
    for (std::size_t row = 0; row < pieces[k].rows(); ++row) {
      put(pieces[k].position[row], out.row_scale[0], out.rows);
      if (motion.has_orientation) put(pieces[k].orientation[row], out.row_scale[1], out.rows);
    }
    for (const std::size_t end : {std::size_t{0}, pieces[k].rows() - 1}) {
      put(pieces[k].velocity[end], out.rate_scale[0], out.rates);
      if (motion.has_orientation) put(pieces[k].spin[end], out.rate_scale[1], out.rates);
    }
  }
  if (options.bounded_height) put_heights(motion, segments, store);
  out.breadth = options.breadth;
  if (options.breadth > 0) {
    std::vector<Segment> kept;
    for (std::size_t source : store.source) kept.push_back(segments[source]);
    out.follow = best_successors({motion, kept, out.mode, found.modes}, options);
  }
  return store;
}

}  // namespace wisp::chain
