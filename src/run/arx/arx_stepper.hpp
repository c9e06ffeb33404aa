#pragma once
// Steps blocks of instances of an ARX model, or of a switched one, whose modes are ARX models. Source: section 3.5 of
// the paper (one multiplication by the matrix of coefficients, histories in circular buffers); here all instances share
// one ring position, and zero coefficients cost nothing.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "run/arx/arx_program.hpp"
#include "run/arx/mode_lanes.hpp"
#include "run/arx/resampled_lanes.hpp"
#include "run/arx/time_lanes.hpp"
#include "run/lanes/blocks.hpp"
#include "run/state/channel_history.hpp"
#include "run/state/moment.hpp"

namespace wisp {

/// Stepper of an ARX model or a switched one. `Modes` selects the active mode of each lane.
template <class N, class Modes = SingleMode<N>>
class ArxStepper : public ChannelHistory<N> {
 public:
  using typename ChannelHistory<N>::Real;
  using ChannelHistory<N>::kLanes;
  static constexpr int kCountedFrames = Modes::kCountedFrames;

  /// Returns the operating point, from which the regression measures deviations.
  template <class Dynamics>
  static OperatingPoint operating_point(const Dynamics& dynamics) {
    return {dynamics.output_mean, dynamics.input_mean};
  }

  /// Errors: coefficients so large that a step could overflow single precision.
  template <class Dynamics>
  static Result<void> check(const Model& model, const Dynamics& dynamics) {
    return check_regression(regression_of(model, dynamics));
  }

  template <class Dynamics>
  ArxStepper(const Model& model, const Dynamics& dynamics, const Channels& channels, int blocks, Arena& arena)
      : ArxStepper(make_arx_program(model, dynamics, arena), Modes(model, dynamics, blocks, arena), channels, blocks,
                   arena) {}

  /// Sets the scale of the residual noise. At 0 mode transitions are deterministic too.
  void set_noise(float scale) {
    modes_.set_chance(scale > 0);
    noisy_ = resampled_.set_noise(scale);
    if (!resampled_.empty()) return;
    std::fill(shaken_.begin(), shaken_.end(), std::uint8_t{0});
    for (std::size_t k = 0; k < shock_size_.size(); ++k) {
      shock_size_[k] = scale * program_.shock_size[k];
      if (shock_size_[k] != 0) shaken_[program_.shock[k / modes_.count()]] = 1;
    }
    noisy_ = std::find(shaken_.begin(), shaken_.end(), std::uint8_t{1}) != shaken_.end();
  }

  void turn(int samples = 1) {
    ChannelHistory<N>::turn(samples);
    resampled_.turn(samples);
  }

  /// Number of blocks that step_group() steps at once.
  static constexpr int kGroup = Modes::kGroup;
  static constexpr bool kGroupsVary = false;

  /// Computes the newest samples of kBlocks consecutive blocks (1 or kGroup); `moment` is that of the first block. Each
  /// coefficient is read once for all blocks, and independent sums fill the processor's pipelines.
  template <int kBlocks = 1>
  void step(int block, const Moment<N>& moment) {
    std::uint64_t quiet = ~std::uint64_t{0};
    for (int b = 0; b < kBlocks; ++b) {
      quiet &= count_quiet(block + b);
      if (!resampled_.empty()) resampled_.hear(block + b, this->regressors(block + b));
    }
    const Step<kBlocks> step{program_.coefficients.data(),
                             modes_.count(),
                             ring_.back(),
                             ring_.begin(block),
                             ring_.sample(block, 0),
                             ring_.stride(),
                             modes_.choose(block, moment),
                             quiet,
                             moment.clamped};
    if (noisy_) make_shocks(block, step, moment);
    std::fill_n(moment.clamped, kBlocks * kLanes, 0U);
    for (int i = 0; i < program_.outputs;) {
      if (kTwins<kBlocks> && program_.twin[i] != 0) {
        make_rows<2>(i, step);
        i += 2;
      } else {
        make_rows<1>(i++, step);
      }
    }
  }

  /// Returns whether step_alone() supports the model: one output, one mode, no resampled residuals, no vector input.
  bool steps_alone() const {
    return alone_.there() && std::none_of(channels_.regressors.begin(), channels_.regressors.end(),
                                          [](const auto& one) { return one.part >= RegressorPart::kLength; });
  }

