#pragma once
// Steps blocks of instances of a switched ARX model. Every lane has a mode of its own; coefficients are picked lane by
// lane from a table, so that the arithmetic is that of a single mode, whatever the number of modes. By regions, the
// affine functions of all modes come on top; by a Markov chain, one random word.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>

#include "run/arx/switched_program.hpp"
#include "run/bank/channel_history.hpp"
#include "run/bank/moment.hpp"
#include "run/chain/chain_lane.hpp"
#include "run/chain/rigid.hpp"
#include "wisp/run/bank.hpp"

namespace wisp {

template <class N>
class SwitchedStepper : public ChannelHistory<N> {
 public:
  using typename ChannelHistory<N>::Real;
  using ChannelHistory<N>::kLanes;
  /// Frames over which a cost is averaged: every frame costs the same.
  static constexpr int kCountedFrames = 1;

  /// Where the model's deviations are measured from.
  static OperatingPoint operating_point(const SwitchedArxModel& model) { return {model.output_mean, model.input_mean}; }

  /// Errors: what single precision can't step.
  static Result<void> check(const Model& model, const SwitchedArxModel& switched) {
    return check_switched_program(model, switched);
  }

  SwitchedStepper(const Model& model, const SwitchedArxModel& switched, const Channels& channels, int blocks,
                  Arena& arena)
      : SwitchedStepper(make_switched_program(model, switched, arena), channels, blocks, arena) {}

  /// Sets the scale of the residual noise. At 0 there is no chance in the modes either: a Markov chain takes the
  /// likeliest step.
  void set_noise(float scale) {
    chance_ = scale > 0;
    noisy_ = false;
    std::transform(program_.shock_size.begin(), program_.shock_size.end(), shock_size_.begin(), [&](float size) {
      noisy_ |= scale * size != 0;
      return scale * size;
    });
  }

  /// Makes the newest sample of a block.
  void step(int block, const Moment<N>& moment) {
    std::uint32_t mode[kLanes] = {};
    if (program_.markov) {
      walk(block, moment, mode);
    } else {
      classify(block, mode);
    }
    for (int lane = 0; lane < kLanes; ++lane) modes_[block * kLanes + lane] = Real(static_cast<float>(mode[lane]));
    if (noisy_) draw(moment);
    Real* newest = ring_.sample(block, 0);
    auto held = all<Words<N>>(0U);
    std::uint32_t tap = 0, shock = 0;
    for (int i = 0; i < program_.outputs; ++i) {
      auto sum = pick(program_.constant.data() + i * program_.modes, mode);
      for (; tap < program_.row_end[i]; ++tap) {
        const Real* sample = ring_.sample(block, program_.taps[tap].lag) + program_.taps[tap].channel * kLanes;
        sum = sum + pick(program_.coefficients.data() + tap * program_.modes, mode) * load<Reals<N>>(sample);
      }
      for (; noisy_ && shock < program_.shock_end[i]; ++shock) {
        const Real* drawn = shocks_.data() + program_.shock[shock] * kLanes;
        sum = sum + pick(shock_size_.data() + shock * program_.modes, mode) * load<Reals<N>>(drawn);
      }
      const OutputChannel& channel = channels_.outputs[i];
      const auto value = hold(sum, all<Reals<N>>(channel.low), all<Reals<N>>(channel.high));
      held = held | differ(value, sum);
      store(settle(value), newest + i * kLanes);
    }
    store(held, moment.held);
  }

  /// Puts one lane to the operating point, before its first mode.
  void start(int block, int lane, const Moment<N>&) {
    this->start_history(block, lane);
    modes_[block * kLanes + lane] = Real(kNoMode);
  }

  /// The mode that made the newest sample; none before the first step.
  std::optional<int> mode(int block, int lane) const {
    const int mode = static_cast<int>(value_of(modes_[block * kLanes + lane]));
    if (mode < 0) return {};
    return mode;
  }

  /// Coefficients that a step multiplies by: those of one mode, and of the regions of all.
  std::int64_t multiply_adds() const {
    return static_cast<std::int64_t>(program_.taps.size() + program_.region_weights.size());
  }

  /// Numbers of state that one lane holds.
  std::size_t lane_values() const { return 1 + this->history_values(); }

