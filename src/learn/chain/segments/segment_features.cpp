#include "learn/chain/segments/segment_features.hpp"

#include <cmath>
#include <string>

namespace wisp::chain {
namespace {

constexpr double kNoLength = 1e-9;  // metres: a line shorter than this has no direction

class Row {
 public:
  Row(std::vector<double>& values, double heading) : values_(values), heading_(heading) {}
  void add(double value) { values_.push_back(value); }
  void add(const Triple& vector) {
    for (double x : turned_about_z(vector, -heading_)) values_.push_back(x);
  }

 private:
  std::vector<double>& values_;
  double heading_;
};

Triple line_of(const MotionPiece& piece, const Segment& segment) {
  const Triple from = at_row(piece.position, segment.begin), to = at_row(piece.position, segment.end);
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}

void add_line(const Triple& line, const FeatureChoice& choice, Row& row) {
  const double length = std::sqrt(line[0] * line[0] + line[1] * line[1] + line[2] * line[2]);
  if (choice.length) row.add(length);
  if (!choice.direction) return;
  const double share = length > kNoLength ? 1 / length : 0;
  row.add({line[0] * share, line[1] * share, line[2] * share});
}

void add_features(const Motion& motion, const Segment& segment, const FeatureChoice& choice, std::vector<double>& out) {
  const MotionPiece& piece = motion.pieces[segment.piece];
  Row row(out, choice.heading_free ? heading_of(motion, segment) : 0);
  for (double end : {segment.begin, segment.end}) {
    if (choice.velocity) row.add(at_row(piece.velocity, end));
    if (choice.spin) row.add(at_row(piece.spin, end));
    if (choice.tilt) row.add(in_world_axes(at_row(piece.orientation, end), {0, 0, 1}));
  }
  if (choice.length || choice.direction) add_line(line_of(piece, segment), choice, row);
  if (choice.duration) row.add((segment.end - segment.begin) / motion.rate_hz);
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

Result<FeatureTable> segment_features(const Motion& motion, std::span<const Segment> segments,
                                      const FeatureChoice& choice) {
  if ((choice.spin || choice.tilt) && !motion.has_orientation) {
    return Error{"the features spin and tilt need orientation (q.w, q.x, q.y, q.z), which the recordings have not"};
  }
  if (!choice.velocity && !choice.length && !choice.direction && !choice.spin && !choice.tilt && !choice.duration) {
    return Error{"no feature is chosen, expected at least one of velocity, length, direction, spin, tilt, duration"};
  }
  FeatureTable table;
  for (const Segment& segment : segments) {
    add_features(motion, segment, choice, table.values);
    if (table.features == 0) table.features = table.values.size();
  }
  if (table.features > 0) standardise(table);
  return table;
}

}  // namespace wisp::chain
