#include "learn/chain/chain_windows.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "learn/fidelity/fidelity_stretch.hpp"

namespace wisp::chain {
namespace {

constexpr std::size_t kTiltColumn = 3;  // of poses
constexpr double kUnseenTilt = 3.5e-3;  // rad, 0.2°: no eye sees less, so that much noise is on every figure of it
constexpr double kMinSpeed = 0.05;      // m/s: slower than this, a thing has no heading to change

void add_row(const Motion& motion, const MotionPiece& piece, std::size_t row, double segment_seconds,
             std::vector<double>& out) {
  const Triple& v = piece.velocity[row];
  out.push_back(-v[2]);
  out.push_back(std::hypot(v[0], v[1]));
  if (motion.has_orientation) {
    out.push_back(std::abs(piece.spin[row][2]));
    const Triple normal = in_world_axes(piece.orientation[row], {0, 0, 1});
    out.push_back(std::acos(std::clamp(normal[2], -1.0, 1.0)));
    out.push_back(length_of(piece.spin[row]));
  } else {
    const Triple& next = piece.velocity[std::min(row + 1, piece.rows() - 1)];
    const double speed = v[0] * v[0] + v[1] * v[1];
    const double across = v[0] * next[1] - v[1] * next[0];
    out.push_back(std::abs(across) * motion.rate_hz / std::max(speed, kMinSpeed * kMinSpeed));
  }
  out.push_back(segment_seconds);
}

// Mean, standard deviation, least and most of one column over some rows.
void add_figures(const MotionSeries& series, std::size_t first, std::size_t rows, std::size_t column,
                 std::vector<double>& out) {
  double sum = 0, square = 0, least = 0, most = 0;
  for (std::size_t row = first; row < first + rows; ++row) {
    const double x = series.values[row * series.columns + column];
    sum += x;
    square += x * x;
    least = row == first ? x : std::min(least, x);
    most = row == first ? x : std::max(most, x);
  }
  const double mean = sum / static_cast<double>(rows);
  const double variance = std::max(0.0, square / static_cast<double>(rows) - mean * mean);
  out.insert(out.end(), {mean, std::sqrt(variance), least, most});
}

}  // namespace

std::vector<MotionSeries> motion_series(const Motion& motion, std::span<const Segment> segments) {
  std::vector<MotionSeries> series(motion.pieces.size());
  for (const Segment& segment : segments) {
    MotionSeries& own = series[segment.piece];
    own.columns = motion.has_orientation ? 6 : 4;
    const double seconds = (segment.end - segment.begin) / motion.rate_hz;
    const auto end = static_cast<std::size_t>(std::ceil(segment.end));
    for (auto row = static_cast<std::size_t>(std::ceil(segment.begin)); row < end; ++row) {
      add_row(motion, motion.pieces[segment.piece], row, seconds, own.values);
    }
  }
  return series;
}

FeatureWindows series_windows(std::span<const MotionSeries> series, std::size_t rows) {
  FeatureWindows windows;
  std::mt19937_64 random(rows);
  std::size_t block = 0;
  for (const MotionSeries& own : series) {
    if (own.rows() < rows) continue;
    for (std::size_t first = 0; first + rows <= own.rows(); first += rows) {
      for (std::size_t column = 0; column < own.columns; ++column) {
        add_figures(own, first, rows, column, windows.values);
        if (own.columns != 6 || column != kTiltColumn) continue;
        for (std::size_t k = windows.values.size() - 4; k < windows.values.size(); ++k) {
          windows.values[k] += kUnseenTilt * (2 * (static_cast<double>(random() >> 11) * 0x1p-53) - 1);
        }
      }
      windows.features = 4 * own.columns;
      windows.blocks.push_back(block);
    }
    ++block;
  }
  return windows;
}

std::vector<MotionSeries> shuffled(std::span<const MotionSeries> series, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<MotionSeries> out;
  for (const MotionSeries& own : series) {
    std::vector<std::size_t> order(own.rows());
    std::iota(order.begin(), order.end(), 0U);
    shuffle(std::span(order), random);
    MotionSeries mixed{own.columns, {}};
    for (std::size_t row : order) {
      const auto first = own.values.begin() + static_cast<long>(row * own.columns);
      mixed.values.insert(mixed.values.end(), first, first + static_cast<long>(own.columns));
    }
    out.push_back(std::move(mixed));
  }
  return out;
}

}  // namespace wisp::chain
