#include "studies/flame/verify_flame_pieces.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "learn/flame/learn_outline.hpp"
#include "learn/outline/outline_fit.hpp"
#include "learn/outline/outline_judgement.hpp"
#include "studies/flame/flame_corpus.hpp"
#include "studies/flame/flame_judge.hpp"
#include "studies/value_or_abort.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::verify {
namespace {

struct Piece {
  const char* name;
  OutlineRecipe options;
};

constexpr const char* kDefaultPiece = "components of the shape (the default)";  // of `wisp learn flame`

std::vector<Piece> pieces() { return {{"points (the paper)", {.paper = 4}}, {kDefaultPiece, {}}}; }

bool is_asked(const PieceQuestion& question, const std::string& name) {
  return question.names.empty() ||
         std::find(question.names.begin(), question.names.end(), name) != question.names.end();
}

/// What there is without an input.
std::vector<Piece> flicker_pieces() {
  std::vector<Piece> out = pieces();
  for (Piece& piece : out) piece.options.inputs.emplace();
  return out;
}

std::vector<FlamePlayer> learned(const std::vector<Recording>& clips, const std::vector<Piece>& pieces) {
  std::vector<FlamePlayer> out;
  for (const Piece& piece : pieces) {
    out.push_back(player_of(piece.name, value_or_abort(learn_outline(clips, piece.options)).model));
  }
  return out;
}

std::vector<FlamePlayer> players_of(const std::vector<Recording>& clips, const PieceQuestion& question) {
  std::vector<Piece> asked = pieces();
  std::erase_if(asked, [&](const Piece& piece) { return !is_asked(question, piece.name); });
  std::vector<FlamePlayer> out = learned(clips, asked);
  if (out.empty()) {
    std::fprintf(stderr, "there is no piece called %s\n", question.names.front().c_str());
    std::exit(2);
  }
  return out;
}

/// The longest stretch that a play along a learned clip's own wind repeats of that clip: the most tempting case.
void print_longest_copy(const std::vector<Recording>& clips) {
  const auto fit = value_or_abort(fit_outline(clips, {}));
  double seconds = 0;
  for (const Recording& clip : clips) {
    const auto found = value_or_abort(judge_outline(fit.model, clip));
    if (found.fidelity) seconds = std::max(seconds, found.fidelity->verbatim_seconds);
  }
  std::printf("\nthe default's longest verbatim run along a learned clip's own wind: %.2f s\n", seconds);
}

}  // namespace

void judge_flame_pieces(const std::filesystem::path& folder, const PieceQuestion& question) {
  FlameCorpus corpus(folder, question.seeds);
  const auto judge = [&](const std::vector<Recording>& clips, std::initializer_list<UnseenFlames> unseen) {
    const auto players = players_of(clips, question);
    for (const UnseenFlames& flames : unseen) judge_players(flames, flame_units(clips), players, folder / "pieces");
  };
  judge(corpus.gusts(), {corpus.unseen_gusts()});
  print_longest_copy(corpus.gusts());
  if (question.gusts_alone) return;
  // Models have seen what they are to play: calm, or puffs.
  judge(corpus.gusts_and_calm(), {corpus.unseen_calm()});
  UnseenFlames calm = corpus.unseen_calm();
  calm.wind = "calm, learned from calm alone";
  judge(corpus.calm(), {calm});
  judge(corpus.gusts_and_puffs(), {corpus.unseen_between_blow_outs(), corpus.unseen_blow_outs()});
}

void judge_flicker_pieces(const std::filesystem::path& folder, std::span<char* const> recordings) {
  for (const std::filesystem::path file : recordings) {
    const Recording whole = value_or_abort(read_csv(file));
    const std::vector first{slice(whole, 0, whole.rows() / 2)};
    const std::vector second{slice(whole, whole.rows() / 2, whole.rows())};
    FlameUnits units = flame_units(first);
    units.wind.reset();
    judge_players({file.stem().string(), second, first}, units, learned(first, flicker_pieces()), folder / "flicker");
  }
}

}  // namespace wisp::verify
