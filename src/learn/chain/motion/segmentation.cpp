#include "learn/chain/motion/segmentation.hpp"

#include <algorithm>
#include <cmath>

namespace wisp::chain {
namespace {

constexpr std::size_t kParts = 16;  // number of short windows in the longest stretch; a long window is four of them
constexpr double kMinSegments = 8;  // minimum per long window: a slow random walk shows only over that many
// Maximum ratio of the long windows' variance to the short windows'. In simulations, 1 in 100 random walks has less,
// and none of 300 processes that return to their mean within 1/90 of the recording has more.
constexpr double kMaxGrowth = 1.7;

// Mean variance of heights within adjacent windows of `rows` rows.
double spread_within(const Motion& motion, std::size_t rows) {
  double variance = 0, windows = 0;
  for (const MotionPiece& piece : motion.pieces) {
    for (std::size_t begin = 0; begin + rows <= piece.rows(); begin += rows, ++windows) {
      double sum = 0, square = 0;
      for (std::size_t row = begin; row < begin + rows; ++row) {
        const double z = piece.position[row][2] - piece.position[begin][2];
        sum += z;
        square += z * z;
      }
      const auto count = static_cast<double>(rows);
      variance += square / count - sum / count * (sum / count);
    }
  }
  return variance / windows;
}

Result<std::vector<double>> signal_of(const Motion& motion, const MotionPiece& piece,
                                      std::span<const Recording> recordings, const std::string& name) {
  std::vector<double> signal;
  if (name == "speed") {
    for (const Triple& v : piece.velocity) signal.push_back(length_of(v));
  } else if (name == "horizontal_speed") {
    for (const Triple& v : piece.velocity) signal.push_back(std::hypot(v[0], v[1]));
  } else if (name == "forward_speed") {
    if (!motion.has_orientation) {
      return Error{recordings[piece.recording].source +
                   ": has no orientation, which the event's forward_speed needs: use min:horizontal_speed"};
    }
    for (std::size_t row = 0; row < piece.rows(); ++row) {
      signal.push_back(in_body_axes(piece.orientation[row], piece.velocity[row])[1]);
    }
  } else {
    const Recording& recording = recordings[piece.recording];
    const auto channel = find_channel(recording, name);
    if (!channel) {
      return Error{recording.source + ": has no channel " + name +
                   " for the event, expected a channel's name, speed, horizontal_speed or forward_speed"};
    }
    const auto& samples = recording.channels[*channel].samples;
    const auto first = samples.begin() + static_cast<long>(piece.first_row);
    signal.assign(first, first + static_cast<long>(piece.rows()));
    if (std::any_of(signal.begin(), signal.end(), [](double x) { return std::isnan(x); })) {
      return Error{recording.source + ": channel " + name + " of the event has missing samples"};
    }
  }
  return signal;
}

// Zero crossings between excursions beyond ±margin on both sides, each at its last change of sign.
std::vector<double> zeros_of(std::span<const double> signal, double margin) {
  std::vector<double> found;
  int side = 0;
  double change = -1;
  for (std::size_t row = 0; row < signal.size(); ++row) {
    const double now = signal[row];
    if (row > 0 && ((signal[row - 1] < 0) != (now < 0))) {
      change = static_cast<double>(row - 1) + signal[row - 1] / (signal[row - 1] - now);
    }
    if (std::abs(now) < margin || now == 0) continue;
    const int beyond = now > 0 ? 1 : -1;
    if (side != 0 && beyond != side) found.push_back(change);
    side = beyond;
  }
  return found;
}

// Row of the vertex of the parabola through three samples.
double vertex(std::span<const double> signal, std::size_t row) {
  if (row == 0 || row + 1 == signal.size()) return static_cast<double>(row);
  const double before = signal[row - 1], at = signal[row], after = signal[row + 1];
  const double curve = before - 2 * at + after;
  const double shift = curve == 0 ? 0 : (before - after) / (2 * curve);
  return static_cast<double>(row) + std::clamp(shift, -0.5, 0.5);
}

// Minima with a fall before and a rise after of at least `margin`.
std::vector<double> minima_of(std::span<const double> signal, double margin) {
  std::vector<double> found;
  bool falling = false;
  std::size_t lowest = 0;
  double highest = signal[0];
  for (std::size_t row = 1; row < signal.size(); ++row) {
    if (falling) {
      if (signal[row] < signal[lowest]) lowest = row;
      if (signal[row] > signal[lowest] && signal[row] >= signal[lowest] + margin) {
        found.push_back(vertex(signal, lowest));
        falling = false;
        highest = signal[row];
      }
    } else {
      highest = std::max(highest, signal[row]);
      if (signal[row] < highest && signal[row] <= highest - margin) {
        falling = true;
        lowest = row;
      }
    }
  }
  return found;
}

double deviation_of(std::span<const std::vector<double>> signals) {
  double sum = 0, squares = 0, count = 0;
  for (const auto& signal : signals) {
    for (double x : signal) {
      sum += x;
      squares += x * x;
      ++count;
    }
  }
  return std::sqrt(std::max(0.0, squares / count - sum / count * sum / count));
}

// Appends the segments between events. Their durations are rounded to whole rows so that the total stays the same.
void add_segments(std::size_t piece, const std::vector<double>& events, std::vector<Segment>& segments) {
  for (std::size_t k = 0; k + 1 < events.size(); ++k) {
    const auto begin = static_cast<int>(std::lround(events[k])), end = static_cast<int>(std::lround(events[k + 1]));
    segments.push_back({piece, events[k], events[k + 1], std::max(1, end - begin)});
  }
}

}  // namespace

bool height_is_bounded(const Motion& motion, std::span<const Segment> segments) {
  double steps = 0;
  for (const Segment& one : segments) steps += one.steps;
  std::size_t longest = 0;
  for (const MotionPiece& piece : motion.pieces) longest = std::max(longest, piece.rows());
  const std::size_t window = longest / kParts;
  if (4.0 * static_cast<double>(window) * static_cast<double>(segments.size()) < kMinSegments * steps) return false;
  return spread_within(motion, 4 * window) < kMaxGrowth * spread_within(motion, window);
}

std::vector<double> event_rows(std::span<const double> signal, double rate_hz, double deviation,
                               const SegmentationOptions& options) {
  if (signal.size() < 3) return {};
  const double margin = options.debounce * deviation;
  std::vector<double> turned(signal.begin(), signal.end());
  if (options.event.kind == EventKind::kMaximum) {
    for (double& x : turned) x = -x;
  }
  const auto all = options.event.kind == EventKind::kZero ? zeros_of(turned, margin) : minima_of(turned, margin);
  std::vector<double> kept;
  for (double row : all) {
    if (kept.empty() || row - kept.back() >= options.min_seconds * rate_hz) kept.push_back(row);
  }
  return kept;
}

Result<Segmentation> segment(const Motion& motion, std::span<const Recording> recordings,
                             const SegmentationOptions& options) {
  if (!(options.min_seconds >= 0) || !(options.debounce >= 0)) {
    return Error{"the shortest segment and the debouncing of events are expected not to be negative"};
  }
  std::vector<std::vector<double>> signals;
  for (const MotionPiece& piece : motion.pieces) {
    auto signal = signal_of(motion, piece, recordings, options.event.signal);
    if (!signal) return signal.error();
    signals.push_back(std::move(*signal));
  }
  const double deviation = deviation_of(signals);
  Segmentation out;
  for (std::size_t k = 0; k < signals.size(); ++k) {
    const auto events = event_rows(signals[k], motion.rate_hz, deviation, options);
    if (events.size() < 2) ++out.pieces_without;
    add_segments(k, events, out.segments);
  }
  if (out.segments.empty()) {
    return Error{recordings.front().source + ": has no two events of " + options.event.signal +
                 " in one stretch, so no segment: choose another event, or record for longer"};
  }
  if (out.pieces_without > 0) {
    out.warnings.push_back(std::to_string(out.pieces_without) + " of " + std::to_string(signals.size()) +
                           " stretches have fewer than two events and were left out");
  }
  return out;
}

}  // namespace wisp::chain
