#pragma once
// Plays residuals as they were (DrawnResiduals), lane by lane. An instance's state is the row that it is at, how long
// ago it jumped there, the blocks that it played before, and its input's recent past. Jumps are decided by comparisons
// and taken by counted random words.
//
// Where a jump leads is a search for the rows whose input's past is nearest (D. Kovar, M. Gleicher, F. Pighin, "Motion
// Graphs", SIGGRAPH 2002, and S. Clavet, "Motion Matching", GDC 2016, are its kin in animation): one way down a k-d
// tree to a leaf, whose rows are compared. It is done only in steps in which going on costs more than the tolerance.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "run/arx/drawn_program.hpp"
#include "run/bank/moment.hpp"
#include "run/bank/sample_ring.hpp"

namespace wisp {

template <class N>
class DrawnLanes {
 public:
  using Real = typename N::Real;
  static constexpr int kLanes = N::kLanes;

  DrawnLanes(const DrawnProgram& program, int blocks, Arena& arena) : program_(program) {
    if (program.empty()) return;
    state_ = arena.take<Real>(static_cast<std::size_t>(blocks) * kStateValues * kLanes);
    factor_ = arena.take<float>(static_cast<std::size_t>(program.sides) * program.outputs);
    past_ = SampleRing<N>(blocks, program.depth, 1, arena);
  }

  bool empty() const { return program_.empty(); }

  /// Sets the scale of the noise. Returns whether there is any.
  bool set_noise(float scale) {
    std::transform(program_.factor.begin(), program_.factor.end(), factor_.begin(),
                   [scale](float factor) { return scale * factor; });
    return !empty() && scale != 0;
  }

  /// A newborn jumps in its first step; nothing blew before.
  void start(int block, int lane) {
    for (int value = 0; value < kStateValues; ++value) state(block, value)[lane] = Real(0.0f);
    state(block, kAge)[lane] = Real(static_cast<float>(program_.longest));
    for (int lag = 0; lag < past_.depth(); ++lag) past(block, static_cast<std::uint32_t>(lag))[lane] = Real(0.0f);
  }

  /// Moves every block's past by one sample.
  void turn() { past_.turn(); }

  /// Takes in the input of a block's step, whether there is noise or not: [regressor][lane].
  void hear(int block, const Real* regressors) {
    if (!program_.driven()) return;
    auto wind = load<Reals<N>>(regressors + program_.toward * kLanes);
    if (program_.against >= 0) wind = wind - load<Reals<N>>(regressors + program_.against * kLanes);
    store(wind, past(block, 0));
  }

  /// Moves every lane of a block on and puts what is added to the outputs into `shocks`, [output][lane].
  void step(int block, const Moment<N>& moment, Real* shocks) {
    std::uint32_t words[4][kLanes];
    bool drawn = false;
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto at = whole(state(block, kPlace)[lane]);
      const auto steps = whole(state(block, kAge)[lane]);
      const bool forced = steps >= program_.longest || program_.left[at / 2] == 0;
      const Real ahead = forced || !program_.driven() ? Real(0.0f) : apart(block, lane, at + 2);
      std::uint32_t next = at + 2;
      if (forced || value_of(ahead) > program_.tolerance) {
        if (!drawn) draw(moment, words);
        drawn = true;
        const std::uint32_t own[4] = {words[0][lane], words[1][lane], words[2][lane], words[3][lane]};
        next = jump(block, lane, own, forced ? nullptr : &ahead);
      }
      if (next == at + 2 && !forced) {
        state(block, kAge)[lane] = Real(static_cast<float>(steps + 1));
      } else {
        remember(block, lane);
        state(block, kAge)[lane] = Real(1.0f);
      }
      state(block, kPlace)[lane] = Real(static_cast<float>(next));
      play(next, shocks + lane);
    }
  }

  std::size_t lane_values() const {
    return empty() ? 0 : static_cast<std::size_t>(kStateValues) + static_cast<std::size_t>(past_.depth());
  }

  /// `low` and `high` bound the input.
  template <class Visit>
  void visit_lane(int block, int lane, float low, float high, Visit visit) {
    if (empty()) return;
    const std::size_t places = 2 * program_.left.size();
    const bool mirrors = program_.mirrors();
    const auto last = static_cast<float>(places - (mirrors ? 1 : 2));
    for (int value = 0; value < kStateValues; value += 2) {
      visit(state(block, value + kPlace)[lane], 0.0f, last, mirrors ? 1.0f : 2.0f);
      visit(state(block, value + kAge)[lane], 0.0f, static_cast<float>(program_.longest), 1.0f);
    }
    for (int lag = 0; lag < past_.depth(); ++lag) {
      visit(past(block, static_cast<std::uint32_t>(lag))[lane], low, high);
    }
  }

 private:
  // Twice the row, and one more where its mirror image is played; steps since the jump; and the same of the last row of
  // every block before, the newest first.
  static constexpr int kPlace = 0;
  static constexpr int kAge = 1;
  static constexpr int kStateValues = 2 * (1 + kRecentBlocks);

