#pragma once
// Steps blocks of instances of an ARX model. Source: section 3.5 of the paper (one multiplication by the matrix of
// coefficients, histories in circular buffers); here the bank shares one place in the buffers, and what is zero costs
// nothing.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>

#include "run/arx/arx_program.hpp"
#include "run/arx/drawn_lanes.hpp"
#include "run/bank/channel_history.hpp"
#include "run/bank/moment.hpp"
#include "run/chain/chain_lane.hpp"
#include "wisp/run/bank.hpp"

namespace wisp {

template <class N>
class ArxStepper : public ChannelHistory<N> {
 public:
  using typename ChannelHistory<N>::Real;
  using ChannelHistory<N>::kLanes;
  /// Frames over which a cost is averaged: drawn residuals jump in some of them.
  static constexpr int kCountedFrames = 60;

  /// Where the model's deviations are measured from.
  static OperatingPoint operating_point(const ArxModel& arx) { return {arx.output_mean, arx.input_mean}; }

  /// Errors: what single precision can't step.
  static Result<void> check(const Model& model, const ArxModel& arx) { return check_arx_program(model, arx); }

  ArxStepper(const Model& model, const ArxModel& arx, const Channels& channels, int blocks, Arena& arena)
      : ArxStepper(make_arx_program(model, arx, arena), channels, blocks, arena) {}

  /// Sets the scale of the residual noise.
  void set_noise(float scale) {
    noisy_ = drawn_.set_noise(scale);
    if (!drawn_.empty()) return;
    const auto scaled = [&](float size) {
      noisy_ |= scale * size != 0;
      return scale * size;
    };
    std::transform(program_.sd.begin(), program_.sd.end(), sd_.begin(), scaled);
    std::transform(program_.mixing.begin(), program_.mixing.end(), mixing_.begin(), scaled);
  }

  /// Makes the newest sample of a block.
  void step(int block, const Moment<N>& moment) {
    count_quiet(block);
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
      auto sum = noisy_ ? start_shaken(i) : all<Reals<N>>(program_.constant[i]);
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
    if (!drawn_.empty()) drawn_.start(block, lane);
    this->start_history(block, lane);
  }

  /// Coefficients of A and B that are not zero.
  std::int64_t multiply_adds() const { return static_cast<std::int64_t>(program_.coefficients.size()); }

  /// Numbers of state that one lane holds.
  std::size_t lane_values() const { return this->history_values() + drawn_.lane_values(); }

  /// Calls visit(value, low, high) for each number of one lane's state, in an order that does not depend on where in
  /// the ring it lies: the way to save, check and restore it.
  template <class Visit>
  void visit_lane(int block, int lane, Visit visit) {
    std::fill_n(quiet_.begin() + block * program_.regressors, program_.regressors, 0);  // it may be restored
    drawn_.visit_lane(block, lane, visit);
    this->visit_history(block, lane, visit);
  }

  /// Goes into the hash that tells models apart.
  std::uint64_t hash(std::uint64_t before) const { return hash_of(program_, before); }

 private:
  using ChannelHistory<N>::channels_;
  using ChannelHistory<N>::ring_;

  ArxStepper(const ArxProgram& program, const Channels& channels, int blocks, Arena& arena)
      : ChannelHistory<N>(program, channels, blocks, arena),
        program_(program),
        drawn_(program.drawn, blocks, arena),
        shocks_(arena.take<Real>(static_cast<std::size_t>(program.outputs + program.rank) * kLanes)),
        quiet_(arena.take<int>(static_cast<std::size_t>(blocks) * program.regressors)),
        sd_(arena.take<float>(program.outputs)),
        mixing_(arena.take<float>(static_cast<std::size_t>(program.outputs) * program.rank)) {
    if (!arena.measures()) mark_mirrored(program_, channels_.outputs);
  }

  // The run's products are added in the order of its lags, each to what was there before.
  Reals<N> add_run(int block, const TapRun& run, Reals<N> sum) const {
    const float* coefficient = program_.coefficients.data() + run.coefficient;
    for (std::uint32_t k = 0; k < run.count; ++k) {
      const Real* past = ring_.sample(block, run.first_lag + k) + run.channel * kLanes;
      sum = sum + all<Reals<N>>(coefficient[k]) * load<Reals<N>>(past);
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
      DrawnWind<Real> winds[kLanes];
      if (drawn_.driven()) measure_winds(block, winds);
      drawn_.step(block, winds, this->previous(block), moment, shocks_.data());
      return;
    }
    draw(moment);
  }

  Reals<N> wind_at(int block, std::uint32_t lag) const {
    const Real* row = ring_.sample(block, lag) + program_.outputs * kLanes;
    const auto toward = load<Reals<N>>(row + program_.drawn.toward * kLanes);
    if (program_.drawn.against < 0) return toward;
    return toward - load<Reals<N>>(row + program_.drawn.against * kLanes);
  }

  void measure_winds(int block, DrawnWind<Real> (&winds)[kLanes]) const {
    Real wind[kLanes], trend[kLanes];
    const auto now = wind_at(block, 0);
    store(now, wind);
    store(now - wind_at(block, static_cast<std::uint32_t>(program_.drawn.trend_steps)), trend);
    for (int lane = 0; lane < kLanes; ++lane) winds[lane] = {wind[lane], trend[lane]};
  }

  bool is_shaken(int channel) const { return channel >= program_.outputs || sd_[channel] != 0; }

  // Standard normal deviates for every output that has noise of its own, and for every shared shock.
  void draw(const Moment<N>& moment) {
    Words<N> counters[4], words[4];
    random_counters<N>(moment.counters, counters);
    const int channels = program_.outputs + program_.rank;
    int group = -1;
    for (int channel = 0; channel < channels; ++channel) {
      if (!is_shaken(channel)) continue;
      if (channel / 4 != group) {
        group = channel / 4;
        random_group<N>(*moment.keys, counters, static_cast<std::uint32_t>(group), words);
      }
      store(normal_lanes<N>(words[channel % 4]), shocks_.data() + channel * kLanes);
    }
  }

  // What a sum starts from: the constant and the noise.
  Reals<N> start_shaken(int i) const {
    auto sum = all<Reals<N>>(program_.constant[i]);
    if (!drawn_.empty()) {
      const auto shock = load<Reals<N>>(shocks_.data() + i * kLanes);
      return program_.constant[i] == 0 ? shock : sum + shock;
    }
    if (is_shaken(i)) sum = add_shock(i, sd_[i], sum);
    for (int r = 0; r < program_.rank; ++r) sum = add_shock(program_.outputs + r, mixing_[i * program_.rank + r], sum);
    return sum;
  }

  Reals<N> add_shock(int channel, float size, const Reals<N>& sum) const {
    return sum + all<Reals<N>>(size) * load<Reals<N>>(shocks_.data() + channel * kLanes);
  }

  ArxProgram program_;
  DrawnLanes<N> drawn_;
  std::span<Real> shocks_;
  std::span<int> quiet_;  // [block][regressor]: steps for which it has been 0 in all lanes, up to the depth
  std::span<float> sd_;   // those of the program, scaled, as is the next
  std::span<float> mixing_;
  bool noisy_ = false;
};

}  // namespace wisp