  /// Makes `count` >= 2 steps of the only instance, with the bits of `count` calls of step() with a turn() between.
  /// fill(k, first, of, out) writes the values of regressor k for `of` steps from step `first` on; take(first, of,
  /// deviations) receives the outputs of these steps. Returns the number of steps in which an output was clamped.
  template <class Fill, class Take>
  std::uint64_t step_alone(const Moment<N>& moment, int count, Fill fill, Take take) {
    const std::span<const float> shocks = noisy_ ? shock_size_ : std::span<const float>();
    std::uint64_t clamped = 0;
    Moment<N> now = moment;
    alone_.begin(ring_);
    for (int first = 0; first < count; first += TimeLanes<N>::kAtOnce) {
      const int of = std::min(count - first, TimeLanes<N>::kAtOnce);
      for (int k = 0; k < program_.regressors; ++k) fill(k, first, of, alone_.regressors(k));
      take(first, of, alone_.step(program_, channels_.outputs[0], shocks, now, of, clamped));
      alone_.turn(of);
      now.counters.step += static_cast<std::uint64_t>(of);
    }
    ring_.turn(count - 1);
    alone_.end(ring_);
    std::fill_n(quiet_.begin(), program_.regressors, 0);  // unknown: these steps were not counted
    return clamped;
  }

  /// Returns a copy on the same memory, but with its own ring position, to step some blocks ahead of others.
  ArxStepper ahead() const { return *this; }

  /// Sets one lane to the operating point.
  void start(int block, int lane, const Moment<N>&) {
    modes_.start(block, lane);
    if (!resampled_.empty()) resampled_.start(block, lane);
    this->start_history(block, lane);
  }

  /// Returns whether ranges of blocks may be stepped in parallel.
  bool can_be_shared() const { return true; }

  /// Returns the mode that made a lane's newest sample; none before the first step.
  std::optional<int> mode(int block, int lane) const { return modes_.mode(block, lane); }

  /// Returns the number of multiplications of a step: coefficients of A and B that are nonzero in at least one mode.
  std::int64_t multiply_adds() const {
    return static_cast<std::int64_t>(program_.coefficients.size() / modes_.count());
  }

  /// Returns the number of state variables of one lane.
  std::size_t lane_values() const { return modes_.lane_values() + resampled_.lane_values() + this->history_values(); }

  /// Calls visit(value, low, high) or, for values restricted to low plus multiples of `step`, visit(value, low, high,
  /// step) for a lane's state variables, in an order independent of the ring position: to save, check and restore it.
  template <class Visit>
  void visit_lane(int block, int lane, Visit visit) {
    std::fill_n(quiet_.begin() + block * program_.regressors, program_.regressors, 0);  // visit may change the history
    modes_.visit_lane(block, lane, visit);
    const auto [low, high] = resampled_bounds();
    resampled_.visit_lane(block, lane, low, high, visit);
    this->visit_history(block, lane, visit);
  }

  std::uint64_t hash(std::uint64_t before) const { return modes_.hash(hash_of(program_, before)); }

 private:
  using ChannelHistory<N>::channels_;
  using ChannelHistory<N>::ring_;

  ArxStepper(const ArxProgram& program, const Modes& modes, const Channels& channels, int blocks, Arena& arena)
      : ChannelHistory<N>(program, channels, blocks, arena),
        program_(program),
        modes_(modes),
        resampled_(program.resampled, blocks, arena),
        alone_(program, arena),
        shaken_(arena.take<std::uint8_t>(static_cast<std::size_t>(program.outputs))),
        quiet_(arena.take<int>(static_cast<std::size_t>(blocks) * program.regressors)),
        shock_size_(arena.take<float>(program.shocks * modes.count())),
        own_shocks_(program.shocks == channels.outputs.size() && modes.count() == 1) {}

  using Choice = typename Modes::Choice;

  template <int kBlocks>
  struct Step {
    const float* coefficients;
    std::size_t modes;
    const std::uint32_t* back;
    const Real* ring;  // ring of the first block
    Real* newest;      // newest sample of the first block
    std::size_t stride;
    Choice choice;
    std::uint64_t quiet;     // bit k < kQuietBits: regressor k has been 0 over the whole history of all blocks
    std::uint32_t* clamped;  // one flag per lane

    BlockPlaces<Real, kBlocks> output(int i) const { return {newest + i * kLanes, stride}; }
  };

  // Whether outputs with equal taps are computed in pairs: only if registers hold both sums and as many other values.
  template <int kBlocks>
  static constexpr bool kTwins = kGroup > 1 && 4 * PartsOfBlocks<N, kBlocks>::kParts <= kVectorRegisters;

