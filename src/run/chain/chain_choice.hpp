#pragma once
// Choice of a chain's next mode, given earlier ones, then of its segment, by counter-based random words, in integers.

#include <cstdint>

#include "run/chain/chain_program.hpp"
#include "run/lanes/random_lanes.hpp"

namespace wisp {

/// Random words of one join: for the mode, and for the segment.
struct ChainWords {
  std::uint32_t mode = 0;
  std::uint32_t segment = 0;
};

class ChainChoice {
 public:
  /// Sets whether choices are random; otherwise the likeliest mode and the best-joining segment are chosen.
  void set_chance(bool chance) { chance_ = chance; }
  bool has_chance() const { return chance_; }

  std::uint32_t mode(const ChainProgram& program, std::uint32_t state, const ChainWords& words) const {
    const auto modes = static_cast<std::uint32_t>(program.modes);
    const std::uint32_t* threshold = program.threshold.data() + state * modes;
    if (!chance_) return likeliest(threshold, modes);
    std::uint32_t mode = 0;
    while (threshold[mode] != 0xffffffffU && !(words.mode < threshold[mode])) ++mode;
    return mode;
  }

  /// Returns a random segment of a mode, or without chance its first one, for the start of an instance.
  std::uint32_t beginning(const ChainProgram& program, std::uint32_t mode, const ChainWords& words) const {
    return any(program, mode, words.segment);
  }

  std::uint32_t successor(const ChainProgram& program, std::uint32_t before, std::uint32_t mode,
                          const ChainWords& words) const {
    if (program.breadth == 0) return any(program, mode, words.segment);
    const std::uint16_t* best = best_of(program, before, mode);
    return chance_ ? best[share_of(words.segment, static_cast<std::uint32_t>(program.breadth))] : best[0];
  }

  /// Returns the probability of a mode after a state of the Markov chain.
  float chance_of(const ChainProgram& program, std::uint32_t state, std::uint32_t mode) const {
    const std::uint32_t* threshold = program.threshold.data() + state * static_cast<std::uint32_t>(program.modes);
    const std::uint32_t width = threshold[mode] - (mode > 0 ? threshold[mode - 1] : 0);
    return static_cast<float>(width) * (1.0f / 4294967296.0f);
  }

  /// Returns candidate k of a mode's segments: the k-th best-joining one or, without such lists, one drawn by `words`.
  std::uint32_t candidate(const ChainProgram& program, std::uint32_t before, std::uint32_t mode, std::uint32_t k,
                          const ChainWords& words) const {
    if (program.breadth == 0) return any(program, mode, words.segment + k * 0x9E3779B9U);
    return best_of(program, before, mode)[k];
  }

 private:
  static const std::uint16_t* best_of(const ChainProgram& program, std::uint32_t before, std::uint32_t mode) {
    return program.follow.data() + (std::size_t{before} * static_cast<std::size_t>(program.modes) + mode) *
                                       static_cast<std::size_t>(program.breadth);
  }

  std::uint32_t any(const ChainProgram& program, std::uint32_t mode, std::uint32_t word) const {
    const std::uint32_t first = program.first_of_mode[mode];
    return chance_ ? first + share_of(word, program.first_of_mode[mode + 1] - first) : first;
  }

  bool chance_ = true;
};

}  // namespace wisp
