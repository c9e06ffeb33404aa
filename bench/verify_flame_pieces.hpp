#pragma once
// What each piece of a flame model is worth on clips that learning has not seen.

#include <filesystem>
#include <span>

namespace wisp::verify {

/// Learns a flame with one piece after the other, from the corpus in `folder`, and judges what it plays in each kind of
/// wind: figures and windows for a classifier go to FOLDER/pieces (flame_judge.hpp).
void judge_flame_pieces(const std::filesystem::path& folder);

/// The same for flicker, from recordings of real flames without wind: learned from each one's first half, judged on its
/// second; the floor is one half against the other.
void judge_flicker_pieces(const std::filesystem::path& folder, std::span<char* const> recordings);

}  // namespace wisp::verify
