#pragma once
// Makes the newest samples of a bank of few instances: the outputs of an instance go side by side, where in a block
// instances do, so that lanes are not empty. Every output adds up what it adds in a block, in the same order.

#include <algorithm>
#include <cstdint>
#include <span>

#include "run/arx/output_program.hpp"
#include "run/arx/resampled_lanes.hpp"
#include "run/lanes/random_lanes.hpp"
#include "run/state/channels.hpp"
#include "run/state/moment.hpp"
#include "run/state/sample_ring.hpp"

namespace wisp {

template <class N>
class OutputLanes {
 public:
  using Real = typename N::Real;
  static constexpr int kLanes = N::kLanes;
  static constexpr bool kThere = kFewApart && kLanes == static_cast<int>(kOutputsAtOnce);
  /// Instances that are faster so than in a block, by measurement.
  static constexpr int kMost = kThere ? 2 : 0;

  OutputLanes(const OutputProgram& program, const Channels& channels, int depth, int shock_channels, Arena& arena)
      : program_(program),
        columns_(kMost, depth, static_cast<int>(program.columns), arena),
        low_(arena.take<float>(program.groups * kOutputsAtOnce)),
        high_(arena.take<float>(program.groups * kOutputsAtOnce)),
        shock_size_(arena.take<float>(program.shock_rows * kOutputsAtOnce)),
        normals_(arena.take<Real>(kThere ? (shock_channels + kPairChannels - 1) / kPairChannels * kPairChannels : 0)),
        behind_(arena.take<std::uint8_t>(1)) {
    if (arena.measures()) return;
    behind_[0] = 1;
    for (std::size_t k = 0; k < low_.size(); ++k) {
      const OutputChannel& channel = channels.outputs[program.output[k]];
      low_[k] = channel.low;
      high_[k] = channel.high;
    }
  }

  /// Whether it makes the samples of the bank's only block.
  bool takes(int lanes) const { return kThere && lanes <= kMost && program_.groups > 0; }

  /// Sets what the regression's shocks are multiplied with.
  void set_shocks(std::span<const float> sizes) {
    for (std::size_t k = 0; k < shock_size_.size(); ++k) {
      shock_size_[k] = program_.shock[k] < sizes.size() ? sizes[program_.shock[k]] : 0.0f;
    }
  }

  void turn(int samples = 1) { columns_.turn(samples); }

  /// History was changed, or made, elsewhere.
  void fall_behind() { behind_[0] = 1; }

  /// Makes the newest samples of the first lanes of a bank's only block, whose history is `ring`, with noise or
  /// without, and sets the flags of lanes in which an output was clamped.
  void step(SampleRing<N>& ring, const Moment<N>& moment, bool noisy, const ResampledLanes<N>& residuals) {
    if (behind_[0] != 0) catch_up(ring, moment.lanes());
    for (int lane = 0; lane < moment.lanes(); ++lane) {
      Noise noise{noisy && !residuals.empty() ? residuals.played(0, lane) : nullptr, residuals.scale()};
      if (noisy && !noise.row) {
        draw(moment, lane);
        noise.drawn = true;
      }
      Real* newest = ring.sample(0, 0) + lane;
      Real* columns = columns_.sample(lane, 0);
      take_regressors(newest, columns);
      if (any(make(lane, newest, columns, noise))) moment.clamped[lane] = ~std::uint32_t{0};
      take_outputs(newest, columns);
    }
  }

 private:
  using Values = Reals<N>;
  static constexpr int kPairChannels = 2 * static_cast<int>(kOutputsAtOnce);  // whose numbers are made at once

  // What is added to the constant: residuals of a row, one an output; or what was drawn; or nothing.
  struct Noise {
    const float* row;
    float scale;
    bool drawn = false;
  };

  // The columns of channels of one kind, from a lane of a sample, [channel][lane].
  void take_columns(ColumnSource one, ColumnSource many, const Real* sample, Real* columns) const {
    const std::uint32_t* channel = program_.channel.data();
    for (std::size_t c = 0; c < program_.columns; ++c, channel += kOutputsAtOnce, columns += kOutputsAtOnce) {
      if (program_.source[c] == one) store(all<Values>(sample[*channel]), columns);
      if (program_.source[c] == many) store(gathered<N>(sample, channel), columns);
    }
  }
  void take_outputs(const Real* sample, Real* columns) const {
    take_columns(ColumnSource::kOneOutput, ColumnSource::kOutputs, sample, columns);
  }
  void take_regressors(const Real* sample, Real* columns) const {
    take_columns(ColumnSource::kOneRegressor, ColumnSource::kRegressors, sample, columns);
  }

