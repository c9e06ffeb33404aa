#pragma once
// Steps blocks of instances of an ARX model. Source: section 3.5 of the paper (one multiplication by the matrix of
// coefficients, histories in circular buffers); here the buffer's place is shared by the whole bank, so that a tap
// costs no modulo, and what is zero costs nothing.

#include <algorithm>
#include <cstdint>
#include <span>

#include "run/arx_program.hpp"
#include "run/random_lanes.hpp"

namespace wisp {

/// What a step needs to know of the moment, beside the state: the same for every kind of dynamics.
template <class N>
struct Moment {
  const RandomKeys* keys = nullptr;
  LaneCounters counters{};        ///< of the block
  typename N::Real noise = 0;     ///< scale of the noise; 0 none
  std::uint32_t* held = nullptr;  ///< per lane: set to 1 where an output was held
};

template <class N>
class ArxStepper {
 public:
  using Real = typename N::Real;
  static constexpr int kLanes = N::kLanes;

  ArxStepper(const Model& model, const ArxModel& arx, const Channels& channels, int blocks, Arena& arena)
      : program_(make_arx_program(model, arx, arena)), channels_(channels) {
    const auto depth = static_cast<std::size_t>(program_.depth);
    row_ = static_cast<std::size_t>(program_.outputs + program_.regressors) * kLanes;
    ring_ = arena.take<Real>(static_cast<std::size_t>(blocks) * depth * row_);
    lag_row_ = arena.take<std::uint32_t>(2 * depth);
    shocks_ = arena.take<Real>(static_cast<std::size_t>(groups()) * 4 * kLanes);
    if (arena.measures()) return;
    for (std::size_t k = 0; k < 2 * depth; ++k)
      lag_row_[k] = static_cast<std::uint32_t>((2 * depth - k) % depth * row_);
  }

  /// Moves every block's history by one sample; the newest is now to be made.
  void turn() { place_ = place_ + 1 == program_.depth ? 0 : place_ + 1; }

  /// Where the regressors of the step belong: [regressor][lane].
  Real* regressors(int block) { return sample(block, 0) + program_.outputs * kLanes; }

  /// Makes the newest sample of a block.
  void step(int block, const Moment<N>& moment) {
    const bool noisy = moment.noise > Real(0);
    if (noisy) draw(moment);
    Real* newest = sample(block, 0);
    std::uint32_t run = 0;
    for (int i = 0; i < program_.outputs; ++i) {
      Real sum[kLanes];
      for (int lane = 0; lane < kLanes; ++lane) sum[lane] = Real(program_.constant[i]);
      for (; run < program_.row_end[i]; ++run) add_run(block, program_.runs[run], sum);
      if (noisy) add_noise(i, moment.noise, sum);
      finish(channels_.outputs[i], sum, moment.held, newest + i * kLanes);
    }
  }

  /// Outputs of the last step, and of the one before: [output][lane].
  const Real* newest(int block) const { return sample(block, 0); }
  const Real* previous(int block) const { return sample(block, 1); }

  /// Puts one lane to the operating point.
  void start(int block, int lane) {
    for (int lag = 0; lag < program_.depth; ++lag) {
      Real* row = sample(block, lag);
      for (int i = 0; i < program_.outputs; ++i) row[i * kLanes + lane] = Real(channels_.outputs[i].start);
      for (int k = 0; k < program_.regressors; ++k) row[(program_.outputs + k) * kLanes + lane] = Real(0);
    }
  }

 private:
  int groups() const { return (program_.outputs + program_.rank + 3) / 4; }

  // The sample `lag` steps ago of a block: outputs, then regressors. The table holds every distance twice, so that the
  // place in the ring and the lag add up without a modulo.
  const Real* sample(int block, int lag) const {
    const Real* ring = ring_.data() + static_cast<std::size_t>(block) * program_.depth * row_;
    return ring + lag_row_[program_.depth - place_ + lag];
  }
  Real* sample(int block, int lag) { return const_cast<Real*>(std::as_const(*this).sample(block, lag)); }

  void add_run(int block, const TapRun& run, Real* sum) const {
    const Real* ring = ring_.data() + static_cast<std::size_t>(block) * program_.depth * row_ + run.channel * kLanes;
    const std::uint32_t* row = lag_row_.data() + (program_.depth - place_) + run.first_lag;
    const float* c = program_.coefficients.data() + run.coefficient;
    std::uint32_t k = 0;
    for (; k + 4 <= run.count; k += 4) {
      const Real *x0 = ring + row[k], *x1 = ring + row[k + 1], *x2 = ring + row[k + 2], *x3 = ring + row[k + 3];
      const Real c0(c[k]), c1(c[k + 1]), c2(c[k + 2]), c3(c[k + 3]);
      for (int lane = 0; lane < kLanes; ++lane) {
        sum[lane] = sum[lane] + c0 * x0[lane] + c1 * x1[lane] + c2 * x2[lane] + c3 * x3[lane];
      }
    }
    for (; k < run.count; ++k) {
      const Real* x = ring + row[k];
      const Real factor(c[k]);
      for (int lane = 0; lane < kLanes; ++lane) sum[lane] = sum[lane] + factor * x[lane];
    }
  }

  // Standard normal deviates for every output and every shared shock.
  void draw(const Moment<N>& moment) {
    for (int group = 0; group < groups(); ++group) {
      typename N::Word words[4][kLanes];
      random_group<N>(*moment.keys, moment.counters, static_cast<std::uint32_t>(group), words);
      for (int k = 0; k < 4; ++k) normal_lanes<N>(words[k], shocks_.data() + (group * 4 + k) * kLanes);
    }
  }

  void add_noise(int i, Real scale, Real* sum) const {
    add_shock(i, scale * Real(program_.sd[i]), sum);
    for (int r = 0; r < program_.rank; ++r) {
      add_shock(program_.outputs + r, scale * Real(program_.mixing[i * program_.rank + r]), sum);
    }
  }

  void add_shock(int channel, Real size, Real* sum) const {
    const Real* shock = shocks_.data() + channel * kLanes;
    for (int lane = 0; lane < kLanes; ++lane) sum[lane] = sum[lane] + size * shock[lane];
  }

  static void finish(const OutputChannel& channel, const Real* sum, std::uint32_t* held, Real* out) {
    const Real low(channel.low), high(channel.high);
    for (int lane = 0; lane < kLanes; ++lane) {
      const Real value = hold(sum[lane], low, high);
      held[lane] |= value == sum[lane] ? 0U : 1U;
      out[lane] = settle(value);
    }
  }

  ArxProgram program_;
  Channels channels_;
  std::span<Real> ring_;
  std::span<std::uint32_t> lag_row_;
  std::span<Real> shocks_;
  std::size_t row_ = 0;
  int place_ = 0;
};

}  // namespace wisp
