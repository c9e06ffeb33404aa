#include "export/outline.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "wisp/run/chain_facet.hpp"

namespace wisp::exporting {
namespace {

// A stable linear model driven by periodic shocks has one periodic orbit (W. J. Rugh, Linear System Theory, 2nd ed.,
// chapter 5): one period of play, plus the free response that makes its two ends equal.

// One term weight · y(t − lag) of the prediction of an output in a mode; `output` is the index of y.
struct Tap {
  std::size_t output = 0;
  std::size_t lag = 1;
  double weight = 0;
};
using Rows = std::vector<std::vector<Tap>>;  // per output

Rows taps_of(const ArxModel& arx) {
  Rows rows(static_cast<std::size_t>(arx.orders.outputs()));
  for (int i = 0; i < arx.orders.outputs(); ++i) {
    for (int j = 0; j < arx.orders.outputs(); ++j) {
      const auto a = arx.a(i, j);
      for (std::size_t lag = 0; lag < a.size(); ++lag) {
        if (a[lag] != 0) rows[i].push_back({static_cast<std::size_t>(j), lag + 1, -a[lag]});
      }
    }
  }
  return rows;
}

std::vector<Rows> taps_of(const Model& model) {
  std::vector<Rows> modes;
  if (const auto* arx = std::get_if<ArxModel>(&model.dynamics)) modes.push_back(taps_of(*arx));
  if (const auto* switched = std::get_if<SwitchedArxModel>(&model.dynamics)) {
    for (std::size_t mode = 0; mode < switched->modes.size(); ++mode) {
      modes.push_back(taps_of(mode_model(*switched, mode)));
    }
  }
  return modes;
}

// Computes one row of the response without shocks from the rows before it.
void respond(const Rows& taps, std::size_t row, std::vector<double>& response) {
  const std::size_t outputs = taps.size();
  for (std::size_t i = 0; i < outputs; ++i) {
    double sum = 0;
    for (const Tap& tap : taps[i]) sum += tap.weight * response[(row - tap.lag) * outputs + tap.output];
    response[row * outputs + i] = sum;
  }
}

constexpr int kWalks = 64;       // number of walks in parallel
constexpr double kSeconds = 80;  // duration of each walk, in addition to the loop
constexpr double kSettled = 4;   // seconds until a walk is independent of its start and responds fully to the wind
constexpr int kMaxRounds = 64;   // batches of walks, 0.1 s each; a leaf of 60 recorded falls needs 35 (95th percentile)

using Vector = std::array<double, 3>;

struct Walk {
  std::vector<float> rows;           // frames × outputs
  std::vector<std::uint32_t> place;  // per frame 65536 · segment + step
};

std::vector<Walk> walk(const Model& model, std::size_t frames, std::uint64_t seed, const std::vector<float>& inputs) {
  auto bank = Bank::create(model, {.capacity = kWalks, .seed = seed});
  std::vector<Walk> walks(kWalks);
  for (int k = 0; k < kWalks; ++k) bank->spawn();
  bank->set_common_inputs(inputs);
  const auto settle = static_cast<std::size_t>(kSettled * model.rate_hz);
  const std::size_t outputs = model.outputs.size();
  std::vector<float> all(kWalks * outputs);
  for (std::size_t frame = 0; frame < settle + frames; ++frame) {
    bank->step();
    if (frame < settle) continue;
    bank->outputs(all);
    for (int k = 0; k < kWalks; ++k) {
      const auto at = all.begin() + static_cast<std::ptrdiff_t>(k * outputs);
      walks[k].rows.insert(walks[k].rows.end(), at, at + static_cast<std::ptrdiff_t>(outputs));
      const ChainPlace place = *bank->chain()->place_of(bank->at(k));
      walks[k].place.push_back(place.segment * 65536 + place.step);
    }
  }
  return walks;
}

Vector velocity(const std::vector<float>& rows, std::size_t outputs, std::size_t frame) {
  Vector v{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    v[axis] = static_cast<double>(rows[frame * outputs + axis]) - rows[(frame - 1) * outputs + axis];
  }
  return v;
}

using Quaternion = std::array<double, 4>;  // w first

Quaternion product(const Quaternion& p, const Quaternion& q) {
  return {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3], p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
          p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1], p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
}

Quaternion conjugate(const Quaternion& q) { return {q[0], -q[1], -q[2], -q[3]}; }

// Returns the rotation about a vector's direction by `share` of its length, radians.
Quaternion rotation(const Vector& by, double share) {
  const double angle = std::hypot(by[0], by[1], by[2]) * share;
  if (std::abs(angle) < 1e-12) return {1, 0, 0, 0};
  const double s = std::sin(angle / 2) * share / angle;
  return {std::cos(angle / 2), s * by[0], s * by[1], s * by[2]};
}

Vector turned(const Vector& v, const Quaternion& by) {
  const Quaternion out = product(product(by, {0, v[0], v[1], v[2]}), conjugate(by));
  return {out[1], out[2], out[3]};
}

Quaternion attitude(const std::vector<float>& rows, std::size_t outputs, std::size_t frame) {
  const float* stored = &rows[frame * outputs + 3];
  const Quaternion q{stored[0], stored[1], stored[2], stored[3]};
  // std::sqrt is rounded correctly on every machine, std::hypot is not.
  const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {q[0] / size, q[1] / size, q[2] / size, q[3] / size};
}

// Returns the rotation from frame `a` to frame `b` as axis times angle: of the attitude or, for outputs without one, of
// the velocity's heading about the vertical.
Vector turn_between(const std::vector<float>& rows, std::size_t outputs, std::size_t a, std::size_t b) {
  if (outputs < 7) {
    const Vector va = velocity(rows, outputs, a), vb = velocity(rows, outputs, b);
    return {0, 0, std::atan2(va[0] * vb[1] - va[1] * vb[0], va[0] * vb[0] + va[1] * vb[1])};
  }
  Quaternion q = product(attitude(rows, outputs, b), conjugate(attitude(rows, outputs, a)));
  if (q[0] < 0) q = {-q[0], -q[1], -q[2], -q[3]};
  const double s = std::hypot(q[1], q[2], q[3]);
  const double scale = s > 1e-12 ? 2 * std::atan2(s, q[0]) / s : 2;
  return {scale * q[1], scale * q[2], scale * q[3]};
}

struct Return {
  const Walk* walk = nullptr;
  std::size_t frame = 0;
  Vector turn{};  // rotation from the first frame to the returning frame
  Vector jump{};  // change of the velocity after undoing the rotation
  double cost = 0;
};

// Selects the return to the same row of a segment with the lowest cost: rotation about the vertical plus weighted tilt
// and velocity change. Visits of a row differ in these, since the joins to the neighbouring segments differ.
std::optional<Return> best_return(const std::vector<Walk>& walks, std::size_t outputs, std::size_t frames) {
  constexpr double kSame = 0.1, kWeight = 20;
  std::optional<Return> best;
  for (const Walk& walk : walks) {
    for (std::size_t at = 1; at + frames < walk.place.size(); ++at) {
      if (walk.place[at] != walk.place[at + frames]) continue;
      Return found{&walk, at, turn_between(walk.rows, outputs, at, at + frames)};
      const double tilt = std::hypot(found.turn[0], found.turn[1]);
      const Vector before = velocity(walk.rows, outputs, at);
      const Vector after = turned(velocity(walk.rows, outputs, at + frames), rotation(found.turn, -1));
      for (std::size_t axis = 0; axis < 3; ++axis) found.jump[axis] = after[axis] - before[axis];
      const double size = std::hypot(before[0], before[1], before[2]);
      const double jump = std::hypot(found.jump[0], found.jump[1], found.jump[2]) / std::max(size, 1e-9);
      found.cost = std::abs(found.turn[2]) + kWeight * (tilt + jump);
      if (tilt <= kSame && jump <= kSame && (!best || found.cost < best->cost)) best = found;
    }
  }
  return best;
}

// Distributes the remaining rotation and velocity change evenly over the loop.
WalkLoop loop_of(const Return& found, std::size_t outputs, std::size_t frames) {
  WalkLoop loop;
  const std::vector<float>& rows = found.walk->rows;
  Vector position{};
  for (std::size_t t = 0; t <= frames; ++t) {
    const std::size_t frame = found.frame + t;
    const double share = static_cast<double>(t) / static_cast<double>(frames);
    const Quaternion back = rotation(found.turn, -share);
    if (t > 0) {
      const Vector v = turned(velocity(rows, outputs, frame), back);
      for (std::size_t axis = 0; axis < 3; ++axis) position[axis] += v[axis] - share * found.jump[axis];
    }
    if (t == frames) break;
    std::vector<float> row(rows.begin() + static_cast<std::ptrdiff_t>(frame * outputs),
                           rows.begin() + static_cast<std::ptrdiff_t>((frame + 1) * outputs));
    for (std::size_t axis = 0; axis < 3; ++axis) row[axis] = static_cast<float>(position[axis]);
    if (outputs >= 7) {
      const Quaternion q = product(back, attitude(rows, outputs, frame));
      for (std::size_t k = 0; k < 4; ++k) row[3 + k] = static_cast<float>(q[k]);
    }
    loop.rows.insert(loop.rows.end(), row.begin(), row.end());
  }
  loop.travel = position;
  return loop;
}

}  // namespace

