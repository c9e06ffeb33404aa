#pragma once
// Steps blocks of instances of an ARX model, or of a switched one, whose modes are ARX models. Source: section 3.5 of
// the paper (one multiplication by the matrix of coefficients, histories in circular buffers); here the bank shares one
// place in the buffers, and what is zero costs nothing.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "run/arx/arx_program.hpp"
#include "run/arx/drawn_lanes.hpp"
#include "run/arx/mode_lanes.hpp"
#include "run/bank/channel_history.hpp"
#include "run/bank/moment.hpp"

namespace wisp {

/// `Modes` says which of the model's modes acts in each lane.
template <class N, class Modes = SingleMode<N>>
class ArxStepper : public ChannelHistory<N> {
 public:
  using typename ChannelHistory<N>::Real;
  using ChannelHistory<N>::kLanes;
  static constexpr int kCountedFrames = Modes::kCountedFrames;

  /// Where the model's deviations are measured from.
  template <class Dynamics>
  static OperatingPoint operating_point(const Dynamics& dynamics) {
    return {dynamics.output_mean, dynamics.input_mean};
  }

  /// Errors: what single precision can't step.
  template <class Dynamics>
  static Result<void> check(const Model& model, const Dynamics& dynamics) {
    return check_regression(regression_of(model, dynamics));
  }

  template <class Dynamics>
  ArxStepper(const Model& model, const Dynamics& dynamics, const Channels& channels, int blocks, Arena& arena)
      : ArxStepper(make_arx_program(model, dynamics, arena), Modes(model, dynamics, blocks, arena), channels, blocks,
                   arena) {}

  /// Sets the scale of the residual noise. At 0 there is no chance in the modes either.
  void set_noise(float scale) {
    modes_.set_chance(scale > 0);
    noisy_ = drawn_.set_noise(scale);
    if (!drawn_.empty()) return;
    std::fill(shaken_.begin(), shaken_.end(), std::uint8_t{0});
    for (std::size_t k = 0; k < shock_size_.size(); ++k) {
      shock_size_[k] = scale * program_.shock_size[k];
      if (shock_size_[k] != 0) shaken_[program_.shock[k / modes_.count()]] = 1;
    }
    noisy_ = std::find(shaken_.begin(), shaken_.end(), std::uint8_t{1}) != shaken_.end();
  }

  /// Moves every block's history by one sample; the newest is now to be made.
  void turn() {
    ChannelHistory<N>::turn();
    drawn_.turn();
  }

  /// Makes the newest sample of a block.
  void step(int block, const Moment<N>& moment) {
    count_quiet(block);
    if (!drawn_.empty()) drawn_.hear(block, this->regressors(block));
    modes_.choose(block, ring_, moment);
    if (noisy_) make_shocks(block, moment);
    Real* newest = ring_.sample(block, 0);
    auto held = all<Words<N>>(0U);
    std::uint32_t run = 0;
    for (int i = 0; i < program_.outputs; ++i) {
      const OutputChannel& channel = channels_.outputs[i];
      if (channel.mirrors >= 0) {
        store(negative(load<Reals<N>>(newest + channel.mirrors * kLanes)), newest + i * kLanes);
        run = program_.row_end[i];
        continue;
      }
      auto sum = noisy_ ? start_shaken(i) : constant(i);
      for (; run < program_.row_end[i]; ++run) {
        if (!is_quiet(block, program_.runs[run].channel)) sum = add_run(block, program_.runs[run], sum);
      }
      const auto value = hold(sum, all<Reals<N>>(channel.low), all<Reals<N>>(channel.high));
      held = held | differ(value, sum);
      store(settle(value), newest + i * kLanes);
    }
    store(held, moment.held);
  }

  /// Puts one lane to the operating point.
  void start(int block, int lane, const Moment<N>&) {
    modes_.start(block, lane);
    if (!drawn_.empty()) drawn_.start(block, lane);
    this->start_history(block, lane);
  }

  /// The mode that made a lane's newest sample; none before the first step.
  std::optional<int> mode(int block, int lane) const { return modes_.mode(block, lane); }

  /// Coefficients that a step multiplies by: those of A and B of one mode, and what the choice of a mode takes.
  std::int64_t multiply_adds() const {
    return static_cast<std::int64_t>(program_.coefficients.size() / modes_.count()) + modes_.multiply_adds();
  }

  /// Numbers of state that one lane holds.
  std::size_t lane_values() const { return modes_.lane_values() + drawn_.lane_values() + this->history_values(); }

  /// Calls visit(value, low, high) for each number of one lane's state, or visit(value, low, high, step) where only
  /// low and whole steps above it are sound, in an order that does not depend on where in the ring it lies: the way to
  /// save, check and restore it.
  template <class Visit>
  void visit_lane(int block, int lane, Visit visit) {
    std::fill_n(quiet_.begin() + block * program_.regressors, program_.regressors, 0);  // it may be restored
    modes_.visit_lane(block, lane, visit);
    const auto [low, high] = drawn_bounds();
    drawn_.visit_lane(block, lane, low, high, visit);
    this->visit_history(block, lane, visit);
  }

