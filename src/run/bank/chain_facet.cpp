#include "wisp/run/chain_facet.hpp"

#include <algorithm>

#include "run/bank/bank_state.hpp"

namespace wisp {
namespace {

constexpr float kLeastNear = 0.001f;  // metres
constexpr float kMaxNear = 1000.0f;
constexpr std::chrono::nanoseconds kLongestSteering = std::chrono::seconds(10'000);
constexpr float kMinOrientation = 1e-6f;  // of its squared length
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
  return is_near_enough(target.position) && target.near >= kLeastNear && target.near <= kMaxNear &&
         target.in > std::chrono::nanoseconds::zero() && target.in <= kLongestSteering;
}

}  // namespace

std::optional<ChainPlace> ChainFacet::place_of(InstanceId id) const {
  if (!state_->valid(id)) return {};
  return state_->chain_stepper()->place_of(block_of(id), lane_of(id));
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
  const auto steps = (target.in.count() + state_->step_time - 1) / state_->step_time;  // those begun count
  state_->chain_stepper()->steer(block_of(id), lane_of(id), target.position, static_cast<float>(steps), target.near);
  return true;
}

bool ChainFacet::release(InstanceId id) {
  if (!state_->valid(id)) return false;
  if (can_steer()) state_->chain_stepper()->steer(block_of(id), lane_of(id), {}, 0.0f, kLeastNear);
  return true;
}

void ChainFacet::set_ground(std::optional<float> height) {
  ChainSettings settings = state_->chain;
  settings.ground = height && *height > -kFarthest && *height < kFarthest ? *height : kNoGround;
  state_->set_chain(settings);
}

std::optional<float> ChainFacet::ground() const {
  if (state_->chain.ground == kNoGround) return {};
  return state_->chain.ground;
}

}  // namespace wisp
