#include "studies/leaf/leaf_plate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "simulate/option_range.hpp"

namespace wisp {
namespace {

using std::numbers::pi;

constexpr double kTranslationalLift = 1.2;
constexpr double kRotationalLift = pi;
constexpr double kDragMean = 1.4;
constexpr double kDragSwing = 1.0;
constexpr double kDampingLinear = 0.2;
constexpr double kDampingQuadratic = 0.2;
constexpr double kStep = 1e-3;

PlateState moved(const PlateState& s, double h, const PlateState& rate) {
  return {s.x + h * rate.x,         s.y + h * rate.y,           s.angle + h * rate.angle,
          s.along + h * rate.along, s.across + h * rate.across, s.spin + h * rate.spin};
}

PlateState step(double inertia, const PlateState& s) {
  const PlateState first = plate_rate(inertia, s);
  const PlateState second = plate_rate(inertia, moved(s, kStep / 2, first));
  const PlateState third = plate_rate(inertia, moved(s, kStep / 2, second));
  const PlateState fourth = plate_rate(inertia, moved(s, kStep, third));
  return moved(moved(moved(moved(s, kStep / 6, first), kStep / 3, second), kStep / 3, third), kStep / 6, fourth);
}

double mean_interval(const std::vector<double>& times) {
  return times.size() < 2 ? 0 : (times.back() - times.front()) / static_cast<double>(times.size() - 1);
}

// What a fall comes to.
class Watch {
 public:
  void see(double time, const PlateState& before, const PlateState& after) {
    if (before.along * after.along < 0) stalls_.push_back(time + kStep * before.along / (before.along - after.along));
    lowest_ = std::min(lowest_, after.angle);
    highest_ = std::max(highest_, after.angle);
    // A full turn against the way it goes is no rocking at the edge any more.
    if (after.angle > turn_low_ + 2 * pi) ups_ += 1, turn_low_ = turn_high_ = after.angle;
    if (after.angle < turn_high_ - 2 * pi) downs_ += 1, turn_low_ = turn_high_ = after.angle;
    turn_low_ = std::min(turn_low_, after.angle);
    turn_high_ = std::max(turn_high_, after.angle);
    seconds_ += kStep;
  }

  PlateFall result() const {
    PlateFall fall;
    fall.stall_interval = mean_interval(stalls_);
    if (highest_ - lowest_ < 2 * pi) {
      fall.period = 2 * fall.stall_interval;
    } else if (ups_ == 0 || downs_ == 0) {
      fall.regime = PlateRegime::kTumble;
      fall.period = seconds_ * pi / (highest_ - lowest_);
    } else {
      fall.regime = PlateRegime::kMixed;
    }
    return fall;
  }

 private:
  std::vector<double> stalls_;  // zeros of the velocity along the plate
  double lowest_ = 1e300, highest_ = -1e300;
  double turn_low_ = 1e300, turn_high_ = -1e300;
  int ups_ = 0, downs_ = 0;  // full turns
  double seconds_ = 0;
};

}  // namespace

PlateState plate_rate(double inertia, const PlateState& s) {
  const double speed = std::hypot(s.along, s.across);
  // At rest the ratios have no value and nothing pulls.
  const double over = speed > 0 ? 1 / speed : 0;
  const double circulation = 2 / pi * (-kTranslationalLift * s.along * s.across * over + kRotationalLift * s.spin);
  const double drag = (kDragMean - kDragSwing * (s.along * s.along - s.across * s.across) * over * over) * speed / pi;
  const double sine = std::sin(s.angle), cosine = std::cos(s.angle);
  PlateState rate;
  rate.x = s.along * cosine - s.across * sine;
  rate.y = s.along * sine + s.across * cosine;
  rate.angle = s.spin;
  rate.along = ((inertia + 1) * s.spin * s.across - circulation * s.across - sine - drag * s.along) / inertia;
  rate.across = (-inertia * s.spin * s.along + circulation * s.along - cosine - drag * s.across) / (inertia + 1);
  rate.spin =
      4 / (inertia + 0.5) * (-s.along * s.across - (kDampingLinear + kDampingQuadratic * std::abs(s.spin)) * s.spin);
  return rate;
}

Result<PlateFall> watch_plate(double inertia, double from, double to) {
  auto good = flow::check_ranges(
      "plate", {{"inertia", inertia, 0.01, 100}, {"from", from, 0, to}, {"to", to, from + kStep, 100000}});
  if (!good) return good.error();
  PlateState state;
  state.angle = 0.2;
  Watch watch;
  const auto steps = static_cast<long long>(std::llround(to / kStep));
  for (long long k = 0; k < steps; ++k) {
    const double time = static_cast<double>(k) * kStep;
    const PlateState next = step(inertia, state);
    if (time >= from) watch.see(time, state, next);
    state = next;
  }
  return watch.result();
}

}  // namespace wisp