  Real* state(int block, int value) { return state_.data() + (block * kStateValues + value) * kLanes; }
  const Real* state(int block, int value) const { return state_.data() + (block * kStateValues + value) * kLanes; }
  Real* past(int block, std::uint32_t lag) { return past_.sample(block, lag); }
  const Real* past(int block, std::uint32_t lag) const { return past_.sample(block, lag); }
  static std::uint32_t whole(const Real& value) { return static_cast<std::uint32_t>(value_of(value)); }

  void remember(int block, int lane) {
    for (int value = kStateValues - 1; value >= 2; --value) state(block, value)[lane] = state(block, value - 2)[lane];
  }

  bool is_recent(int block, int lane, std::uint32_t row) const {
    for (int value = 0; value < kStateValues; value += 2) {
      const std::uint32_t last = whole(state(block, value)[lane]) / 2, steps = whole(state(block, value + 1)[lane]);
      if (steps > 0 && row <= last + 1 && row + steps > last) return true;
    }
    return false;
  }

  // How far the input's past is from what it was at a place: the sum over lags of the differences' sizes, as good a
  // choice as their squares make for half the operations.
  Real apart(int block, int lane, std::uint32_t at) const {
    const float* wind = program_.wind.data() + program_.now[at / 2];
    const bool mirrored = at % 2 != 0;
    Real sum(0.0f);
    for (std::size_t k = 0; k < program_.lags.size(); ++k) {
      const Real then(*(wind - program_.lags[k])), heard = past(block, program_.lags[k])[lane];
      const Real difference = mirrored ? then + heard : then - heard;
      sum = value_of(difference) < 0 ? sum - difference : sum + difference;
    }
    return sum;
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

  bool from_right(int block, int lane) const {
    if (!program_.mirrors()) return false;
    Real sum(0.0f);
    for (std::uint32_t lag : program_.lags) sum = sum + past(block, lag)[lane];
    return value_of(sum) < 0;
  }

  // Rows of a leaf.
  struct Leaf {
    std::uint32_t begin;
    std::uint32_t end;
  };

  // Down the tree. Where the past lies within the margin of a node's value chance takes the side: rows of calm, which
  // are all alike, are so all within reach.
  Leaf leaf(int block, int lane, bool turned, std::uint32_t word) const {
    Leaf out{0, static_cast<std::uint32_t>(program_.order.size())};
    for (std::size_t node = 0; node < program_.nodes.size(); word = word << 1 | word >> 31) {
      const PastNode& one = program_.nodes[node];
      const Real heard = past(block, program_.lags[one.lag])[lane], value(one.value);
      const float away = value_of(turned ? Real(0.0f) - value - heard : heard - value);
      const bool near = away <= program_.margin && away >= -program_.margin;
      const bool right = near ? word >> 31 != 0 : away > 0;
      const std::uint32_t middle = out.begin + (out.end - out.begin) / 2;
      (right ? out.begin : out.end) = middle;
      node = 2 * node + (right ? 2 : 1);
    }
    return out;
  }

  // The nearest of the rows that were looked at, the best first.
  struct Nearest {
    std::array<float, kNearestRows> apart{};
    std::array<std::uint32_t, kNearestRows> place{};
    int count = 0;

    void take(float away, std::uint32_t at) {
      int k = count;
      while (k > 0 && away < apart[k - 1]) --k;
      if (k == kNearestRows) return;
      if (count < kNearestRows) ++count;
      for (int behind = count - 1; behind > k; --behind) {
        apart[behind] = apart[behind - 1];
        place[behind] = place[behind - 1];
      }
      apart[k] = away;
      place[k] = at;
    }
  };

  // Where to go: on, where `ahead` says what that costs and it is not worse than the best by more than the tolerance,
  // else to one of the nearest.
  std::uint32_t jump(int block, int lane, const std::uint32_t (&words)[4], const Real* ahead) const {
    if (!program_.driven()) return 2 * scaled(words[0], static_cast<std::uint32_t>(program_.left.size()));
    const bool right = from_right(block, lane);
    const Leaf found = leaf(block, lane, right, words[0]);
    Nearest nearest;
    std::uint32_t at = 0;
    for (std::uint32_t k = found.begin; k < found.end; ++k) {
      const std::uint32_t row = program_.order[k];
      at = 2 * row + (right != (program_.turned[row] != 0) ? 1 : 0);
      if (is_recent(block, lane, row)) continue;
      nearest.take(value_of(apart(block, lane, at)), at);
    }
    const std::uint32_t on = whole(state(block, kPlace)[lane]) + 2;
    if (nearest.count == 0) return ahead ? on : at;
    if (ahead && value_of(*ahead - Real(nearest.apart[0])) <= program_.tolerance) return on;
    return nearest.place[scaled(words[1], static_cast<std::uint32_t>(nearest.count))];
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
  SampleRing<N> past_;       // of the input
};

}  // namespace wisp
