#include "wisp/learn/learn.hpp"

#include "learn/arx/learn_arx.hpp"
#include "learn/chain/learn_chain.hpp"
#include "learn/complete.hpp"
#include "learn/flame/learn_outline.hpp"
#include "learn/flicker/learn_flicker.hpp"
#include "learn/markov/learn_markov.hpp"

namespace wisp {
namespace {

using Recordings = std::span<const Recording>;

Result<Fit> learn_as(const ArxRecipe& recipe, Recordings recordings, const Progress& progress) {
  return learn_arx(recordings, recipe, progress);
}
Result<Fit> learn_as(const SwitchedRecipe& recipe, Recordings recordings, const Progress& progress) {
  return learn_switched(recordings, recipe, progress);
}
Result<Fit> learn_as(const FlickerRecipe& recipe, Recordings recordings, const Progress& progress) {
  return learn_flicker(recordings, recipe, progress);
}
Result<Fit> learn_as(const OutlineRecipe& recipe, Recordings recordings, const Progress& progress) {
  return learn_outline(recordings, recipe, progress);
}
Result<Fit> learn_as(const ChainRecipe& recipe, Recordings recordings, const Progress& progress) {
  return learn_chain(recordings, recipe, progress);
}

}  // namespace

Result<Fit> learn(Recordings recordings, const Recipe& recipe, const Progress& progress) {
  if (recordings.empty()) return Error{"there are no recordings to learn from"};
  auto fit = std::visit([&](const auto& kind) { return learn_as(kind, recordings, progress); }, recipe);
  if (!fit) return fit;
  complete(*fit);
  return fit;
}

Result<Fit> learn(const Recording& recording, const Recipe& recipe, const Progress& progress) {
  return learn(Recordings(&recording, 1), recipe, progress);
}

}  // namespace wisp
