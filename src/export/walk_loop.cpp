#include "export/walk_loop.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "wisp/run/chain_facet.hpp"

namespace wisp::exporting {
namespace {

constexpr int kWalks = 64;       // side by side
constexpr double kSeconds = 40;  // of each, beside the loop
constexpr double kSettled = 4;   // seconds after which a walk has forgotten how it began, and a wind has blown in
constexpr int kMostRounds = 8;

using Vector = std::array<double, 3>;

struct Walk {
  std::vector<float> rows;           // frames × outputs
  std::vector<std::uint32_t> place;  // segment and step; 0: within a blend
};

// Steps of a segment after which nothing of the one before is left.
std::uint32_t blend_steps(const ChainModel& chain, std::uint32_t segment) {
  const double longest = std::min(chain.blend.longest_steps, chain.blend.share * chain.segments.steps[segment]);
  return static_cast<std::uint32_t>(std::ceil(longest)) + 1;
}

std::vector<Walk> walk(const Model& model, const ChainModel& chain, std::size_t frames, std::uint64_t seed,
                       const std::vector<float>& inputs) {
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
      const bool own = place.step >= blend_steps(chain, place.segment);
      walks[k].place.push_back(own ? place.segment * 65536 + place.step : 0);
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

Vector turned(const Vector& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]};
}

// The heading that frame `b` has more than frame `a`, whose bodies have the same attitude otherwise: of the quaternion
// that leads from one to the other, or of the velocities where there is none.
double heading_between(const std::vector<float>& rows, std::size_t outputs, std::size_t a, std::size_t b) {
  if (outputs < 7) {
    const Vector va = velocity(rows, outputs, a), vb = velocity(rows, outputs, b);
    return std::atan2(va[0] * vb[1] - va[1] * vb[0], va[0] * vb[0] + va[1] * vb[1]);
  }
  const float *p = &rows[a * outputs + 3], *q = &rows[b * outputs + 3];
  // q · p⁻¹, its scalar and its vertical part.
  const double w = static_cast<double>(q[0]) * p[0] + static_cast<double>(q[1]) * p[1] +
                   static_cast<double>(q[2]) * p[2] + static_cast<double>(q[3]) * p[3];
  const double z = static_cast<double>(q[3]) * p[0] - static_cast<double>(q[0]) * p[3] +
                   static_cast<double>(q[2]) * p[1] - static_cast<double>(q[1]) * p[2];
  return std::remainder(2 * std::atan2(z, w), 2 * std::numbers::pi);
}

struct Return {
  const Walk* walk = nullptr;
  std::size_t frame = 0;
  double heading = 0;
  double jump = 0;  // of the velocity, as a share of its size
};

// The return that turns least, of those whose velocity is the same.
std::optional<Return> best_return(const std::vector<Walk>& walks, std::size_t outputs, std::size_t frames) {
  constexpr double kSame = 1e-3;
  std::optional<Return> best;
  for (const Walk& walk : walks) {
    for (std::size_t at = 1; at + frames < walk.place.size(); ++at) {
      if (walk.place[at] == 0 || walk.place[at] != walk.place[at + frames]) continue;
      const double heading = heading_between(walk.rows, outputs, at, at + frames);
      if (best && std::abs(heading) >= std::abs(best->heading)) continue;
      const Vector before = velocity(walk.rows, outputs, at);
      const Vector after = turned(velocity(walk.rows, outputs, at + frames), -heading);
      const double size = std::hypot(before[0], before[1], before[2]);
      const double jump = std::hypot(after[0] - before[0], after[1] - before[1], after[2] - before[2]);
      if (jump <= kSame * size) best = Return{&walk, at, heading, jump};
    }
  }
  return best;
}

void turn(std::vector<float>& row, double angle) {
  if (row.size() < 7) return;
  const double c = std::cos(angle / 2), s = std::sin(angle / 2);
  const std::array<double, 4> q{row[3], row[4], row[5], row[6]};
  row[3] = static_cast<float>(c * q[0] - s * q[3]);
  row[4] = static_cast<float>(c * q[1] - s * q[2]);
  row[5] = static_cast<float>(c * q[2] + s * q[1]);
  row[6] = static_cast<float>(c * q[3] + s * q[0]);
}

WalkLoop loop_of(const Return& found, std::size_t outputs, std::size_t frames) {
  WalkLoop loop;
  const std::vector<float>& rows = found.walk->rows;
  Vector position{0, 0, rows[found.frame * outputs + 2]};
  const Vector first = position;
  for (std::size_t t = 0; t <= frames; ++t) {
    const std::size_t frame = found.frame + t;
    const double angle = -found.heading * static_cast<double>(t) / static_cast<double>(frames);
    if (t > 0) {
      const Vector v = turned(velocity(rows, outputs, frame), angle);
      for (std::size_t axis = 0; axis < 3; ++axis) position[axis] += v[axis];
    }
    if (t == frames) break;
    std::vector<float> row(rows.begin() + static_cast<std::ptrdiff_t>(frame * outputs),
                           rows.begin() + static_cast<std::ptrdiff_t>((frame + 1) * outputs));
    for (std::size_t axis = 0; axis < 3; ++axis) row[axis] = static_cast<float>(position[axis]);
    turn(row, angle);
    loop.rows.insert(loop.rows.end(), row.begin(), row.end());
  }
  for (std::size_t axis = 0; axis < 3; ++axis) loop.travel[axis] = position[axis] - first[axis];
  return loop;
}

}  // namespace

std::optional<WalkLoop> find_walk_loop(const Model& model, std::size_t frames, std::uint64_t seed,
                                       const std::vector<float>& inputs) {
  const auto& chain = std::get<ChainModel>(model.dynamics);
  const std::size_t length = frames + static_cast<std::size_t>(kSeconds * model.rate_hz);
  for (int round = 0; round < kMostRounds; ++round) {
    const std::uint64_t other = seed + 0x9e3779b97f4a7c15U * static_cast<std::uint64_t>(round);
    const auto walks = walk(model, chain, length, other, inputs);
    if (const auto found = best_return(walks, model.outputs.size(), frames)) {
      return loop_of(*found, model.outputs.size(), frames);
    }
  }
  return {};
}

}  // namespace wisp::exporting
