#include "simulate/leaf/leaf_flight.hpp"

#include <algorithm>
#include <cmath>

#include "simulate/leaf/leaf_vector.hpp"
#include "simulate/option_range.hpp"

namespace wisp {
namespace {

// Wind, m/s, above which steps shrink in inverse proportion: drag decays at a rate proportional to the speed of the
// air. At 2.5 m/s steps of 1/60 s are unstable.
constexpr double kFastestForWholeSteps = 1.6;

bool finite(const LeafState& s) {
  double sum = 0;
  for (const double value : s.attitude) sum += value;
  for (const auto* part : {&s.position, &s.velocity, &s.spin})
    for (const double value : *part) sum += value;
  return std::isfinite(sum);
}

double squared_length(const leaf::Quaternion& q) { return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]; }

// state + h · rate.
LeafState moved(const LeafState& s, double h, const LeafState& rate) {
  using leaf::operator+, leaf::operator*;
  LeafState out{{}, s.position + h * rate.position, s.velocity + h * rate.velocity, s.spin + h * rate.spin};
  for (std::size_t k = 0; k < 4; ++k) out.attitude[k] = s.attitude[k] + h * rate.attitude[k];
  return out;
}

}  // namespace

Result<LeafFlight> LeafFlight::begin(const Leaf& leaf, const LeafWind& wind, const LeafState& state,
                                     double longest_step) {
  if (auto good = check(leaf); !good) return good.error();
  auto in_range = flow::check_ranges("leaf", {{"longest_step", longest_step, 1e-6, 0.05}});
  if (!in_range) return in_range.error();
  if (!finite(state) || !(squared_length(state.attitude) > 0))
    return Error{"leaf: the state to begin with is not finite or its attitude has no length"};
  LeafFlight flight;
  flight.constants_ = leaf::constants_of(leaf);
  flight.wind_ = &wind;
  flight.longest_step_ = longest_step * std::min(1.0, kFastestForWholeSteps / wind.fastest());
  flight.state_ = state;
  flight.state_.attitude = leaf::normalised(state.attitude);
  return flight;
}

LeafState LeafFlight::rate(const LeafState& s, double at) const {
  if (wind_->calm()) return leaf::rate_of(constants_, s, {});
  return leaf::rate_of(constants_, s, wind_->at(s.position, leaf_world_velocity(s), at));
}

// Makes a classical Runge-Kutta step of fourth order, and normalises the attitude.
void LeafFlight::step(double h) {
  const LeafState first = rate(state_, seconds_);
  const LeafState second = rate(moved(state_, 0.5 * h, first), seconds_ + 0.5 * h);
  const LeafState third = rate(moved(state_, 0.5 * h, second), seconds_ + 0.5 * h);
  const LeafState fourth = rate(moved(state_, h, third), seconds_ + h);
  const double before = state_.velocity[1], sixth = 1.0 / 6 * h;
  state_ = moved(moved(moved(moved(state_, sixth, first), 2 * sixth, second), 2 * sixth, third), sixth, fourth);
  const double scale = 1 / std::sqrt(squared_length(state_.attitude));
  for (double& part : state_.attitude) part *= scale;
  const double after = state_.velocity[1];
  if (before * after < 0) stalls_.push_back(seconds_ + h * before / (before - after));
  seconds_ += h;
}

Result<void> LeafFlight::advance(double seconds) {
  // A tolerance, since rounding would otherwise add a step.
  const double steps = std::max(1.0, std::ceil(seconds / longest_step_ - 1e-9));
  for (int k = 0; k < static_cast<int>(steps); ++k) step(seconds / steps);
  if (!finite(state_)) return Error{"leaf: the fall is no longer finite after " + std::to_string(seconds_) + " s"};
  return {};
}

}  // namespace wisp