  // Computes kRows outputs from i on. Their sums use the same samples, each of which is read once for all rows.
  template <int kRows, int kBlocks>
  void make_rows(int i, const Step<kBlocks>& step) const {
    using Values = BlockReals<N, kBlocks>;
    const std::size_t twin = program_.twin[i] * step.modes;
    Values sum[kRows];
    if (noisy_) {
      unrolled<kRows>([&](auto row) { sum[row] = load_blocks<N, Values>(step.output(i + row)); });
    } else {
      unrolled<kRows>([&](auto row) { sum[row] = constant<Values>(step.choice, i + row); });
    }
    const TapRun* run = program_.runs.data() + (i == 0 ? 0 : program_.row_end[i - 1]);
    for (const TapRun* end = program_.runs.data() + program_.row_end[i]; run != end; ++run) {
      if (!is_quiet(step.quiet, run->channel)) add_run(step, *run, twin, sum);
    }
    auto clamped = all<BlockWords<N, kBlocks>>(0U);
    unrolled<kRows>([&](auto row) {
      const OutputChannel& channel = channels_.outputs[i + row];
      const auto value = hold(sum[row], all<Values>(channel.low), all<Values>(channel.high));
      clamped = clamped | differ(value, sum[row]);
      store_blocks<N>(settle(value), step.output(i + row));
    });
    if (any(clamped)) flag<kBlocks>(clamped, step.clamped);
  }

  // Sets the flags of clamped lanes. Rarely called, so it is not inlined.
  template <int kBlocks, class Clamped>
  [[gnu::noinline]] static void flag(const Clamped& clamped, std::uint32_t* flags) {
    const BlockPlaces<std::uint32_t, kBlocks> places(flags, kLanes);
    store_blocks<N>(clamped | load_blocks<N, Clamped>(places), places);
  }

  // Adds the products of a run's coefficients and samples to kRows sums, the largest lag first.
  template <int kRows, int kBlocks>
  static void add_run(const Step<kBlocks>& step, const TapRun& run, std::size_t twin,
                      BlockReals<N, kBlocks> (&sum)[kRows]) {
    using Values = BlockReals<N, kBlocks>;
    const float* coefficient = step.coefficients + run.coefficient * step.modes;
    const BlockPlaces<const Real, kBlocks> channel(step.ring + run.channel * kLanes, step.stride);
    const std::uint32_t* back = step.back + run.first_lag;
    for (const std::uint32_t* end = back - run.count; back != end; --back, coefficient += step.modes) {
      const std::size_t sample = *back;
      Values factor[kRows];
      unrolled<kRows>([&](auto row) { factor[row] = step.choice.template pick<Values>(coefficient + row * twin); });
      unrolled<PartsOfBlocks<N, kBlocks>::kParts>([&](auto i) {
        typename PartsOfBlocks<N, kBlocks>::RealPart past;
        load_block_part<N>(channel, sample, i, past);
        if (kRows > 1 && kBlocks > 1) hold_in_register(past);
        unrolled<kRows>([&](auto row) { sum[row].part[i] = sum[row].part[i] + factor[row].part[i] * past; });
      });
    }
  }

  // Counts, for each regressor of a block, the steps for which it has been 0 in all lanes. Returns bit k for regressor
  // k < kQuietBits if these are the whole history: skipping its products changes no bit (settle() converts −0 to 0).
  std::uint64_t count_quiet(int block) {
    int* quiet = quiet_.data() + block * program_.regressors;
    const Real* newest = this->regressors(block);
    const auto zero = all<Reals<N>>(0.0f);
    std::uint64_t bits = 0;
    for (int k = 0; k < program_.regressors; ++k, newest += kLanes) {
      quiet[k] = any(differ(load<Reals<N>>(newest), zero)) ? 0 : std::min(quiet[k] + 1, program_.depth);
      if (k < kQuietBits && quiet[k] >= program_.depth) bits |= std::uint64_t{1} << k;
    }
    return bits;
  }

  static constexpr int kQuietBits = 64;
  bool is_quiet(std::uint64_t quiet, std::uint32_t channel) const {
    const int regressor = static_cast<int>(channel) - program_.outputs;
    return regressor >= 0 && regressor < kQuietBits && (quiet >> regressor & 1) != 0;
  }

  // Writes constant plus noise to the blocks' newest samples: the initial values of the sums over regressors.
  template <int kBlocks>
  void make_shocks(int block, const Step<kBlocks>& step, const Moment<N>& moment) {
    if (!resampled_.empty()) {
      for (int b = 0; b < kBlocks; ++b) play_drawn(block + b, step.choice, moment.later(b));
      return;
    }
    if (kGroup > 1 && own_shocks_) {
      draw<kBlocks>(moment, [&](int i, int b, const auto& normals) {
        const auto size = step.choice.template pick<Reals<N>>(shock_size_.data() + i * modes_.count());
        store(constant<Reals<N>>(step.choice, i) + size * normals, step.newest + b * step.stride + i * kLanes);
      });
      return;
    }
    draw<kBlocks>(moment, [&](int channel, int b, const auto& normals) { store(normals, shock(block + b, channel)); });
    for (int b = 0; b < kBlocks; ++b) start_all(block + b, step.choice);
  }

