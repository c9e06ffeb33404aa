#include "learn/chain/segments/joins.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace wisp::chain {
namespace {

// Attitude counts as much as velocity and spin together: a jump of attitude is what the eye sees first.
constexpr double kAttitudeWeight = 1.5;

// Differences of velocity and attitude fade within a join; one of height takes as long as it takes to go there.
constexpr double kHeightWeight = 3;

// How a body moves at one moment, in groups of three numbers: velocity, angular velocity and attitude ("up" in the
// body's axes, or the body's three axes in the world); without orientation velocity and its change. Where height is
// bounded, that too.
struct Moments {
  std::vector<double> weight;  // per group
  std::vector<double> values;  // moments × size
  std::size_t size() const { return 3 * weight.size(); }
  const double* at(std::size_t k) const { return values.data() + k * size(); }
};

void add_moment(const MotionPiece& from, double row, const JoinOptions& options, Moments& out) {
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

// The weight of each number: that of its group over the group's standard deviation, so that axes keep their
// proportions.
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

}  // namespace

std::vector<std::uint16_t> best_successors(const Motion& motion, std::span<const Segment> segments,
                                           std::span<const std::uint16_t> mode, const JoinOptions& options) {
  Moments starts, ends;
  for (const Segment& segment : segments) {
    add_moment(motion.pieces[segment.piece], segment.begin, options, starts);
    add_moment(motion.pieces[segment.piece], segment.end, options, ends);
  }
  const auto weight = weights_of(starts);
  scale(starts, weight);
  scale(ends, weight);
  std::vector<std::uint16_t> follow;
  std::vector<std::pair<double, std::uint16_t>> near;  // one buffer for all: a list a segment would be its square
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

}  // namespace wisp::chain
