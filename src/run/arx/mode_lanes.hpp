#pragma once
// The active mode in every lane of a block: an ARX model has only one; a switched model's Markov chain selects it.

#include <cstdint>
#include <optional>
#include <span>

#include "run/lanes/blocks.hpp"
#include "run/lanes/random_lanes.hpp"
#include "run/state/arena.hpp"
#include "run/state/moment.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

inline constexpr std::uint32_t kAnyWord = 0xffffffffU;

/// The Markov chain of a switched ARX model, compiled for stepping.
struct ModeProgram {
  int modes = 0;
  int outputs = 0;
  /// (modes + 1) × modes: a row for each previous mode, and a last one for the first step. A random word selects the
  /// first mode whose threshold exceeds it or is kAnyWord.
  std::span<std::uint32_t> thresholds;
};

ModeProgram make_mode_program(const SwitchedArxModel& switched, Arena& arena);

std::uint64_t hash_of(const ModeProgram& program, std::uint64_t before);

/// Modes of a plain ARX model: no choice and no state.
template <class N>
class SingleMode {
 public:
  using Real = typename N::Real;
  /// Number of frames over which a cost is averaged, since resampled residuals jump in some frames only.
  static constexpr int kCountedFrames = 60;

  SingleMode(const Model&, const ArxModel&, int, Arena&) {}

  static constexpr std::size_t count() { return 1; }
  void set_chance(bool) {}
  /// Number of blocks stepped at once. All blocks have the same coefficients.
  static constexpr int kGroup = WISP_BLOCKS_AT_ONCE;
  struct Choice {
    template <class Values>
    Values pick(const float* of_mode) const {
      return all<Values>(*of_mode);
    }
  };
  Choice choose(int, const Moment<N>&) { return {}; }
  void start(int, int) {}
  std::optional<int> mode(int, int) const { return 0; }
  std::size_t lane_values() const { return 0; }
  template <class Visit>
  void visit_lane(int, int, Visit) {}
  std::uint64_t hash(std::uint64_t before) const { return before; }
};

/// Modes of a switched model. Each lane's coefficients are those of its mode, so the arithmetic of a step does not
/// depend on the number of modes. The Markov chain takes one random word per step.
template <class N>
class ModeLanes {
 public:
  using Real = typename N::Real;
  static constexpr int kLanes = N::kLanes;
  /// Number of frames over which a cost is averaged: one, since every frame costs the same.
  static constexpr int kCountedFrames = 1;

  ModeLanes(const Model&, const SwitchedArxModel& switched, int blocks, Arena& arena)
      : program_(make_mode_program(switched, arena)),
        modes_(arena.take<Real>(static_cast<std::size_t>(blocks) * kLanes)) {}

  std::size_t count() const { return static_cast<std::size_t>(program_.modes); }

  /// Sets whether transitions are random; otherwise the Markov chain takes its likeliest transition.
  void set_chance(bool there) { chance_ = there; }

  static constexpr int kGroup = 1;

  struct Choice {
    std::uint32_t mode[kLanes];

    /// Returns, in every lane, the element of `of_mode` that belongs to the lane's mode.
    template <class Values>
    Values pick(const float* of_mode) const {
      Real picked[kLanes];
      for (int lane = 0; lane < kLanes; ++lane) picked[lane] = Real(of_mode[mode[lane]]);
      return load<Values>(picked);
    }
  };

  Choice choose(int block, const Moment<N>& moment) {
    const Choice choice = walk(block, moment);
    for (int lane = 0; lane < kLanes; ++lane) {
      modes_[block * kLanes + lane] = Real(static_cast<float>(choice.mode[lane]));
    }
    return choice;
  }

  void start(int block, int lane) { modes_[block * kLanes + lane] = Real(kNoMode); }

  std::optional<int> mode(int block, int lane) const {
    const int mode = static_cast<int>(value_of(modes_[block * kLanes + lane]));
    if (mode < 0) return {};
    return mode;
  }

  std::size_t lane_values() const { return 1; }

  template <class Visit>
  void visit_lane(int block, int lane, Visit visit) {
    visit(modes_[block * kLanes + lane], kNoMode, static_cast<float>(program_.modes - 1), 1.0f);
  }

  std::uint64_t hash(std::uint64_t before) const { return hash_of(program_, before); }

 private:
  static constexpr float kNoMode = -1.0f;

  // Makes one step of every lane's Markov chain. Its random word follows those of the shocks.
  Choice walk(int block, const Moment<N>& moment) const {
    Choice choice;
    const auto modes = static_cast<std::uint32_t>(program_.modes);
    typename N::Word word[kLanes] = {};
    if (chance_) {
      Words<N> counters[4], words[4];
      random_counters<N>(moment.counters, counters);
      const int group = (program_.outputs + kGroupChannels - 1) / kGroupChannels;
      random_group<N>(*moment.keys, counters, static_cast<std::uint32_t>(group), words);
      store(words[0], word);
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      const int before = static_cast<int>(value_of(modes_[block * kLanes + lane]));
      const auto row = static_cast<std::size_t>(before < 0 ? program_.modes : before) * modes;
      const std::uint32_t* threshold = program_.thresholds.data() + row;
      choice.mode[lane] = chance_ ? first_above(threshold, value_of(word[lane])) : likeliest(threshold, modes);
    }
    return choice;
  }

  static std::uint32_t first_above(const std::uint32_t* threshold, std::uint32_t word) {
    std::uint32_t mode = 0;
    while (threshold[mode] != kAnyWord && word >= threshold[mode]) ++mode;
    return mode;
  }

  ModeProgram program_;
  std::span<Real> modes_;  // [block][lane]: mode of the newest sample, or kNoMode
  bool chance_ = true;
};

}  // namespace wisp
