#pragma once
// How a chain chooses what comes next: a mode by what came before, then a segment of that mode, by counted random
// words. Words and whole numbers only.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "run/chain/chain_program.hpp"
#include "run/chain/chain_settings.hpp"

namespace wisp {

/// Random words of one join: of the mode, of the segment, and of which segment of the mode where none of the
/// best-joining ones was drawn.
struct ChainWords {
  std::uint32_t mode = 0;
  std::uint32_t segment = 0;
  std::uint32_t other = 0;
};

/// One of `count`, by a word.
inline std::uint32_t share_of(std::uint32_t word, std::uint32_t count) {
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(word) * count >> 32);
}

class ChainChoice {
 public:
  /// Takes the room for its tables.
  ChainChoice(const ChainProgram& program, Arena& arena)
      : ranks_(arena.take<std::uint32_t>(static_cast<std::size_t>(program.modes) *
                                         static_cast<std::size_t>(program.breadth))) {}

  /// Whether chance plays; otherwise the likeliest mode and the best-joining segment are chosen.
  void set_chance(bool chance) { chance_ = chance; }

  void set(const ChainSettings& settings, const ChainProgram& program) {
    history_ = static_cast<std::uint32_t>(settings.history);
    ranked_ = settings.temperature >= 0;
    if (ranked_) fill_ranks(settings.temperature, program);
  }

  /// The state whose probabilities count: that of a lane, or of the part of its history that may be looked at.
  std::uint32_t seen(const ChainProgram& program, std::uint32_t state) const {
    while (history_ > 0 && program.length[state] > history_) state = program.shorter[state];
    return state;
  }

  std::uint32_t mode(const ChainProgram& program, std::uint32_t state, const ChainWords& words) const {
    const auto modes = static_cast<std::uint32_t>(program.modes);
    const std::uint32_t* threshold = program.threshold.data() + seen(program, state) * modes;
    if (!chance_) return likeliest(threshold, modes);
    std::uint32_t mode = 0;
    while (mode + 1 < modes && !(words.mode < threshold[mode])) ++mode;
    return mode;
  }

  /// The same after a segment: what the history says, times what the place where that segment ends says.
  std::uint32_t mode_after(const ChainProgram& program, std::uint32_t state, std::uint32_t before,
                           const ChainWords& words) const {
    if (program.successor_weights.empty()) return mode(program, state, words);
    const auto modes = static_cast<std::uint32_t>(program.modes);
    const std::uint32_t* threshold = program.threshold.data() + std::size_t{seen(program, state)} * modes;
    const std::uint16_t* successor_weights = program.successor_weights.data() + std::size_t{before} * modes;
    // Below 2^32 in sum, so that a word times the sum fits: of the history's words the upper half counts.
    std::array<std::uint32_t, kMaxModes> weight;
    std::uint32_t total = 0, below = 0;
    for (std::uint32_t mode = 0; mode < modes; ++mode) {
      weight[mode] = ((threshold[mode] - below) >> 16) * std::uint32_t{successor_weights[mode]};
      below = threshold[mode];
      total += weight[mode];
    }
    if (!chance_)
      return static_cast<std::uint32_t>(std::max_element(weight.data(), weight.data() + modes) - weight.data());
    // How many sums of weights, the last left out, are not above what was drawn.
    const std::uint32_t drawn = share_of(words.mode, total);
    std::uint32_t mode = 0, sum = 0;
    for (std::uint32_t k = 0; k + 1 < modes; ++k) {
      sum += weight[k];
      mode += drawn < sum ? 0 : 1;
    }
    return mode;
  }

  /// A segment of a mode with which a life begins.
  std::uint32_t beginning(const ChainProgram& program, std::uint32_t mode, const ChainWords& words) const {
    return any(program, mode, words.segment);
  }

  std::uint32_t successor(const ChainProgram& program, std::uint32_t before, std::uint32_t mode,
                          const ChainWords& words) const {
    if (program.breadth == 0) return any(program, mode, words.segment);
    const auto breadth = static_cast<std::uint32_t>(program.breadth);
    const auto modes = static_cast<std::size_t>(program.modes);
    const std::uint16_t* best = program.follow.data() + (static_cast<std::size_t>(before) * modes + mode) * breadth;
    if (!chance_) return best[0];
    if (!ranked_) return best[share_of(words.segment, breadth)];
    const std::uint32_t* threshold = ranks_.data() + static_cast<std::size_t>(mode) * breadth;
    for (std::uint32_t rank = 0; rank < breadth; ++rank) {
      if (words.segment <= threshold[rank]) return best[rank];
    }
    return any(program, mode, words.other);
  }

