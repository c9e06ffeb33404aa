// Learned falls against those that they were learned from: gusts in the model's own play, real paper, the spread over
// seeds, steering, and windows for a classifier. Prints tables; exit status 1 where a bound is missed.
//
//   wisp_verify_falls [gusts] [paper] [spread] [steering]     default all
//   wisp_verify_falls windows FILE.csv                        for studies/fidelity/fidelity_leaf.py

#include "studies/falls/verify_falls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "learn/chain/chain_fidelity.hpp"
#include "wisp/simulate/leaf_drops.hpp"

namespace wisp::verify {
namespace {

constexpr const char* kColumns[] = {"descent", "horizontal", "heading", "tilt", "spin", "length"};
constexpr const char* kFigures[] = {"mean", "sd", "least", "most"};
constexpr double kWindowSegments = 2.5;

LearnedLeaf learn() {
  const auto drops = simulate_leaf_drops({.drops = 260});
  if (!drops) give_up(drops.error());
  LeafRecipe recipe;
  recipe.holdout = 0.4;
  auto fit = fit_chain(std::span(&*drops, 1), recipe);
  if (!fit) give_up(fit.error());
  return {std::move(*fit), segmentation_of(recipe)};
}

void write(std::ofstream& out, const char* side, const FeatureWindows& windows, std::size_t first_fall) {
  for (std::size_t k = 0; k < windows.size(); ++k) {
    out << side << ',' << first_fall + windows.blocks[k];
    for (double value : windows.window(k)) out << ',' << value;
    out << '\n';
  }
}

}  // namespace

void give_up(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  std::exit(1);
}

const LearnedLeaf& learned_leaf() {
  static const LearnedLeaf leaf = learn();
  return leaf;
}

std::vector<Stretch> series_of(std::span<const Recording> falls, const LearnedLeaf& leaf) {
  const auto motion = motion_of(falls);
  if (!motion) give_up(motion.error());
  const auto cut = segment(*motion, falls, leaf.segmentation);
  if (!cut) give_up(cut.error());
  return motion_series(*motion, cut->segments);
}

std::size_t window_rows(const LearnedLeaf& leaf) {
  return static_cast<std::size_t>(
      std::lround(kWindowSegments * leaf.fit.summary.mean_segment_seconds * leaf.fit.model.rate_hz));
}

Result<void> write_windows(const std::filesystem::path& file) {
  const LearnedLeaf& leaf = learned_leaf();
  const auto& real = leaf.fit.held_out;
  const auto made = made_falls(leaf.fit.model, static_cast<int>(real.size()), real.front().rows(), 1);
  if (!made) return made.error();
  const auto seen = series_of(real, leaf), played = series_of(made->falls, leaf);
  const std::size_t length = window_rows(leaf);
  std::ofstream out(file);
  out.precision(8);
  out << "side,fall";
  for (const char* column : kColumns) {
    for (const char* figure : kFigures) out << ',' << column << ' ' << figure;
  }
  out << '\n';
  write(out, "recorded", series_windows(seen, length), 0);
  write(out, "synthesized", series_windows(played, length), seen.size());
  write(out, "shuffled", series_windows(shuffled(seen, 1), length), 0);
  if (!out.flush()) return Error{file.string() + ": cannot be written"};
  return {};
}

}  // namespace wisp::verify

int main(int count, char** names) {
  using namespace wisp::verify;
  if (count == 3 && std::string(names[1]) == "windows") {
    if (const auto ok = write_windows(names[2]); !ok) give_up(ok.error());
    return 0;
  }
  constexpr std::array kChecks = {Check{"gusts", gusts}, Check{"paper", paper}, Check{"spread", spread},
                                  Check{"steering", steering}};
  return run_checks(kChecks, std::span(names, static_cast<std::size_t>(count)).subspan(1));
}
