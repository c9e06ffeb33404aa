#include "learn/chain/motion/motion.hpp"

#include <algorithm>
#include <optional>

#include "base/statistics.hpp"
#include "record/number_text.hpp"
#include "wisp/learn/chain_recipe.hpp"

namespace wisp::chain {
namespace {

constexpr std::size_t kMinRows = 8;
constexpr double kUsualStep = 0.9;   // quantile of step lengths that counts as usual
constexpr double kMaxJump = 20;      // a step more than this many times the usual and the neighbouring steps is a jump
constexpr double kRounding = 2e-4;   // deviation from unit length that four digits cause; above it, a warning
constexpr double kMaxWrong = 0.01;   // maximum deviation of a quaternion from unit length
constexpr double kMaxJitter = 0.01;  // maximum deviation of a time step, as a share of the step

constexpr const char* kQuaternion[] = {"q.w", "q.x", "q.y", "q.z"};

// Channel indices of a recording's pose.
struct Layout {
  std::array<std::size_t, 3> position{};
  std::optional<std::array<std::size_t, 4>> orientation;
};

Result<Layout> layout_of(const Recording& recording) {
  Layout layout;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto found = find_channel(recording, kPositions[axis]);
    if (!found) {
      return Error{recording.source + ": has no channel " + kPositions[axis] +
                   ", expected a position pos.x, pos.y, pos.z in metres: name its columns so"};
    }
    layout.position[axis] = *found;
  }
  std::array<std::size_t, 4> quaternion{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (const auto found = find_channel(recording, kQuaternion[k])) {
      quaternion[k] = *found;
      ++count;
    }
  }
  if (count == 4) layout.orientation = quaternion;
  if (count != 0 && count != 4) {
    return Error{recording.source + ": has " + std::to_string(count) +
                 " of the channels q.w, q.x, q.y, q.z, expected all four or none"};
  }
  return layout;
}

// Checks that a time channel, where there is one, has equal steps within each episode, on average across missing ones.
Result<void> check_time(const Recording& recording) {
  for (const char* name : kTimeColumns) {
    const auto channel = find_channel(recording, name);
    if (!channel) continue;
    const auto& time = recording.channels[*channel].samples;
    const double step = 1 / recording.rate_hz;
    for (const Episode& episode : episodes(recording)) {
      for (std::size_t last = episode.begin, row = last + 1; row < episode.end; ++row) {
        if (std::isnan(time[row])) continue;
        const double found = (time[row] - time[last]) / static_cast<double>(row - last);
        last = row;
        if (!(std::abs(found - step) > kMaxJitter * step)) continue;
        return Error{row_name(recording, row) + ": time goes on by " + std::to_string(found) + " s, expected " +
                     std::to_string(step) +
                     " everywhere: resample the recording to one rate, or give the rate that it has"};
      }
    }
  }
  return {};
}

// The row's quaternion, normalised. `worst` receives the largest deviation from unit length.
Result<Quad> unit_quaternion(const Recording& recording, const std::array<std::size_t, 4>& channels, std::size_t row,
                             double& worst) {
  Quad q;
  double square = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    q[k] = recording.channels[channels[k]].samples[row];
    square += q[k] * q[k];
  }
  const double length = std::sqrt(square), wrong = std::abs(length - 1);
  if (!(wrong <= kMaxWrong)) {
    return Error{row_name(recording, row) + ": the quaternion q has length " + std::to_string(length) +
                 ", expected 1 within 1 %: w comes first; what is no orientation can't be learned"};
  }
  worst = std::max(worst, wrong);
  for (double& x : q) x /= length;
  return q;
}

double dot(const Quad& a, const Quad& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }

// Derivative per row by finite differences of fourth order, of lower order at the ends.
template <std::size_t kSize>
std::vector<std::array<double, kSize>> differences(const std::vector<std::array<double, kSize>>& values) {
  const auto last = static_cast<long>(values.size()) - 1;
  std::vector<std::array<double, kSize>> out(values.size());
  const auto at = [&](long row) -> const std::array<double, kSize>& { return values[static_cast<std::size_t>(row)]; };
  for (long row = 0; row <= last; ++row) {
    for (std::size_t k = 0; k < kSize; ++k) {
      double& rate = out[static_cast<std::size_t>(row)][k];
      if (row >= 2 && row + 2 <= last) {
        rate = (8 * (at(row + 1)[k] - at(row - 1)[k]) - (at(row + 2)[k] - at(row - 2)[k])) / 12;
      } else if (row >= 1 && row + 1 <= last) {
        rate = (at(row + 1)[k] - at(row - 1)[k]) / 2;
      } else if (row == 0) {
        rate = (4 * at(1)[k] - 3 * at(0)[k] - at(2)[k]) / 2;
      } else {
        rate = (3 * at(last)[k] - 4 * at(last - 1)[k] + at(last - 2)[k]) / 2;
      }
    }
  }
  return out;
}

