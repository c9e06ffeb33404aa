#pragma once
// Plays residuals as they were (DrawnResiduals), lane by lane. An instance's state is the row that it is at and how
// long ago it jumped there; jumps are decided by comparisons and taken by counted random words.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>

#include "run/arx/drawn_program.hpp"
#include "run/bank/moment.hpp"
#include "run/chain/rigid.hpp"

namespace wisp {

/// The input of a lane as the residuals see it, in channel units.
template <class Real>
struct DrawnWind {
  Real wind{};
  Real trend{};
};

template <class N>
class DrawnLanes {
 public:
  using Real = typename N::Real;
  static constexpr int kLanes = N::kLanes;

  DrawnLanes(const DrawnProgram& program, int blocks, Arena& arena) : program_(program) {
    if (program.empty()) return;
    state_ = arena.take<Real>(static_cast<std::size_t>(blocks) * 2 * kLanes);
    factor_ = arena.take<float>(static_cast<std::size_t>(program.sides) * program.outputs);
  }

  bool empty() const { return program_.empty(); }
  bool driven() const { return program_.driven(); }

  /// Sets the scale of the noise. Returns whether there is any.
  bool set_noise(float scale) {
    std::transform(program_.factor.begin(), program_.factor.end(), factor_.begin(),
                   [scale](float factor) { return scale * factor; });
    return !empty() && scale != 0;
  }

  /// A newborn jumps in its first step.
  void start(int block, int lane) {
    place(block)[lane] = Real(0.0f);
    age(block)[lane] = Real(static_cast<float>(program_.longest));
  }

  /// Moves every lane of a block on and puts what is added to the outputs into `shocks`, [output][lane]; `before` is
  /// what the outputs were in the last step.
  void step(int block, const DrawnWind<Real> (&winds)[kLanes], const Real* before, const Moment<N>& moment,
            Real* shocks) {
    std::uint32_t words[4][kLanes];
    bool drawn = false;
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto at = static_cast<std::uint32_t>(value_of(place(block)[lane]));
      const auto steps = static_cast<std::uint32_t>(value_of(age(block)[lane]));
      std::uint32_t next = at + 2;
      if (stays(at, steps, winds[lane])) {
        age(block)[lane] = Real(static_cast<float>(steps + 1));
      } else {
        if (!drawn) draw(moment, words);
        drawn = true;
        const std::uint32_t own[4] = {words[0][lane], words[1][lane], words[2][lane], words[3][lane]};
        next = jump(own, winds[lane], before + lane);
        age(block)[lane] = Real(1.0f);
      }
      place(block)[lane] = Real(static_cast<float>(next));
      play(next, shocks + lane);
    }
  }

  std::size_t lane_values() const { return empty() ? 0 : 2; }

  template <class Visit>
  void visit_lane(int block, int lane, Visit visit) {
    if (empty()) return;
    const std::size_t places = 2 * program_.left.size();
    const bool mirrors = program_.mirrors();
    visit(place(block)[lane], 0.0f, static_cast<float>(places - (mirrors ? 1 : 2)), mirrors ? 1.0f : 2.0f);
    visit(age(block)[lane], 0.0f, static_cast<float>(program_.longest), 1.0f);
  }

 private:
  // Twice the row, and one more where its mirror image is played.
  Real* place(int block) { return state_.data() + static_cast<std::size_t>(block) * 2 * kLanes; }
  Real* age(int block) { return place(block) + kLanes; }

  static bool within(const Real& difference, float tolerance) {
    return value_of(difference) <= tolerance && value_of(difference) >= -tolerance;
  }

  bool stays(std::uint32_t at, std::uint32_t steps, const DrawnWind<Real>& now) const {
    const std::uint32_t row = at / 2;
    if (steps >= program_.longest || program_.left[row] == 0) return false;
    if (steps < program_.shortest || !program_.driven()) return true;
    const bool mirrored = at % 2 != 0;
    const Real wind(program_.wind[row + 1]), trend(program_.trend[row + 1]);
    return within(mirrored ? wind + now.wind : wind - now.wind, program_.tolerance) &&
           within(mirrored ? trend + now.trend : trend - now.trend, program_.tolerance);
  }

  void draw(const Moment<N>& moment, std::uint32_t (&words)[4][kLanes]) const {
    Words<N> counters[4], drawn[4];
    random_counters<N>(moment.counters, counters);
    random_group<N>(*moment.keys, counters, 0, drawn);
    for (int k = 0; k < 4; ++k) {
      typename N::Word lanes[kLanes];
      store(drawn[k], lanes);
      for (int lane = 0; lane < kLanes; ++lane) words[k][lane] = value_of(lanes[lane]);
    }
  }