  bool has_chance() const { return chance_; }

  /// How likely the history makes a mode, of 1. Where a segment ends does not count here: what is steered must have
  /// more to choose from than what would follow by itself.
  float chance_of(const ChainProgram& program, std::uint32_t state, std::uint32_t mode) const {
    return static_cast<float>(width_of(program, state, mode)) * (1.0f / 4294967296.0f);
  }

  struct Candidate {
    std::uint32_t segment;
    float share;
  };

  /// One of those of a mode that may follow, and how likely it is among them: the best-joining ones by their rank,
  /// otherwise some by chance.
  Candidate candidate(const ChainProgram& program, std::uint32_t before, std::uint32_t mode, std::uint32_t k,
                      const ChainWords& words) const {
    if (program.breadth == 0) return {any(program, mode, words.segment + k * 0x9E3779B9U), 1.0f};
    const auto breadth = static_cast<std::uint32_t>(program.breadth);
    const auto modes = static_cast<std::size_t>(program.modes);
    const std::uint16_t* best = program.follow.data() + (static_cast<std::size_t>(before) * modes + mode) * breadth;
    if (!ranked_) return {best[k], 1.0f};
    const std::uint32_t* threshold = ranks_.data() + static_cast<std::size_t>(mode) * breadth;
    const std::uint32_t below = k > 0 ? threshold[k - 1] : 0;
    return {best[k], static_cast<float>(threshold[k] - below) * (1.0f / 4294967296.0f)};
  }

 private:
  // How many words the history gives a mode.
  std::uint32_t width_of(const ChainProgram& program, std::uint32_t state, std::uint32_t mode) const {
    const std::uint32_t* threshold =
        program.threshold.data() + seen(program, state) * static_cast<std::uint32_t>(program.modes);
    return threshold[mode] - (mode > 0 ? threshold[mode - 1] : 0);
  }

  std::uint32_t any(const ChainProgram& program, std::uint32_t mode, std::uint32_t word) const {
    const std::uint32_t first = program.first_of_mode[mode];
    return chance_ ? first + share_of(word, program.first_of_mode[mode + 1] - first) : first;
  }

  static std::uint32_t likeliest(const std::uint32_t* threshold, std::uint32_t modes) {
    std::uint32_t best = 0, most = 0, below = 0;
    for (std::uint32_t mode = 0; mode < modes; ++mode) {
      if (threshold[mode] - below > most) {
        most = threshold[mode] - below;
        best = mode;
      }
      below = threshold[mode];
    }
    return best;
  }

  // Per mode the words of each of the best-joining segments, the best first; what is left belongs to all that join
  // worse; those two are not distinguished.
  void fill_ranks(float temperature, const ChainProgram& program) {
    const auto breadth = static_cast<std::uint32_t>(program.breadth);
    const float ratio = temperature / (1.0f + temperature);
    for (std::uint32_t mode = 0; mode < static_cast<std::uint32_t>(program.modes); ++mode) {
      const std::uint32_t members = program.first_of_mode[mode + 1] - program.first_of_mode[mode];
      float total = 0, weight = 1;
      for (std::uint32_t rank = 0; rank < members; ++rank, weight *= ratio) total += weight;
      float sum = 0;
      weight = 1;
      for (std::uint32_t rank = 0; rank < breadth; ++rank, weight *= ratio) {
        sum += rank < members ? weight : 0.0f;
        const float share = sum / total * 4294967296.0f;
        const bool all = rank + 1 >= members || !(share < 4294967040.0f);
        ranks_[static_cast<std::size_t>(mode) * breadth + rank] = all ? 0xffffffffU : static_cast<std::uint32_t>(share);
      }
    }
  }

  std::span<std::uint32_t> ranks_;  // modes × best-joining segments
  std::uint32_t history_ = 0;
  bool ranked_ = false;
  bool chance_ = true;
};

}  // namespace wisp
