#pragma once
// Makes many steps of a bank's only instance, of a model with one output: lanes hold consecutive steps rather than
// instances. Contributions of inputs and noise are computed in parallel; only sums over past outputs are sequential,
// and are added last. Each step sums in the order of ArxStepper::step(), so it gives the same bits.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "run/arx/arx_program.hpp"
#include "run/lanes/random_lanes.hpp"
#include "run/state/channels.hpp"
#include "run/state/moment.hpp"
#include "run/state/sample_ring.hpp"

namespace wisp {

template <class N>
class TimeLanes {
 public:
  using Real = typename N::Real;
  static constexpr int kLanes = N::kLanes;
  /// Whether the kernel is compiled; builds for size leave it out.
  static constexpr bool kThere = WISP_BLOCKS_AT_ONCE > 1;
  /// Largest number of steps whose inputs are read, and whose outputs are written, together.
  static constexpr int kAtOnce = 8 * kLanes;

  TimeLanes(const ArxProgram& program, Arena& arena)
      : past_(takes(program) ? program.depth : 0),
        rows_(arena.take<Real>(takes(program) ? (1 + program.regressors) * row_size() : 0)) {}

  /// Returns whether this kernel supports the model.
  bool there() const { return past_ > 0; }

  /// Copies the history of a bank's first lane from lag 1 on; the sample at lag 0 is still to be computed.
  void begin(const SampleRing<N>& ring) {
    for (int lag = 1; lag < past_; ++lag) {
      const Real* sample = ring.sample(0, static_cast<std::uint32_t>(lag));
      for (int c = 0; c < channels(); ++c) newest(c)[-lag] = sample[c * kLanes];
    }
  }

  /// Copies the history back to the ring; lag 0 is the last step made. Precondition: 2 or more steps since begin().
  void end(SampleRing<N>& ring) const {
    for (int lag = 0; lag < past_; ++lag) {
      Real* sample = ring.sample(0, static_cast<std::uint32_t>(lag));
      for (int c = 0; c < channels(); ++c) sample[c * kLanes] = newest(c)[-1 - lag];
    }
  }

  /// Returns the address for the values of regressor k in the next steps, at most kAtOnce.
  Real* regressors(int k) { return newest(1 + k); }

  /// Makes up to kAtOnce steps. `shock_sizes`: one per entry of program.shock; empty: no shocks. Returns the outputs'
  /// deviations, and adds to `clamped` the number of steps in which the output was clamped.
  const Real* step(const ArxProgram& program, const OutputChannel& output, std::span<const float> shock_sizes,
                   const Moment<N>& moment, int count, std::uint64_t& clamped) {
    for (int first = 0; first < count; first += kLanes) {
      auto sum = all<Reals<N>>(program.constant[0]);
      if (!shock_sizes.empty()) add_shocks(program, shock_sizes, moment, first, sum);
      for (const TapRun& run : program.runs) {
        if (run.channel != 0) add_inputs(program, run, first, sum);
      }
      store(sum, newest(0) + first);
    }
    for (int step = 0; step < count; ++step) clamped += finish(program, output, newest(0) + step);
    return newest(0);
  }

  /// Moves the steps made into the past.
  void turn(int count) {
    for (int c = 0; c < channels(); ++c) {
      Real* row = newest(c) - past_;
      std::copy(row + count, row + count + past_, row);
    }
  }

 private:
  static bool takes(const ArxProgram& program) {
    return kThere && program.outputs == 1 && program.modes == 1 && program.resampled.empty();
  }
  std::size_t row_size() const { return static_cast<std::size_t>(past_ + kAtOnce); }
  int channels() const { return static_cast<int>(rows_.size() / row_size()); }
  Real* newest(int channel) { return rows_.data() + channel * row_size() + past_; }
  const Real* newest(int channel) const { return rows_.data() + channel * row_size() + past_; }

  void add_inputs(const ArxProgram& program, const TapRun& run, int first, Reals<N>& sum) const {
    const float* coefficient = program.coefficients.data() + run.coefficient;
    const Real* past = newest(static_cast<int>(run.channel)) + first - run.first_lag;
    for (std::uint32_t k = 0; k < run.count; ++k) sum = sum + all<Reals<N>>(coefficient[k]) * load<Reals<N>>(past + k);
  }

  void add_shocks(const ArxProgram& program, std::span<const float> sizes, const Moment<N>& moment, int first,
                  Reals<N>& sum) const {
    std::uint64_t stream[kLanes], born[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) {
      stream[lane] = moment.counters.stream[0];
      born[lane] = moment.counters.born[0] - static_cast<std::uint64_t>(first + lane);
    }
    Words<N> counters[4], words[4];
    random_counters<N>({stream, born, moment.counters.step}, counters);
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      const std::uint32_t channel = program.shock[k];
      random_group<N>(*moment.keys, counters, channel / kGroupChannels, words);
      const auto pair = normal_lanes(words[channel % kGroupChannels / 2]);
      sum = sum + all<Reals<N>>(sizes[k]) * (channel % 2 == 0 ? pair.first : pair.second);
    }
  }

  // Adds the contributions of past outputs to the newest value, one at a time, since a vector load would wait for the
  // last store. Returns whether the value was clamped: a rare case, marked as unlikely, so that the processor starts
  // the next step before the comparison ends.
  static bool finish(const ArxProgram& program, const OutputChannel& output, Real* newest) {
    Real sum = *newest;
    for (const TapRun& run : program.runs) {
      if (run.channel != 0) continue;
      const float* coefficient = program.coefficients.data() + run.coefficient;
      const volatile Real* past = newest - run.first_lag;
      for (std::uint32_t k = 0; k < run.count; ++k) sum = sum + coefficient[k] * past[k];
    }
    const bool held = sum < output.low || sum > output.high;
    if (held) [[unlikely]]
      sum = sum < output.low ? output.low : output.high;
    if (std::abs(sum) < kMinState) [[unlikely]]
      sum = 0;
    *newest = sum;
    return held;
  }

  int past_;              // number of stored samples, 0 if the model is unsupported
  std::span<Real> rows_;  // [channel][step], the past_ stored samples first; channel 0 is the output
};

}  // namespace wisp