  void catch_up(const SampleRing<N>& ring, int lanes) {
    for (int lane = 0; lane < lanes; ++lane) {
      for (int lag = 1; lag < ring.depth(); ++lag) {
        const auto ago = static_cast<std::uint32_t>(lag);
        const Real* sample = ring.sample(0, ago) + lane;
        Real* columns = columns_.sample(lane, ago);
        take_columns(ColumnSource::kGroup, ColumnSource::kGroup, sample, columns);
        take_outputs(sample, columns);
        take_regressors(sample, columns);
      }
    }
    behind_[0] = 0;
  }

  // The standard normal numbers of a lane. Groups of words, and then what is made of the words, go side by side.
  void draw(const Moment<N>& moment, int lane) {
    constexpr int kParts = N::kPartLanes > 1 ? 1 : 2, kGroups = kParts * N::kPartLanes;
    using Bits = Pack<typename N::WordPart, kParts>;
    typename N::Word groups[kGroups], words_of[4][kGroups];
    Bits own[4], words[4];
    random_counters_of(moment.counters, lane, own);
    const int channels = static_cast<int>(normals_.size());
    for (int first = 0; first < channels; first += kGroups * kGroupChannels) {
      for (int k = 0; k < kGroups; ++k) groups[k] = static_cast<std::uint32_t>(first / kGroupChannels + k);
      unrolled<4>([&](auto k) { words[k] = own[k]; });
      words[1] = words[1] ^ load<Bits>(groups);
      philox(*moment.keys, words);
      unrolled<4>([&](auto k) { store(words[k], words_of[k]); });
      const int last = std::min(first + kGroups * kGroupChannels, channels);
      for (int channel = first, group = 0; channel < last; channel += kPairChannels, group += 2) {
        typename N::Word of_pairs[kOutputsAtOnce];
        unrolled<4>([&](auto k) {
          of_pairs[k] = words_of[k][group];
          of_pairs[4 + k] = words_of[k][group + 1];
        });
        const auto normals = normal_lanes(load<Words<N>>(of_pairs));
        store(normals.first, normals_.data() + channel);
        store(normals.second, normals_.data() + channel + kOutputsAtOnce);
      }
    }
  }

  Values start_of(std::size_t g, const Noise& noise) const {
    const std::size_t first = g * kOutputsAtOnce;
    auto sum = load<Values>(program_.constant.data() + first);
    if (noise.row) return sum + all<Values>(noise.scale) * gathered<N>(noise.row, program_.output.data() + first);
    if (!noise.drawn) return sum;
    for (std::size_t row = g == 0 ? 0 : program_.shock_end[g - 1]; row < program_.shock_end[g]; ++row) {
      const std::size_t at = row * kOutputsAtOnce;
      const auto normals = gathered<N>(normals_.data(), program_.shock_place.data() + at);
      sum = sum + load<Values>(shock_size_.data() + at) * normals;
    }
    return sum;
  }

  // Makes what a lane's sample and columns have of outputs. Returns which places were clamped.
  Words<N> make(int lane, Real* newest, Real* columns, const Noise& noise) const {
    auto clamped = all<Words<N>>(0U);
    const ColumnRun* run = program_.runs.data();
    const float* coefficient = program_.coefficients.data();
    const Real* history = columns_.begin(lane);
    const std::uint32_t* lags = columns_.back();
    for (std::size_t g = 0; g < program_.groups; ++g) {
      const std::size_t first = g * kOutputsAtOnce;
      auto sum = start_of(g, noise);
      for (const ColumnRun* end = program_.runs.data() + program_.run_end[g]; run != end; ++run) {
        const Real* column = history + run->column * kOutputsAtOnce;
        const std::uint32_t* back = lags + run->first_lag;
        for (const std::uint32_t* last = back - run->count; back != last; --back, coefficient += kOutputsAtOnce) {
          sum = sum + load<Values>(coefficient) * load<Values>(column + *back);
        }
      }
      const auto value = hold(sum, load<Values>(low_.data() + first), load<Values>(high_.data() + first));
      clamped = clamped | differ(value, sum);
      Real made[kLanes];
      store(settle(value), made);
      if (program_.own[g] < program_.columns) store(settle(value), columns + program_.own[g] * kOutputsAtOnce);
      const std::uint32_t* output = program_.output.data() + first;
      for (std::uint32_t k = 0; k < program_.count[g]; ++k) newest[output[k] * kLanes] = made[k];
    }
    return clamped;
  }

  OutputProgram program_;
  SampleRing<N> columns_;           // [lane][lag][column][place]
  std::span<float> low_;            // [group][place]
  std::span<float> high_;           // [group][place]
  std::span<float> shock_size_;     // [row][place]
  std::span<Real> normals_;         // of one lane, at normal_place()
  std::span<std::uint8_t> behind_;  // in memory, since what steps ahead is a copy of this
};

}  // namespace wisp