  /// Goes into the hash that tells models apart.
  std::uint64_t hash(std::uint64_t before) const { return modes_.hash(hash_of(program_, before)); }

 private:
  using ChannelHistory<N>::channels_;
  using ChannelHistory<N>::ring_;

  ArxStepper(const ArxProgram& program, const Modes& modes, const Channels& channels, int blocks, Arena& arena)
      : ChannelHistory<N>(program, channels, blocks, arena),
        program_(program),
        modes_(modes),
        drawn_(program.drawn, blocks, arena),
        shocks_(arena.take<Real>(static_cast<std::size_t>(program.shock_channels) * kLanes)),
        shaken_(arena.take<std::uint8_t>(program.shock_channels)),
        quiet_(arena.take<int>(static_cast<std::size_t>(blocks) * program.regressors)),
        shock_size_(arena.take<float>(program.shocks * modes.count())) {
    if (!arena.measures()) mark_mirrored(program_, channels_.outputs);
  }

  // The run's products are added in the order of its lags, each to what was there before.
  Reals<N> add_run(int block, const TapRun& run, Reals<N> sum) const {
    const float* coefficient = program_.coefficients.data() + run.coefficient * modes_.count();
    for (std::uint32_t k = 0; k < run.count; ++k, coefficient += modes_.count()) {
      const Real* past = ring_.sample(block, run.first_lag + k) + run.channel * kLanes;
      sum = sum + modes_.pick(coefficient) * load<Reals<N>>(past);
    }
    return sum;
  }

  // A regressor that has been 0 in all lanes for as long as anything looks back adds nothing: a wind from the one side
  // while it blows from the other. Whether its zeros are added or not changes no bit (settle() makes −0 to 0).
  void count_quiet(int block) {
    int* quiet = quiet_.data() + block * program_.regressors;
    const Real* newest = this->regressors(block);
    for (int k = 0; k < program_.regressors; ++k, ++quiet) {
      bool zero = true;
      for (int lane = 0; lane < kLanes; ++lane) zero &= value_of(*newest++) == 0.0f;
      *quiet = zero ? std::min(*quiet + 1, program_.depth) : 0;
    }
  }

  bool is_quiet(int block, std::uint32_t channel) const {
    const int regressor = static_cast<int>(channel) - program_.outputs;
    return regressor >= 0 && quiet_[block * program_.regressors + regressor] >= program_.depth;
  }

  void make_shocks(int block, const Moment<N>& moment) {
    if (!drawn_.empty()) {
      drawn_.step(block, moment, shocks_.data());
      return;
    }
    draw(moment);
  }

  // The lowest and the highest input that drawn residuals hear.
  std::pair<float, float> drawn_bounds() const {
    if (!program_.drawn.driven()) return {0.0f, 0.0f};
    const RegressorChannel& toward = channels_.regressors[program_.drawn.toward];
    if (program_.drawn.against < 0) return {toward.least, toward.most};
    const RegressorChannel& against = channels_.regressors[program_.drawn.against];
    return {toward.least - against.most, toward.most - against.least};
  }

  // Standard normal numbers for every shock that is added to an output.
  void draw(const Moment<N>& moment) {
    Words<N> counters[4], words[4];
    random_counters<N>(moment.counters, counters);
    int group = -1;
    for (int channel = 0; channel < program_.shock_channels; ++channel) {
      if (!shaken_[channel]) continue;
      if (channel / 4 != group) {
        group = channel / 4;
        random_group<N>(*moment.keys, counters, static_cast<std::uint32_t>(group), words);
      }
      store(normal_lanes<N>(words[channel % 4]), shocks_.data() + channel * kLanes);
    }
  }

  Reals<N> constant(int i) const { return modes_.pick(program_.constant.data() + i * modes_.count()); }

  // What a sum starts from: the constant and the noise.
  Reals<N> start_shaken(int i) const {
    if (!drawn_.empty()) {
      const auto shock = load<Reals<N>>(shocks_.data() + i * kLanes);
      return modes_.count() == 1 && program_.constant[i] == 0 ? shock : constant(i) + shock;
    }
    auto sum = constant(i);
    for (std::uint32_t k = i == 0 ? 0 : program_.shock_end[i - 1]; k < program_.shock_end[i]; ++k) {
      const Real* shock = shocks_.data() + program_.shock[k] * kLanes;
      sum = sum + modes_.pick(shock_size_.data() + k * modes_.count()) * load<Reals<N>>(shock);
    }
    return sum;
  }

  ArxProgram program_;
  Modes modes_;
  DrawnLanes<N> drawn_;
  std::span<Real> shocks_;
  std::span<std::uint8_t> shaken_;  // per standard normal number: whether anything is shaken by it
  std::span<int> quiet_;            // [block][regressor]: steps for which it has been 0 in all lanes, up to the depth
  std::span<float> shock_size_;     // those of the program, scaled
  bool noisy_ = false;
};

template <class N>
using SwitchedStepper = ArxStepper<N, ModeLanes<N>>;

}  // namespace wisp
