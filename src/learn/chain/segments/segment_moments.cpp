#include "learn/chain/segments/segment_moments.hpp"

#include <algorithm>
#include <cmath>

#include "learn/chain/segments/segment_traits.hpp"

namespace wisp::chain {
namespace {

// Attitude counts as much as velocity and spin together: a jump of attitude is what the eye sees first.
constexpr double kAttitudeWeight = 1.5;

// Differences of velocity and attitude fade within a join; one of height takes as long as it takes to go there.
constexpr double kHeightWeight = 3;

// Without attitude, how velocity changes says how the body lies in the air, and to which side it turns. Where speed
// over ground is least, a fall that turns back differs in nothing else from one that goes on.
JoinMoment moment_without_attitude(const MotionPiece& from, double row, bool heading_free) {
  const double before = std::max(0.0, row - 1), after = std::min(static_cast<double>(from.rows() - 1), row + 1);
  Triple velocity = at_row(from.velocity, row), change = at_row(from.velocity, after);
  const Triple earlier = at_row(from.velocity, before);
  for (std::size_t axis = 0; axis < 3; ++axis) change[axis] = (change[axis] - earlier[axis]) / (after - before);
  if (heading_free) {
    const double heading = std::atan2(velocity[1], velocity[0]);
    velocity = turned_about_z(velocity, -heading);
    change = turned_about_z(change, -heading);
  }
  return {velocity[0], velocity[1], velocity[2], change[0], change[1], change[2]};
}

// What must agree at a join, as numbers of one length.
JoinMoment moment_of(const Motion& motion, std::size_t piece, double row, bool heading_free) {
  const MotionPiece& from = motion.pieces[piece];
  if (!motion.has_orientation) return moment_without_attitude(from, row, heading_free);
  const Triple velocity = at_row(from.velocity, row);
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

// Bodies that are of several kinds each go on as they are: positions alone do not say which is which at a join.
void add_traits(const Motion& motion, std::span<const Segment> segments, SegmentMoments& moments) {
  const auto traits = segment_traits(motion, segments);
  for (std::size_t k = 0; k < traits.size(); ++k) {
    for (auto* moment : {&moments.starts[k], &moments.ends[k]}) {
      moment->insert(moment->end(), traits[k].begin(), traits[k].end());
    }
  }
}

// What is bounded is played where it was: a segment is to begin about as high as the one before it ends.
void add_heights(const Motion& motion, std::span<const Segment> segments, SegmentMoments& moments) {
  std::vector<double> starts, ends;
  double sum = 0, square = 0;
  for (const Segment& one : segments) {
    const auto& position = motion.pieces[one.piece].position;
    starts.push_back(at_row(position, one.begin)[2]);
    ends.push_back(at_row(position, one.end)[2]);
    sum += starts.back();
    square += starts.back() * starts.back();
  }
  const auto count = static_cast<double>(segments.size());
  const double variance = square / count - sum / count * (sum / count);
  const double unit = variance > 0 ? kHeightWeight / std::sqrt(variance) : 1;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    moments.starts[k].push_back(unit * starts[k]);
    moments.ends[k].push_back(unit * ends[k]);
  }
}

}  // namespace

SegmentMoments segment_moments(const Motion& motion, std::span<const Segment> segments, bool heading_free,
                               bool bounded_height) {
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
  if (!motion.has_orientation) add_traits(motion, segments, moments);
  if (bounded_height) add_heights(motion, segments, moments);
  return moments;
}

double distance_of(const JoinMoment& a, const JoinMoment& b) {
  double distance = 0;
  for (std::size_t k = 0; k < a.size(); ++k) distance += (a[k] - b[k]) * (a[k] - b[k]);
  return distance;
}

}  // namespace wisp::chain
