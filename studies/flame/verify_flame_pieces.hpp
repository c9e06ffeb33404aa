#pragma once
// What each piece of a flame model is worth on clips that learning has not seen.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "studies/flame/flame_corpus.hpp"

namespace wisp::verify {

/// What is asked.
struct PieceQuestion {
  FlameSeeds seeds = FlameSeeds::kFresh;
  std::vector<std::string> names;  ///< of pieces; empty: all
  bool gusts_alone = false;        ///< neither calm nor blow-outs
};

/// Learns a flame with one piece after the other, from the corpus in `folder`, and judges what it plays in each kind of
/// wind: figures and windows for a classifier go to FOLDER/pieces (flame_judge.hpp).
void judge_flame_pieces(const std::filesystem::path& folder, const PieceQuestion& question);

/// The same for flicker, from recordings of real flames without wind: learned from each one's first half, judged on its
/// second; the floor is one half against the other.
void judge_flicker_pieces(const std::filesystem::path& folder, std::span<char* const> recordings);

}  // namespace wisp::verify