// Slope of the parabola through 2 half + 1 rows, fitted by least squares (Savitzky & Golay 1964). At the ends the
// window is moved inwards and the parabola's slope at the row is used.
std::vector<Triple> smooth_slopes(const std::vector<Triple>& values, long half) {
  const auto rows = static_cast<long>(values.size());
  half = std::min(half, (rows - 1) / 2);
  double squares = 0, fourths = 0;
  for (long k = -half; k <= half; ++k) {
    squares += static_cast<double>(k * k);
    fourths += static_cast<double>(k * k * k * k);
  }
  const double count = static_cast<double>(2 * half + 1);
  std::vector<Triple> out(values.size());
  for (long row = 0; row < rows; ++row) {
    const long middle = std::clamp(row, half, rows - 1 - half);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double sum = 0, first = 0, second = 0;
      for (long k = -half; k <= half; ++k) {
        const double value = values[static_cast<std::size_t>(middle + k)][axis];
        sum += value;
        first += static_cast<double>(k) * value;
        second += static_cast<double>(k * k) * value;
      }
      const double curve = (count * second - squares * sum) / (count * fourths - squares * squares);
      out[static_cast<std::size_t>(row)][axis] = first / squares + 2 * curve * static_cast<double>(row - middle);
    }
  }
  return out;
}

// Angular velocity ω = 2 q̇ q*, world axes.
Triple spin_of(const Quad& q, const Quad& rate) {
  return {2 * (-rate[0] * q[1] + rate[1] * q[0] - rate[2] * q[3] + rate[3] * q[2]),
          2 * (-rate[0] * q[2] + rate[2] * q[0] - rate[3] * q[1] + rate[1] * q[3]),
          2 * (-rate[0] * q[3] + rate[3] * q[0] - rate[1] * q[2] + rate[2] * q[1])};
}

void add_rates(MotionPiece& piece, double rate_hz, int smooth_rows) {
  piece.velocity = smooth_rows >= 3 ? smooth_slopes(piece.position, smooth_rows / 2) : differences(piece.position);
  for (Triple& velocity : piece.velocity) {
    for (double& x : velocity) x *= rate_hz;
  }
  const auto turning = piece.orientation.empty() ? std::vector<Quad>() : differences(piece.orientation);
  for (std::size_t row = 0; row < turning.size(); ++row) {
    Triple spin = spin_of(piece.orientation[row], turning[row]);
    for (double& x : spin) x *= rate_hz;
    piece.spin.push_back(spin);
  }
}

bool is_whole(const Recording& recording, const Layout& layout, std::size_t row) {
  const auto missing = [&](std::size_t channel) { return std::isnan(recording.channels[channel].samples[row]); };
  if (std::any_of(layout.position.begin(), layout.position.end(), missing)) return false;
  return !layout.orientation || std::none_of(layout.orientation->begin(), layout.orientation->end(), missing);
}

Result<void> add_row(const Recording& recording, const Layout& layout, std::size_t row, MotionPiece& piece,
                     double& worst) {
  Triple position;
  for (std::size_t axis = 0; axis < 3; ++axis) position[axis] = recording.channels[layout.position[axis]].samples[row];
  piece.position.push_back(position);
  if (!layout.orientation) return {};
  auto q = unit_quaternion(recording, *layout.orientation, row, worst);
  if (!q) return q.error();
  if (!piece.orientation.empty() && dot(*q, piece.orientation.back()) < 0) {
    for (double& x : *q) x = -x;
  }
  piece.orientation.push_back(*q);
  return {};
}

// Checks that a piece has no jump, as between two falls in one episode: no step more than kMaxJump times as long as the
// usual step and as each of the four steps around.
Result<void> check_jumps(const Recording& recording, const MotionPiece& piece) {
  std::vector<double> steps;
  for (std::size_t row = 1; row < piece.rows(); ++row) {
    const Triple &a = piece.position[row - 1], &b = piece.position[row];
    steps.push_back(std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]));
  }
  const double usual = quantile(steps, kUsualStep);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    double around = usual;
    for (std::size_t other = k > 2 ? k - 2 : 0; other < std::min(k + 3, steps.size()); ++other) {
      if (other != k) around = std::max(around, steps[other]);
    }
    if (!(around > 0) || steps[k] <= kMaxJump * around) continue;
    return Error{row_name(recording, piece.first_row + k + 1) + " lies " + number_text(steps[k], 3) +
                 " m from the row before it, where steps are " + number_text(usual, 3) +
                 " m: expected motion without jumps; begin a new episode there, or leave the row empty"};
  }
  return {};
}

