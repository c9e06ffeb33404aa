#include "simulate/leaf/leaf_flight.hpp"

#include <algorithm>
#include <cmath>

#include "simulate/leaf/leaf_constants.hpp"
#include "simulate/leaf/leaf_stepper.hpp"
#include "simulate/option_range.hpp"

namespace wisp {
namespace {

// In wind above it, m/s, steps shrink as the wind grows: drag decays at a rate that is proportional to the speed of the
// air. At 2.5 m/s steps of 1/60 s are no longer stable.
constexpr double kFastestForWholeSteps = 1.6;

bool finite(const LeafState& s) {
  double sum = 0;
  for (const double value : s.attitude) sum += value;
  for (const auto* part : {&s.position, &s.velocity, &s.spin})
    for (const double value : *part) sum += value;
  return std::isfinite(sum);
}

double squared_length(const std::array<double, 4>& q) { return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]; }

}  // namespace

struct LeafFlight::Course {
  leaf::Constants<double> constants;
  const LeafWind* wind = nullptr;
  double longest_step = 0;
  leaf::State<double> inside;
  LeafState state;
  double seconds = 0;
  std::vector<double> stalls;

  leaf::State<double> rate(const leaf::State<double>& s, double at) const {
    if (wind->calm()) return leaf::rate_of(constants, s, {});
    const leaf::Vec<double> moving = leaf::rotation_of(s.attitude)(s.velocity);
    const WindSample sample = wind->at(leaf::array_of(s.position), leaf::array_of(moving), at);
    return leaf::rate_of(constants, s, leaf::air_of(sample));
  }

  void step(double h) {
    const auto slope = [this, h](const leaf::State<double>& s, double share) { return rate(s, seconds + share * h); };
    const double before = inside.velocity.y;
    inside = leaf::classical_step(inside, h, slope);
    const double after = inside.velocity.y;
    if (before * after < 0) stalls.push_back(seconds + h * before / (before - after));
    seconds += h;
  }

  Result<void> advance(double by) {
    // A tolerance for rounding, which would add a step.
    const double steps = std::max(1.0, std::ceil(by / longest_step - 1e-9));
    for (int k = 0; k < static_cast<int>(steps); ++k) step(by / steps);
    state = leaf::plain(inside);
    if (!finite(state)) return Error{"leaf: the fall is no longer finite after " + std::to_string(seconds) + " s"};
    return {};
  }
};

LeafFlight::LeafFlight(std::unique_ptr<Course> course) : course_(std::move(course)) {}
LeafFlight::LeafFlight(LeafFlight&&) noexcept = default;
LeafFlight& LeafFlight::operator=(LeafFlight&&) noexcept = default;
LeafFlight::~LeafFlight() = default;

Result<LeafFlight> LeafFlight::begin(const Leaf& leaf, const LeafWind& wind, const LeafState& state,
                                     double longest_step) {
  if (auto good = check(leaf); !good) return good.error();
  auto in_range = flow::check_ranges("leaf", {{"longest_step", longest_step, 1e-6, 0.05}});
  if (!in_range) return in_range.error();
  if (!finite(state) || !(squared_length(state.attitude) > 0))
    return Error{"leaf: the state to begin with is not finite or its attitude has no length"};
  auto course = std::make_unique<Course>();
  course->constants = leaf::constants_of(leaf);
  course->wind = &wind;
  course->longest_step = longest_step * std::min(1.0, kFastestForWholeSteps / wind.fastest());
  course->state = state;
  course->state.attitude = leaf::normalised(state.attitude);
  course->inside = leaf::state_of(course->state);
  return LeafFlight(std::move(course));
}

Result<void> LeafFlight::advance(double seconds) { return course_->advance(seconds); }
const LeafState& LeafFlight::state() const { return course_->state; }
double LeafFlight::seconds() const { return course_->seconds; }
const std::vector<double>& LeafFlight::stalls() const { return course_->stalls; }

}  // namespace wisp