  /// Calls visit(value, low, high) for each number of one lane's state, in an order that does not depend on where in
  /// the ring it lies: the way to save, check and restore it.
  template <class Visit>
  void visit_lane(int block, int lane, Visit visit) {
    visit(modes_[block * kLanes + lane], kNoMode, static_cast<float>(program_.modes - 1));
    this->visit_history(block, lane, visit);
  }

  /// Goes into the hash that tells models apart.
  std::uint64_t hash(std::uint64_t before) const { return hash_of(program_, before); }

 private:
  using ChannelHistory<N>::channels_;
  using ChannelHistory<N>::ring_;
  static constexpr float kNoMode = -1.0f;

  SwitchedStepper(const SwitchedProgram& program, const Channels& channels, int blocks, Arena& arena)
      : ChannelHistory<N>(program, channels, blocks, arena),
        program_(program),
        modes_(arena.take<Real>(static_cast<std::size_t>(blocks) * kLanes)),
        shocks_(arena.take<Real>(static_cast<std::size_t>(program.outputs) * kLanes)),
        shock_size_(arena.take<float>(program.shocks * static_cast<std::size_t>(program.modes))) {}

  // Every lane's number of its own mode.
  Reals<N> pick(const float* of_mode, const std::uint32_t (&mode)[kLanes]) const {
    Real picked[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) picked[lane] = Real(of_mode[mode[lane]]);
    return load<Reals<N>>(picked);
  }

  // Of the affine functions the largest, of equal ones the first.
  void classify(int block, std::uint32_t (&mode)[kLanes]) const {
    Real best[kLanes], score[kLanes];
    const float* weight = program_.region_weights.data();
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(program_.modes); ++k) {
      auto sum = all<Reals<N>>(program_.region_constant[k]);
      for (const SwitchedTap& tap : program_.region_taps) {
        sum = sum + all<Reals<N>>(*weight++) * load<Reals<N>>(ring_.sample(block, tap.lag) + tap.channel * kLanes);
      }
      store(sum, score);
      for (int lane = 0; lane < kLanes; ++lane) {
        if (k > 0 && !(score[lane] > best[lane])) continue;
        best[lane] = score[lane];
        mode[lane] = k;
      }
    }
  }

  // One step of every lane's Markov chain.
  void walk(int block, const Moment<N>& moment, std::uint32_t (&mode)[kLanes]) const {
    const auto modes = static_cast<std::uint32_t>(program_.modes);
    typename N::Word word[kLanes] = {};
    if (chance_) {
      Words<N> counters[4], words[4];
      random_counters<N>(moment.counters, counters);
      random_group<N>(*moment.keys, counters, static_cast<std::uint32_t>(program_.outputs + 3) / 4, words);
      store(words[0], word);
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      const int before = static_cast<int>(value_of(modes_[block * kLanes + lane]));
      const auto row = static_cast<std::size_t>(before < 0 ? program_.modes : before) * modes;
      const std::uint32_t* threshold = program_.thresholds.data() + row;
      mode[lane] = chance_ ? first_above(threshold, value_of(word[lane])) : likeliest(threshold, modes);
    }
  }

  static std::uint32_t first_above(const std::uint32_t* threshold, std::uint32_t word) {
    std::uint32_t mode = 0;
    while (threshold[mode] != kAnyWord && word >= threshold[mode]) ++mode;
    return mode;
  }

  static std::uint32_t likeliest(const std::uint32_t* threshold, std::uint32_t modes) {
    std::uint32_t best = 0, most = threshold[0];
    for (std::uint32_t mode = 1; mode < modes; ++mode) {
      if (threshold[mode] - threshold[mode - 1] <= most) continue;
      most = threshold[mode] - threshold[mode - 1];
      best = mode;
    }
    return best;
  }

  // Standard normal deviates for every output.
  void draw(const Moment<N>& moment) {
    Words<N> counters[4], words[4];
    random_counters<N>(moment.counters, counters);
    for (int i = 0; i < program_.outputs; ++i) {
      if (i % 4 == 0) random_group<N>(*moment.keys, counters, static_cast<std::uint32_t>(i / 4), words);
      store(normal_lanes<N>(words[i % 4]), shocks_.data() + i * kLanes);
    }
  }

  SwitchedProgram program_;
  std::span<Real> modes_;  // [block][lane]: what made the newest sample, or kNoMode
  std::span<Real> shocks_;
  std::span<float> shock_size_;  // the program's, scaled
  bool noisy_ = false;
  bool chance_ = true;
};

}  // namespace wisp
