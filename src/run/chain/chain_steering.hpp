#pragma once
// Steers a falling body to a target at a given time by the choice of segments at joins: the chain's probability of a
// segment is multiplied by the probability that the segment leads to the target (J. L. Doob's h-transform, 1957). The
// latter is approximated by a normal distribution around the walk's expected displacement, wider the more time is left
// (ChainDrift in wisp/model/chain.hpp).

#include <span>

#include "run/chain/chain_lane.hpp"

namespace wisp {

/// Number of candidates drawn per mode if all segments of the mode may follow (breadth 0).
inline constexpr std::uint32_t kAnyOf = 8;

/// Approximates e^−x with heavier tails: (1 + x/256)^−256. Precondition: x >= 0.
template <class Real>
inline Real falling_off(Real x) {
  Real power = Real(1.0f) / (Real(1.0f) + x * Real(1.0f / 256.0f));
  for (int k = 0; k < 8; ++k) power = power * power;
  return power;
}

template <class Real>
class ChainSteering {
 public:
  using Mover = ChainMover<Real>;
  using Lane = ChainLane<Real>;
  using Body = BodyState<Real>;

  /// Allocates room for the candidates of one join.
  ChainSteering(const ChainProgram& program, bool steers, Arena& arena) {
    if (!steers) return;
    per_mode_ = program.breadth > 0 ? static_cast<std::uint32_t>(program.breadth) : kAnyOf;
    candidates_ = arena.take<Candidate>(static_cast<std::size_t>(program.modes) * per_mode_);
  }

  /// Draws the successor of the lane's segment, which ends at `body`. Updates lane.state, the Markov chain's state.
  std::uint32_t draw(const Mover& mover, const ChainProgram& program, const ChainChoice& choice, Lane& lane,
                     const Body& body, const ChainWords& words) {
    const auto modes = static_cast<std::uint32_t>(program.modes);
    const std::uint32_t state = Mover::index(lane.state, program.states());
    const std::uint32_t before = Mover::index(lane.segment, program.segments());
    std::size_t count = 0;
    Real least(0.0f);
    const Bell bell = bell_of(program, lane);
    for (std::uint32_t mode = 0; mode < modes; ++mode) {
      const float chance = choice.chance_of(program, state, mode);
      if (!(chance > 0.0f)) continue;
      for (std::uint32_t k = 0; k < per_mode_; ++k) {
        const std::uint32_t segment = choice.candidate(program, before, mode, k, words);
        Candidate& one = candidates_[count];
        one = aim(mover, program, lane, body, segment, bell);
        one.mode = mode;
        one.weight = Real(chance);
        if (count == 0 || one.miss < least) least = one.miss;
        ++count;
      }
    }
    const Candidate& drawn = candidates_[pick(choice, count, least, words)];
    lane.state = Real(static_cast<float>(program.state_after(state, drawn.mode)));
    return drawn.segment;
  }

  /// Returns the expected position of a lane's body at the target time: on its segment or, if the segment ends before,
  /// at the segment's end plus its lead and the mean drift.
  static Vector3<Real> expected(const Mover& mover, const ChainProgram& program, const Lane& lane) {
    const std::uint32_t segment = Mover::index(lane.segment, program.segments()), steps = program.steps(segment);
    const std::uint32_t row = Mover::index(lane.row, steps + 1);
    const Real beyond = lane.left - Real(static_cast<float>(steps - row));
    const bool ends = beyond > Real(0.0f);
    const Real left = ends ? beyond * Real(program.step_seconds) : Real(0.0f);
    const Real kept = left / (left + Real(program.memory) + Real(program.step_seconds));
    auto at = mover.place_at(lane, ends ? steps : row + Mover::index(lane.left, steps - row + 1),
                             program.lead.data() + std::size_t{3} * segment,
                             kept * Real(program.lead_scale / program.position_scale));
    for (std::size_t axis = 0; axis < 3; ++axis) at[axis] = at[axis] + Real(program.drift[axis]) * left;
    return at;
  }

 private:
  struct Candidate {
    std::uint32_t segment = 0;
    std::uint32_t mode = 0;
    Real weight{};
    Real miss{};  // half the squared distance from the target, in variances
  };

  // 1 / (2 · variance) of the position at the target time, one per join: else far targets would favour short segments.
  struct Bell {
    Real ground{};
    Real height{};
  };

  static Bell bell_of(const ChainProgram& program, const Lane& lane) {
    const Real beyond = lane.left - Real(program.mean_steps);
    const Real left = beyond > Real(0.0f) ? beyond * Real(program.step_seconds) : Real(0.0f);
    const Real near = lane.near * lane.near;
    return {Real(0.5f) / (near + Real(program.spread_ground) * left),
            Real(0.5f) / (near + Real(program.spread_height) * left)};
  }

  // Computes a candidate's expected miss at the target time. Its probability to lead to the target is about e^−miss.
  static Candidate aim(const Mover& mover, const ChainProgram& program, const Lane& lane, const Body& body,
                       std::uint32_t segment, const Bell& bell) {
    const HalfTurn<Real> half = mover.turn_to(segment, body);
    Lane there;
    mover.place(there, segment, body.position, half.cos, half.sin);
    there.left = lane.left;
    const auto miss = taken(lane.target, expected(mover, program, there));
    const Real ground = miss[0] * miss[0] + miss[1] * miss[1];
    return {.segment = segment, .miss = ground * bell.ground + miss[2] * miss[2] * bell.height};
  }

  std::size_t pick(const ChainChoice& choice, std::size_t count, Real least, const ChainWords& words) {
    Real total(0.0f);
    std::size_t best = 0;
    for (std::size_t k = 0; k < count; ++k) {
      Candidate& one = candidates_[k];
      one.weight = one.weight * falling_off(one.miss - least);
      total = total + one.weight;
      if (one.weight > candidates_[best].weight) best = k;
    }
    if (!choice.has_chance()) return best;
    Real word = Real(static_cast<float>(words.mode >> 8) * (1.0f / 16777216.0f)) * total;
    for (std::size_t k = 0; k < count; ++k) {
      if (word < candidates_[k].weight) return k;
      word = word - candidates_[k].weight;
    }
    return best;
  }

  std::span<Candidate> candidates_;
  std::uint32_t per_mode_ = 0;
};

}  // namespace wisp
