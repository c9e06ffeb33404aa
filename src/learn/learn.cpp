#include "wisp/learn/learn.hpp"

#include "learn/arx/learn_arx.hpp"
#include "learn/chain/learn_chain.hpp"
#include "learn/flame/learn_outline.hpp"
#include "learn/flicker/learn_flicker.hpp"
#include "learn/markov/learn_markov.hpp"
#include "learn/report/report_values.hpp"

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

}  // namespace

Result<Fit> learn(Recordings recordings, const Recipe& recipe, const Progress& progress) {
  if (recordings.empty()) return Error{"there are no recordings to learn from"};
  const Learning learning{recordings, progress};
  auto fit = std::visit([&](const auto& kind) { return learning.by(kind); }, recipe);
  if (!fit) return fit;
  arx::complete(*fit);
  for (const Recording& one : recordings) {
    if (one.rate_note.guessed) fit->report.warnings.push_back(one.source + ": " + one.rate_note.text);
    for (const Channel& channel : one.channels) {
      const auto first = find_channel(recordings.front(), channel.name);
      const std::string unit = first ? recordings.front().channels[*first].unit : "";
      if (unit.empty() || channel.unit.empty() || channel.unit == unit) continue;
      fit->report.warnings.push_back(one.source + ": '" + channel.name + "' is in " + channel.unit +
                                     ", in the first recording in " + unit + ": units are not converted");
    }
  }
  return fit;
}

Result<Fit> learn(const Recording& recording, const Recipe& recipe, const Progress& progress) {
  return learn(Recordings(&recording, 1), recipe, progress);
}

}  // namespace wisp