Result<void> add_recording(const Recording& recording, std::size_t index, const Layout& layout, int smooth_rows,
                           Motion& motion) {
  double worst = 0;
  const auto finish = [&](MotionPiece& piece) -> Result<void> {
    if (piece.rows() >= kMinRows) {
      if (auto ok = check_jumps(recording, piece); !ok) return ok;
      add_rates(piece, recording.rate_hz, smooth_rows);
      motion.pieces.push_back(std::move(piece));
    }
    piece = {};
    return {};
  };
  for (const Episode& episode : episodes(recording)) {
    MotionPiece piece;
    for (std::size_t row = episode.begin; row < episode.end; ++row) {
      if (!is_whole(recording, layout, row)) {
        if (auto ok = finish(piece); !ok) return ok;
        continue;
      }
      if (piece.rows() == 0) piece = {.recording = index, .first_row = row};
      if (auto ok = add_row(recording, layout, row, piece, worst); !ok) return ok;
    }
    if (auto ok = finish(piece); !ok) return ok;
  }
  if (worst > kRounding) {
    motion.warnings.push_back(recording.source + ": quaternions are up to " + number_text(worst, 2) +
                              " from unit length; they were made unit");
  }
  return {};
}

// Weights of a Catmull-Rom cubic, and the index of the row before.
struct Place {
  long row;
  std::array<double, 4> weight;
};

Place place_of(double row, std::size_t rows) {
  const auto last = static_cast<double>(rows - 1);
  row = std::clamp(row, 0.0, last);
  const double whole = std::min(std::floor(row), std::max(0.0, last - 1));
  const double s = row - whole, s2 = s * s, s3 = s2 * s;
  return {static_cast<long>(whole),
          {(-s3 + 2 * s2 - s) / 2, (3 * s3 - 5 * s2 + 2) / 2, (-3 * s3 + 4 * s2 + s) / 2, (s3 - s2) / 2}};
}

template <std::size_t kSize>
std::array<double, kSize> cubic(std::span<const std::array<double, kSize>> values, double row) {
  const Place place = place_of(row, values.size());
  const auto last = static_cast<long>(values.size()) - 1;
  std::array<double, kSize> out{};
  const auto value = [&](long k, std::size_t i) { return values[static_cast<std::size_t>(k)][i]; };
  for (std::size_t i = 0; i < kSize; ++i) {
    for (long k = 0; k < 4; ++k) {
      const long at = place.row + k - 1;
      // Values are extrapolated linearly beyond the ends.
      const double x = at < 0      ? 2 * value(0, i) - value(std::min(1L, last), i)
                       : at > last ? 2 * value(last, i) - value(std::max(0L, last - 1), i)
                                   : value(at, i);
      out[i] += place.weight[static_cast<std::size_t>(k)] * x;
    }
  }
  return out;
}

}  // namespace

std::string row_name(const Recording& recording, std::size_t row) {
  return recording.source + ": row " + std::to_string(recording.first_row + row + 1);
}

Result<Motion> motion_of(std::span<const Recording> recordings, int smooth_rows) {
  if (recordings.empty()) return Error{"there is no recording to learn motion from"};
  Motion motion;
  motion.rate_hz = recordings.front().rate_hz;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    const Recording& recording = recordings[k];
    if (auto ok = check(recording); !ok) return ok.error();
    if (!same_rate(recording.rate_hz, motion.rate_hz)) {
      return Error{recording.source + ": has " + std::to_string(recording.rate_hz) + " rows a second, expected " +
                   std::to_string(motion.rate_hz) + " as in " + recordings.front().source};
    }
    const auto layout = layout_of(recording);
    if (!layout) return layout.error();
    const bool turns = layout->orientation.has_value();
    if (k == 0) motion.has_orientation = turns;
    if (turns != motion.has_orientation) {
      return Error{recording.source + (turns ? ": has" : ": has no") + " orientation, unlike " +
                   recordings.front().source + ": learn them apart"};
    }
    if (auto ok = check_time(recording); !ok) return ok.error();
    if (auto ok = add_recording(recording, k, *layout, smooth_rows, motion); !ok) return ok.error();
  }
  if (motion.pieces.empty()) {
    return Error{recordings.front().source + ": has no stretch of 8 complete rows, expected motion to learn from"};
  }
  return motion;
}

Triple at_row(std::span<const Triple> values, double row) { return cubic(values, row); }

Quad at_row(std::span<const Quad> values, double row) {
  Quad q = cubic(values, row);
  const double length = std::sqrt(dot(q, q));
  for (double& x : q) x /= length;
  return q;
}

Triple in_world_axes(const Quad& q, const Triple& v) {
  const Triple once = {2 * (q[2] * v[2] - q[3] * v[1]), 2 * (q[3] * v[0] - q[1] * v[2]),
                       2 * (q[1] * v[1] - q[2] * v[0])};
  return {v[0] + q[0] * once[0] + q[2] * once[2] - q[3] * once[1],
          v[1] + q[0] * once[1] + q[3] * once[0] - q[1] * once[2],
          v[2] + q[0] * once[2] + q[1] * once[1] - q[2] * once[0]};
}

Triple in_body_axes(const Quad& q, const Triple& v) { return in_world_axes({q[0], -q[1], -q[2], -q[3]}, v); }

Quad turned_about_z(const Quad& q, double angle) {
  const double c = std::cos(angle / 2), s = std::sin(angle / 2);
  return {c * q[0] - s * q[3], c * q[1] - s * q[2], c * q[2] + s * q[1], c * q[3] + s * q[0]};
}

Triple turned_about_z(const Triple& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]};
}

}  // namespace wisp::chain
