#pragma once
// The rule of extinction (wisp/model/extinction.hpp), applied block by block. The state of an instance: damage, 0 … 1;
// whether it is lit, 1 or 0; and the size at which it is drawn, 0 … 1. A step takes three operations; in an event, more
// for each component and displayed output.

#include <cstdint>
#include <span>

#include "run/lanes/lanes.hpp"
#include "run/state/arena.hpp"
#include "run/state/channels.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// The rule of extinction, compiled for stepping.
struct ExtinctionProgram {
  bool present = false;  ///< false: instances are never extinguished, and the fields below are unused
  std::int32_t input = 0;
  bool vector = false;  ///< whether `input` is the first component of a wind vector
  float level = 0;
  float most = 0;  ///< upper limit of the wind
  float base = 0;  ///< in wind of at least the level a step adds the damage base + slope · wind
  float slope = 0;
  float recovery = 0;              ///< reduction of the damage per step in weaker wind
  float stirs = 0;                 ///< wind above which the replay of a re-ignition ends
  float join = 0;                  ///< per step of a re-ignition, reduction of the share of Bank::State::offset applied
  std::span<float> sizes;          ///< kEventEnds; then for each event its sizes and, per step of its cross-over to the
                                   ///< dynamics, the negated share reached, at last −1 = kEventEnds
  std::span<float> shapes;         ///< components in the plane for every size; empty: no event has shapes
  std::span<std::uint32_t> dying;  ///< start index of each event
  std::span<std::uint32_t> catching;  ///< start index of each event
};

/// Value in `sizes` that ends an event.
inline constexpr float kEventEnds = -1;

/// Index into `sizes` that stands for no event.
inline constexpr float kNoEvent = 0;

ExtinctionProgram make_extinction_program(const Model& model, Arena& arena);

/// Hashes the program, continuing from the hash `before`; returns `before` without a rule.
std::uint64_t hash_of(const ExtinctionProgram& program, std::uint64_t before);

/// Returns the magnitude of the rule's wind, at most rule.most; lanes_of(input) reads an input. NaN counts as 0.
template <class N, class LanesOf>
inline Reals<N> blowing(const ExtinctionProgram& rule, const LanesOf& lanes_of) {
  if (rule.vector) return LevelVector<N>(lanes_of(rule.input), lanes_of(rule.input + 1), rule.most).length;
  return smaller(magnitude(number_or(lanes_of(rule.input), all<Reals<N>>(0.0f))), all<Reals<N>>(rule.most));
}

/// The state of a block's instances, [lane].
template <class Real>
struct LifeLanes {
  Real* wind;  ///< magnitude of the wind in this step
  Real* harm;
  Real* lit;
};

/// Interpolates linearly: `from` at share 0, `to` at share 1.
template <class Real>
inline Real nearer(Real from, Real to, float share) {
  return share == 1.0f ? to : from + Real(share) * (to - from);
}

/// Advances the damage of a block's instances by one step, and sets `lit` to 0 where it reaches 1.
template <class N>
inline void live(const ExtinctionProgram& rule, const LifeLanes<typename N::Real>& life) {
  const auto zero = all<Reals<N>>(0.0f), one = all<Reals<N>>(1.0f);
  const auto wind = load<Reals<N>>(life.wind), harm = load<Reals<N>>(life.harm);
  const auto pick = [](const auto& a, const auto& b, const auto& x, const auto& y) { return a < b ? x : y; };
  const auto blown = all<Reals<N>>(rule.base) + all<Reals<N>>(rule.slope) * wind;
  const auto done = each(pick, wind, all<Reals<N>>(rule.level), all<Reals<N>>(-rule.recovery), blown);
  const auto next = hold(harm + done, zero, one);
  const auto lit = each(pick, next, one, load<Reals<N>>(life.lit), zero);
  store(next, life.harm);
  store(lit, life.lit);
}

/// Multiplies displayed outputs, [output][lane], by the sizes of their instances; size 0 gives 0 even for NaN.
template <class N>
inline void shrink(const Reals<N>& size, std::size_t outputs, typename N::Real* shown) {
  const auto zero = all<Reals<N>>(0.0f);
  const auto pick = [](const auto& a, const auto& b, const auto& x, const auto& y) { return a < b ? x : y; };
  for (std::size_t i = 0; i < outputs; ++i, shown += N::kLanes) {
    store(each(pick, zero, size, size * load<Reals<N>>(shown), zero), shown);
  }
}

template <class N>
inline Reals<N> size_between(const Reals<N>& from, const Reals<N>& to, float share) {
  return from + all<Reals<N>>(share) * (to - from);
}

}  // namespace wisp
