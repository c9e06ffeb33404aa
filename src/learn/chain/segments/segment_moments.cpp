#include "learn/chain/segments/segment_moments.hpp"

#include <algorithm>
#include <cmath>

namespace wisp::chain {
namespace {

// Attitude counts as much as velocity and spin together: a jump of attitude is what the eye sees first.
constexpr double kAttitudeWeight = 1.5;

// What must agree at a join, as numbers of one length.
JoinMoment moment_of(const Motion& motion, std::size_t piece, double row, bool heading_free) {
  const MotionPiece& from = motion.pieces[piece];
  const Triple velocity = at_row(from.velocity, row);
  if (!motion.has_orientation) {
    if (heading_free) return {std::hypot(velocity[0], velocity[1]), velocity[2]};
    return {velocity.begin(), velocity.end()};
  }
  const Quad q = at_row(from.orientation, row);
  const Triple spin = at_row(from.spin, row);
  JoinMoment moment;
  const auto add = [&](const Triple& vector) { moment.insert(moment.end(), vector.begin(), vector.end()); };
  if (heading_free) {
    add(in_body_axes(q, velocity));
    add(in_body_axes(q, spin));
    add(in_body_axes(q, {0, 0, 1}));
  } else {
    add(velocity);
    add(spin);
    for (const Triple& axis : {Triple{1, 0, 0}, Triple{0, 1, 0}, Triple{0, 0, 1}}) add(in_world_axes(q, axis));
  }
  return moment;
}

// The inverse standard deviation of each group of three, so that axes keep their proportions.
std::vector<double> weights_of(const std::vector<JoinMoment>& moments, bool attitude) {
  const std::size_t size = moments.front().size();
  std::vector<double> weight(size, 1.0);
  for (std::size_t group = 0; group < size; group += 3) {
    const std::size_t end = std::min(size, group + 3);
    double spread = 0;
    for (std::size_t k = group; k < end; ++k) {
      double mean = 0, square = 0;
      for (const auto& moment : moments) mean += moment[k];
      mean /= static_cast<double>(moments.size());
      for (const auto& moment : moments) square += (moment[k] - mean) * (moment[k] - mean);
      spread += square / static_cast<double>(moments.size());
    }
    const double unit = spread > 0 ? 1 / std::sqrt(spread) : 1;
    for (std::size_t k = group; k < end; ++k) weight[k] = attitude && group >= 6 ? kAttitudeWeight * unit : unit;
  }
  return weight;
}

}  // namespace

SegmentMoments segment_moments(const Motion& motion, std::span<const Segment> segments, bool heading_free) {
  SegmentMoments moments;
  for (const Segment& segment : segments) {
    moments.starts.push_back(moment_of(motion, segment.piece, segment.begin, heading_free));
    moments.ends.push_back(moment_of(motion, segment.piece, segment.end, heading_free));
  }
  const auto weight = weights_of(moments.starts, motion.has_orientation);
  for (auto* all : {&moments.starts, &moments.ends}) {
    for (JoinMoment& moment : *all) {
      for (std::size_t k = 0; k < weight.size(); ++k) moment[k] *= weight[k];
    }
  }
  return moments;
}

double distance_of(const JoinMoment& a, const JoinMoment& b) {
  double distance = 0;
  for (std::size_t k = 0; k < a.size(); ++k) distance += (a[k] - b[k]) * (a[k] - b[k]);
  return distance;
}

}  // namespace wisp::chain
