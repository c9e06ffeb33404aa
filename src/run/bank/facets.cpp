#include <algorithm>
#include <array>

#include "run/bank/bank_state.hpp"
#include "wisp/run/body_facet.hpp"
#include "wisp/run/chain_facet.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp {
namespace {

constexpr float kMinNear = 0.001f;  // metres
constexpr float kMaxNear = 1000.0f;
constexpr std::chrono::nanoseconds kLongestSteering = std::chrono::seconds(10'000);
constexpr float kMinOrientation = 1e-6f;  // bounds of an orientation's squared norm
constexpr float kMaxOrientation = 1e30f;

int block_of(InstanceId id) { return static_cast<int>(id.slot) / Bank::State::kLanes; }
int lane_of(InstanceId id) { return static_cast<int>(id.slot) % Bank::State::kLanes; }

bool is_near_enough(const std::array<float, 3>& vector) {
  return std::all_of(vector.begin(), vector.end(), [](float x) { return x > -kFarthest && x < kFarthest; });
}

bool is_sound(const BodyMoment& body) {
  float size = 0;
  for (float x : body.orientation) size += x * x;
  return is_near_enough(body.position) && is_near_enough(body.velocity) && is_near_enough(body.spin) &&
         size > kMinOrientation && size < kMaxOrientation;
}

bool is_sound(const SteerTarget& target) {
  return is_near_enough(target.position) && target.near >= kMinNear && target.near <= kMaxNear &&
         target.in > std::chrono::nanoseconds::zero() && target.in <= kLongestSteering;
}

}  // namespace

std::optional<ChainPlace> ChainFacet::place_of(InstanceId id) const {
  if (!state_->valid(id)) return {};
  const auto& chain = *state_->chain_stepper();
  ChainPlace place = chain.place_of(block_of(id), lane_of(id));
  const auto [velocity, spin] = chain.rates(block_of(id), lane_of(id));
  place.velocity = velocity, place.spin = spin;
  // `ago`: steps since the body touched the ground. The body landed in the last call if this call made more steps.
  const float settled = chain.settled(block_of(id), lane_of(id));
  const float ago = settled * kSettleSeconds / (static_cast<float>(state_->step_time) * 1e-9f);
  place.lies = settled >= 1;
  place.landed = settled >= 0 && settled < 1 && ago + 0.5f < static_cast<float>(state_->steps - state_->called);
  return place;
}

bool ChainFacet::place(InstanceId id, const BodyMoment& body) {
  if (!state_->valid(id) || !is_sound(body)) return false;
  const BodyState<float> moved{body.position, unit(body.orientation), {body.velocity, body.spin}};
  state_->chain_stepper()->place(block_of(id), lane_of(id), moved);
  state_->show_block(block_of(id));
  return true;
}

bool ChainFacet::can_steer() const { return state_->chain_stepper()->can_steer(); }

bool ChainFacet::steer(InstanceId id, const SteerTarget& target) {
  if (!state_->valid(id) || !is_sound(target) || !can_steer()) return false;
  const auto steps = (target.in.count() + state_->step_time - 1) / state_->step_time;  // rounded up
  state_->chain_stepper()->steer(block_of(id), lane_of(id), target.position, static_cast<float>(steps), target.near);
  return true;
}

bool ChainFacet::release(InstanceId id) {
  if (!state_->valid(id)) return false;
  if (can_steer()) state_->chain_stepper()->steer(block_of(id), lane_of(id), {}, 0.0f, kMinNear);
  return true;
}

void ChainFacet::set_ground(std::optional<float> height) {
  state_->set_ground(height && *height > -kFarthest && *height < kFarthest ? *height : kNoGround);
}

std::optional<float> ChainFacet::ground() const {
  if (state_->ground == kNoGround) return {};
  return state_->ground;
}

std::optional<LitState> ExtinctionFacet::state_of(InstanceId id) const {
  if (!state_->valid(id)) return {};
  return state_->lit_state(static_cast<int>(id.slot));
}

void ExtinctionFacet::states(std::span<LitState> states) const {
  const Bank::State& s = *state_;
  const LitState none{.lit = false, .size = 0.0F};
  if (!check_size("ExtinctionFacet::states()", states.size(), static_cast<std::size_t>(s.rows), true)) return;
  for (int slot = 0; slot < s.rows; ++slot) states[slot] = s.alive[slot] ? s.lit_state(slot) : none;
  std::fill(states.begin() + s.rows, states.end(), none);
}

bool ExtinctionFacet::relight(InstanceId id) {
  if (!state_->valid(id)) return false;
  state_->relight(static_cast<int>(id.slot));
  return true;
}

bool ExtinctionFacet::extinguish(InstanceId id) {
  if (!state_->valid(id)) return false;
  state_->extinguish(static_cast<int>(id.slot));
  return true;
}

namespace {

constexpr int kBodyLanes = Bank::State::kLanes;

// Computes a ring from four polyline points: `ring` points from the left and the right end, in front and in side view.
std::array<float, kRingNumbers> ring_of(const Bank::State& s, int ring, int lane) {
  const int points = s.polyline.points;
  const auto at = [&](int side, int point, int coordinate) {
    return s.round_lines[static_cast<std::size_t>(2 * (side * points + point) + coordinate) * kBodyLanes + lane];
  };
  const int left = ring, right = points - 1 - ring;
  const auto middle = [&](int side, int c) { return 0.5f * (at(side, left, c) + at(side, right, c)); };
  const auto half = [&](int side, int c) { return 0.5f * (at(side, right, c) - at(side, left, c)); };
  return {middle(0, 0), middle(0, 1), middle(1, 0), std::max(half(0, 0), 0.0f), half(0, 1), half(1, 1)};
}

void write_lane(const Bank::State& s, int lane, float* out) {
  for (int k = 0; k < s.body_facet.rings(); ++k)
    for (float number : ring_of(s, k, lane)) *out++ = number;
}

}  // namespace

// Computes a block's control points in front and side view and, if `lines_too`, their polylines.
void Bank::State::see_round(int block, bool lines_too) const {
  for (int side : {0, 1}) {
    float* points = round_points.data() + static_cast<std::size_t>(side) * visible * kBodyLanes;
    float* lines = round_lines.data() + static_cast<std::size_t>(2 * side * polyline.points) * kBodyLanes;
    show_shape(block, side == 0 ? LevelView{1, 0} : LevelView{0, 1}, points);
    if (extinction.present) show_life(block, visible, points);
    if (!lines_too) continue;
    polyline_of(
        block, [&](int number, const float* lanes) { std::copy_n(lanes, kBodyLanes, lines + number * kBodyLanes); },
        points);
  }
}

void BodyFacet::look(float right_x, float right_z) {
  state_->view = {right_x, right_z};
  state_->show();
}

int BodyFacet::rings() const { return (state_->polyline.points + 1) / 2; }

void BodyFacet::read_rings(std::span<float> values) const {
  const Bank::State& s = *state_;
  const std::size_t row = static_cast<std::size_t>(rings()) * kRingNumbers,
                    used = static_cast<std::size_t>(s.rows) * row;
  if (!check_size("BodyFacet::read_rings()", values.size(), used, true)) return;
  std::fill(values.begin(), values.end(), 0.0f);
  for (int block = 0; block < s.blocks(); ++block) {
    s.see_round(block);
    for (int slot = block * kBodyLanes; slot < std::min((block + 1) * kBodyLanes, s.rows); ++slot) {
      if (s.alive[slot]) write_lane(s, slot % kBodyLanes, values.data() + static_cast<std::size_t>(slot) * row);
    }
  }
}

bool BodyFacet::read_rings(InstanceId id, std::span<float> values) const {
  const std::size_t row = static_cast<std::size_t>(rings()) * kRingNumbers;
  if (!state_->valid(id) || !check_size("BodyFacet::read_rings()", values.size(), row)) return false;
  state_->see_round(static_cast<int>(id.slot) / kBodyLanes);
  write_lane(*state_, static_cast<int>(id.slot) % kBodyLanes, values.data());
  return true;
}

}  // namespace wisp
