#include "learn/chain/segments/segment_features.hpp"

#include <algorithm>
#include <cmath>

namespace wisp::chain {
namespace {

constexpr double kNoLength = 1e-9;  // metres: a line shorter than this has no direction

Triple line_of(const MotionPiece& piece, const Segment& segment) {
  const Triple from = at_row(piece.position, segment.begin), to = at_row(piece.position, segment.end);
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}

void add_features(const MotionPiece& piece, const Segment& segment, double heading, std::vector<double>& out) {
  const auto add = [&](const Triple& vector) {
    for (double x : turned_about_z(vector, -heading)) out.push_back(x);
  };
  for (double end : {segment.begin, segment.end}) add(at_row(piece.velocity, end));
  const Triple line = line_of(piece, segment);
  const double length = length_of(line);
  const double share = length > kNoLength ? 1 / length : 0;
  out.push_back(length);
  add({line[0] * share, line[1] * share, line[2] * share});
}

void standardise(FeatureTable& table) {
  const std::size_t rows = table.rows();
  for (std::size_t k = 0; k < table.features; ++k) {
    double mean = 0, square = 0;
    for (std::size_t row = 0; row < rows; ++row) mean += table.values[row * table.features + k];
    mean /= static_cast<double>(rows);
    for (std::size_t row = 0; row < rows; ++row) {
      double& value = table.values[row * table.features + k];
      value -= mean;
      square += value * value;
    }
    const double deviation = std::sqrt(square / static_cast<double>(rows));
    for (std::size_t row = 0; row < rows; ++row) {
      double& value = table.values[row * table.features + k];
      value = deviation > 1e-12 * (1 + std::abs(mean)) ? value / deviation : 0;
    }
  }
}

}  // namespace

double heading_of(const Motion& motion, const Segment& segment) {
  const Triple line = line_of(motion.pieces[segment.piece], segment);
  return std::hypot(line[0], line[1]) > kNoLength ? std::atan2(line[1], line[0]) : 0.0;
}

MotionPiece cut_out(const Motion& motion, const Segment& segment, bool heading_free) {
  const MotionPiece& from = motion.pieces[segment.piece];
  const double heading = heading_free ? heading_of(motion, segment) : 0;
  const auto last = static_cast<double>(from.rows() - 1);
  const double begin = std::min(std::round(segment.begin), last - segment.steps);
  const Triple origin = at_row(from.position, begin);
  MotionPiece piece;
  for (int step = 0; step <= segment.steps; ++step) {
    const double row = begin + step;
    const Triple at = at_row(from.position, row);
    piece.position.push_back(turned_about_z(Triple{at[0] - origin[0], at[1] - origin[1], at[2] - origin[2]}, -heading));
    piece.velocity.push_back(turned_about_z(at_row(from.velocity, row), -heading));
    if (!motion.has_orientation) continue;
    piece.orientation.push_back(turned_about_z(at_row(from.orientation, row), -heading));
    piece.spin.push_back(turned_about_z(at_row(from.spin, row), -heading));
  }
  return piece;
}

FeatureTable segment_features(const Motion& motion, std::span<const Segment> segments, bool heading_free) {
  FeatureTable table;
  for (const Segment& segment : segments) {
    add_features(motion.pieces[segment.piece], segment, heading_free ? heading_of(motion, segment) : 0, table.values);
  }
  if (segments.empty()) return table;
  table.features = table.values.size() / segments.size();
  standardise(table);
  return table;
}

}  // namespace wisp::chain
