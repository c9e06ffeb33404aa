#include "wisp/learn/learn.hpp"

#include <filesystem>

#include "learn/arx/learn_arx.hpp"
#include "learn/chain/learn_chain.hpp"
#include "learn/flame/learn_outline.hpp"
#include "learn/flicker/learn_flicker.hpp"
#include "learn/markov/learn_markov.hpp"
#include "learn/report/report_values.hpp"
#include "wisp/run/cost.hpp"

namespace wisp {
namespace {

using Recordings = std::span<const Recording>;

struct Learning {
  Recordings recordings;
  const Progress& progress;

  Result<Fit> by(const ArxRecipe& recipe) const { return learn_arx(recordings, recipe, progress); }
  Result<Fit> by(const SwitchedRecipe& recipe) const { return learn_switched(recordings, recipe, progress); }
  Result<Fit> by(const FlickerRecipe& recipe) const { return learn_flicker(recordings, recipe, progress); }
  Result<Fit> by(const OutlineRecipe& recipe) const { return learn_outline(recordings, recipe, progress); }
  Result<Fit> by(const ChainRecipe& recipe) const { return learn_chain(recordings, recipe, progress); }
};

// Records in the model's training the program's version, the file names of the sources without the folders of the
// user's disk, and the cost of a frame; adds the cost to the report. A model that cannot be played has no cost.
void complete(Fit& fit) {
  fit.model.training.program = "wisp " WISP_VERSION;
  for (std::string& source : fit.model.training.sources) source = std::filesystem::path(source).filename().string();
  const auto cost = count_operations(fit.model);
  if (!cost) return;
  // Runtimes with little memory read the cost from the model instead of counting.
  fit.model.training.multiply_adds_per_frame = cost->multiply_adds_per_frame;
  fit.model.training.operations_per_frame = cost->operations_per_frame;
  fit.report.sections.push_back(arx::cost_section(*cost));
}

}  // namespace

Result<Fit> learn(Recordings recordings, const Recipe& recipe, const Progress& progress) {
  if (recordings.empty()) return Error{"there are no recordings to learn from"};
  const Learning learning{recordings, progress};
  auto fit = std::visit([&](const auto& kind) { return learning.by(kind); }, recipe);
  if (!fit) return fit;
  complete(*fit);
  for (const Recording& one : recordings) {
    if (one.rate_note.guessed) fit->report.warnings.push_back(one.source + ": " + one.rate_note.text);
  }
  return fit;
}

Result<Fit> learn(const Recording& recording, const Recipe& recipe, const Progress& progress) {
  return learn(Recordings(&recording, 1), recipe, progress);
}

}  // namespace wisp
