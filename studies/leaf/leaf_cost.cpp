#include "studies/leaf/leaf_cost.hpp"

#include <cmath>

#include "simulate/leaf/leaf_constants.hpp"
#include "simulate/leaf/leaf_stepper.hpp"

namespace wisp {
namespace {

thread_local std::int64_t operations = 0;

struct Counted {
  double value = 0;

  Counted() = default;
  explicit Counted(double number) : value(number) {}
};

Counted counted(double value) {
  ++operations;
  return Counted(value);
}
Counted operator+(Counted a, Counted b) { return counted(a.value + b.value); }
Counted operator-(Counted a, Counted b) { return counted(a.value - b.value); }
Counted operator*(Counted a, Counted b) { return counted(a.value * b.value); }
Counted operator/(Counted a, Counted b) { return counted(a.value / b.value); }
Counted operator-(Counted a) { return counted(-a.value); }
Counted sqrt(Counted a) { return counted(std::sqrt(a.value)); }
Counted abs(Counted a) { return counted(std::abs(a.value)); }

leaf::Vec<Counted> counting(leaf::Vec<double> v) { return {Counted(v.x), Counted(v.y), Counted(v.z)}; }

leaf::Constants<Counted> counting(const leaf::Constants<double>& c) {
  leaf::Constants<Counted> counts;
  counts.carried = counting(c.carried);
  counts.inverse_mass = counting(c.inverse_mass);
  counts.moment = counting(c.moment);
  counts.inverse_moment = counting(c.inverse_moment);
  counts.mass = Counted(c.mass);
  counts.weight = Counted(c.weight);
  counts.lift = Counted(c.lift);
  counts.drag = Counted(c.drag);
  counts.drag_normal = Counted(c.drag_normal);
  counts.swirl_x = Counted(c.swirl_x);
  counts.swirl_y = Counted(c.swirl_y);
  counts.damping_spin = counting(c.damping_spin);
  counts.damping_speed = counting(c.damping_speed);
  return counts;
}

leaf::State<Counted> some_state() {
  leaf::State<Counted> state;
  state.attitude.w = Counted(1);
  state.velocity = counting(leaf::Vec<double>{0.2, 0.5, -0.3});
  state.spin = counting(leaf::Vec<double>{3, 1, 0.5});
  return state;
}

template <class Work>
std::int64_t count(Work work) {
  operations = 0;
  work();
  return operations;
}

}  // namespace

LeafCost count_leaf_operations(const Leaf& leaf) {
  const leaf::Constants<Counted> constants = counting(leaf::constants_of(leaf));
  const leaf::State<Counted> state = some_state();
  const auto rate = [&](const leaf::State<Counted>& s, double) { return leaf::rate_of(constants, s, {}); };
  LeafCost cost;
  cost.evaluation = count([&] { rate(state, 0); });
  const Counted h(1.0 / 60);
  cost.step = count([&] { leaf::classical_step(state, h, rate); });
  return cost;
}

}  // namespace wisp