  void play_drawn(int block, const Choice& choice, const Moment<N>& moment) {
    Real* newest = ring_.sample(block, 0);
    resampled_.step(block, moment);
    resampled_.play(block, newest);
    for (int i = 0; i < program_.outputs; ++i, newest += kLanes) {
      if (program_.constant[i] != 0) store(constant<Reals<N>>(choice, i) + load<Reals<N>>(newest), newest);
    }
  }

  // Returns the lowest and the highest value of the input of resampled residuals.
  std::pair<float, float> resampled_bounds() const {
    if (!program_.resampled.driven()) return {0.0f, 0.0f};
    const RegressorChannel& toward = channels_.regressors[program_.resampled.toward];
    return {toward.least, toward.most};
  }

  // Calls take(channel, block, normals) for every standard normal number that an output uses. Random words of many
  // channels are drawn first, then converted, so that independent conversions run interleaved.
  static constexpr int kDrawnAtOnce = 32;
  template <int kBlocks, class Take>
  void draw(const Moment<N>& moment, Take take) const {
    typename N::Word words[kBlocks][kDrawnAtOnce / 2][kLanes];
    for (int first = 0; first < program_.outputs; first += kDrawnAtOnce) {
      const int last = std::min(first + kDrawnAtOnce, program_.outputs);
      for (int b = 0; b < kBlocks; ++b) draw_words(moment.later(b), first, last, words[b]);
      for (int channel = first; channel < last; channel += 2) {
        const bool second = channel + 1 < last && shaken_[channel + 1];
        if (!shaken_[channel] && !second) continue;
        for (int b = 0; b < kBlocks; ++b) {
          const auto pair = normal_lanes(load<Words<N>>(words[b][(channel - first) / 2]));
          if (shaken_[channel]) take(channel, b, pair.first);
          if (second) take(channel + 1, b, pair.second);
        }
      }
    }
  }

  void draw_words(const Moment<N>& moment, int first, int last, typename N::Word (*words)[kLanes]) const {
    Words<N> counters[4], group[4];
    random_counters<N>(moment.counters, counters);
    for (int channel = first; channel < last; channel += kGroupChannels, words += 4) {
      const auto shaken = shaken_.begin() + channel, end = shaken + std::min(kGroupChannels, last - channel);
      if (std::find(shaken, end, std::uint8_t{1}) == end) continue;
      random_group<N>(*moment.keys, counters, static_cast<std::uint32_t>(channel / kGroupChannels), group);
      unrolled<4>([&](auto k) { store(group[k], words[k]); });
    }
  }

  template <class Values>
  Values constant(const Choice& choice, int i) const {
    return choice.template pick<Values>(program_.constant.data() + i * modes_.count());
  }

  // Writes all outputs' initial sums, the last first: a sum overwrites its normal number, which later outputs use.
  void start_all(int block, const Choice& choice) {
    Real* newest = ring_.sample(block, 0);
    for (int i = program_.outputs - 1; i >= 0; --i) store(start_shaken(block, choice, i), newest + i * kLanes);
  }

  // Returns the initial value of an output's sum: constant plus noise.
  Reals<N> start_shaken(int block, const Choice& choice, int i) {
    auto sum = constant<Reals<N>>(choice, i);
    for (std::uint32_t k = i == 0 ? 0 : program_.shock_end[i - 1]; k < program_.shock_end[i]; ++k) {
      const auto size = choice.template pick<Reals<N>>(shock_size_.data() + k * modes_.count());
      sum = sum + size * load<Reals<N>>(shock(block, static_cast<int>(program_.shock[k])));
    }
    return sum;
  }

  // Returns the address of an output's standard normal number, where its sum will be.
  Real* shock(int block, int output) { return ring_.sample(block, 0) + output * kLanes; }

  ArxProgram program_;
  Modes modes_;
  ResampledLanes<N> resampled_;
  TimeLanes<N> alone_;
  std::span<std::uint8_t> shaken_;  // per standard normal number: whether any output uses it
  std::span<int> quiet_;            // [block][regressor]: number of last steps with 0 in all lanes, at most the depth
  std::span<float> shock_size_;     // shock sizes of the program times the scale of the noise
  bool noisy_ = false;
  bool own_shocks_;  // every output has exactly one shock, that of its own standard normal number
};

template <class N>
using SwitchedStepper = ArxStepper<N, ModeLanes<N>>;

}  // namespace wisp