std::size_t output_lags(const Model& model) {
  std::size_t longest = 1;
  for (const Rows& rows : taps_of(model)) {
    for (const auto& taps : rows) {
      for (const Tap& tap : taps) longest = std::max(longest, tap.lag);
    }
  }
  return longest;
}

bool close_orbit(const Model& model, std::span<const std::size_t> mode, std::size_t lags, std::vector<double>& rows) {
  constexpr double kClosed = 1e-12;  // relative to the largest value: far below single precision
  constexpr std::size_t kMaxRows = 20'000'000;
  const auto modes = taps_of(model);
  const std::size_t outputs = model.outputs.size(), count = rows.size() / outputs, frames = count - lags;
  double largest = 0;
  for (double value : rows) largest = std::max(largest, std::abs(value));
  std::vector<double> response(rows.size(), 0.0);
  for (std::size_t done = 0; done < kMaxRows; done += count) {
    // The rows before the loop must equal those at its end.
    double change = 0;
    for (std::size_t k = 0; k < lags * outputs; ++k) {
      const std::size_t end = k + frames * outputs;
      const double needed = rows[end] + response[end] - rows[k];
      change = std::max(change, std::abs(needed - response[k]));
      response[k] = needed;
    }
    for (std::size_t row = lags; row < count; ++row) respond(modes[modes.size() > 1 ? mode[row] : 0], row, response);
    if (!(change > kClosed * largest)) {
      for (std::size_t k = 0; k < rows.size(); ++k) rows[k] += response[k];
      return true;
    }
  }
  return false;
}

Result<WalkLoop> find_walk_loop(const Model& model, std::size_t frames, std::uint64_t seed,
                                const std::vector<float>& inputs, const Progress& progress) {
  const std::size_t length = frames + static_cast<std::size_t>(kSeconds * model.rate_hz);
  for (int round = 0; round < kMaxRounds; ++round) {
    if (!go_on(progress, "searching for a loop", -1)) return Error{std::string(kStopped)};
    const std::uint64_t other = seed + 0x9e3779b97f4a7c15U * static_cast<std::uint64_t>(round);
    const auto walks = walk(model, length, other, inputs);
    if (const auto found = best_return(walks, model.outputs.size(), frames)) {
      return loop_of(*found, model.outputs.size(), frames);
    }
  }
  return Error{"none of thousands of walks came back to where it was after exactly " + std::to_string(frames) +
               " frames; ask for a few frames more or less, or a longer loop"};
}

}  // namespace wisp::exporting