  // Rows whose wind is nearest in strength: all that are equal, and at least kNearRows.
  struct Near {
    std::uint32_t begin;
    std::uint32_t end;
  };

  float key(std::uint32_t row) const {
    const float wind = program_.wind[row];
    return program_.mirrors() && wind < 0 ? -wind : wind;
  }

  Near near(float strength) const {
    const auto rows = static_cast<std::uint32_t>(program_.order.size());
    const auto first = [&](bool above) {
      std::uint32_t low = 0, high = rows;
      while (low < high) {
        const std::uint32_t middle = (low + high) / 2;
        const float at = key(program_.order[middle]);
        if (above ? at <= strength : at < strength) {
          low = middle + 1;
        } else {
          high = middle;
        }
      }
      return low;
    };
    const std::uint32_t begin = first(false), end = first(true), middle = (begin + end) / 2;
    const std::uint32_t half = kNearRows / 2;
    return {middle > half ? (begin < middle - half ? begin : middle - half) : 0,
            middle + half < rows ? (end > middle + half ? end : middle + half) : rows};
  }

  // Half of an instance's lean, as it weighs.
  Real lean(std::size_t half, const Real* before) const {
    const auto part = [&](std::size_t k) { return Real(program_.lean[k]) * before[program_.lean_of[k] * kLanes]; };
    return part(2 * half) + part(2 * half + 1);
  }

  // How far a row is apart is the sum of its differences' sizes: as good a choice as their squares make, for half the
  // operations. The wind's rise is looked at first, since it tells most rows apart.
  static Real farther(const Real& apart, const Real& difference) {
    return value_of(difference) < 0 ? apart - difference : apart + difference;
  }

  std::uint32_t jump(const std::uint32_t (&words)[4], const DrawnWind<Real>& now, const Real* before) const {
    if (!program_.driven()) return 2 * scaled(words[0], static_cast<std::uint32_t>(program_.left.size()));
    const float wind = value_of(now.wind);
    const bool from_right = wind < 0 && program_.mirrors();
    const Near around = near(from_right ? -wind : wind);
    const bool leans = !program_.leans.empty();
    const Real sway = leans ? lean(0, before) : Real(0.0f), rise = leans ? lean(1, before) : Real(0.0f);
    std::uint32_t best = 0;
    float least = std::numeric_limits<float>::max();
    for (int k = 0; k < kCandidates; ++k) {
      const std::uint32_t half = k % 2 == 0 ? words[k / 2] << 16 : words[k / 2] & 0xffff0000U;
      const std::uint32_t row = program_.order[around.begin + scaled(half, around.end - around.begin)];
      const bool mirrored = program_.mirrors() && from_right != (program_.wind[row] < 0);
      const Real row_wind(program_.wind[row]), row_trend(program_.trend[row]);
      const Real turned = mirrored ? row_trend + now.trend : row_trend - now.trend;
      Real apart = value_of(turned) < 0 ? -turned : turned;
      if (!(value_of(apart) < least)) continue;
      apart = farther(apart, mirrored ? row_wind + now.wind : row_wind - now.wind);
      if (!(value_of(apart) < least)) continue;
      if (leans) {
        const Real row_sway(program_.leans[2 * row]), row_rise(program_.leans[2 * row + 1]);
        apart = farther(apart, mirrored ? row_sway + sway : row_sway - sway);
        if (!(value_of(apart) < least)) continue;
        apart = farther(apart, row_rise - rise);
        if (!(value_of(apart) < least)) continue;
      }
      least = value_of(apart);
      best = 2 * row + (mirrored ? 1 : 0);
    }
    return best;
  }

  // A word as a whole number below `count`.
  static std::uint32_t scaled(std::uint32_t word, std::uint32_t count) {
    return static_cast<std::uint32_t>((static_cast<std::uint64_t>(word) * count) >> 32);
  }

  void play(std::uint32_t at, Real* shock) const {
    const auto ny = static_cast<std::size_t>(program_.outputs);
    const std::size_t side = at % 2 != 0 ? ny : 0;
    const float* row = program_.rows.data() + (at / 2) * ny;
    for (std::size_t i = 0; i < ny; ++i) {
      const Real value(row[program_.from[side + i]]);
      const float factor = factor_[side + i];
      shock[i * kLanes] = factor == 1 ? value : Real(factor) * value;
    }
  }

  DrawnProgram program_;
  std::span<Real> state_;
  std::span<float> factor_;  // the program's, times the scale of the noise
};

}  // namespace wisp
