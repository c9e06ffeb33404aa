// `wisp learn flicker`: the light of a flame, for lamps.

#include <chrono>

#include "commands/commands.hpp"
#include "flags/recordings.hpp"
#include "reports/learned_model.hpp"
#include "terminal.hpp"
#include "wisp/learn/learn.hpp"

namespace wisp::cli {
namespace {

Result<void> run_learn_flicker(const Arguments& arguments, Terminal& terminal) {
  const auto start = std::chrono::steady_clock::now();
  const auto recordings = read_tables(arguments.positionals(), arguments, terminal);
  if (!recordings) return recordings.error();
  const FlickerRecipe recipe{.name = model_name(arguments),
                             .output = arguments.has("channel") ? arguments.text("channel") : "",
                             .modes = arguments.integer("modes"),
                             .order = arguments.integer("order"),
                             .seed = static_cast<std::uint64_t>(arguments.integer("seed"))};
  const auto fit = learn(*recordings, recipe, terminal.progress());
  if (!fit) return fit.error();
  return hand_over(*fit, model_path(arguments), start, terminal);
}

}  // namespace

Command learn_flicker_command() {
  std::vector<Flag> flags = {
      output_flag(),
      {"channel", Kind::kText, "NAME", "", "the channel of light; default: brightness, or the only output"},
      {"modes", Kind::kInteger, "K", "3", "degrees of restlessness, 2 to 8"},
      {"order", Kind::kInteger, "N", "4", "lags in every mode, 1 to 8"},
      {"seed", Kind::kInteger, "N", "1", "of the play that shocks are matched by"},
  };
  for (Flag& flag : recording_flags()) flags.push_back(std::move(flag));
  return {
      "learn flicker",
      "Learns the light of a flame, calm and restless by turns, for a lamp to play.",
      {{"REC", "recordings of brightness, from `capture brightness`", true}},
      std::move(flags),
      {{"wisp capture brightness candle.mp4 -o light.csv && wisp learn flicker light.csv -o light.wisp",
        "From a clip of a candle"},
       {"wisp capture brightness photodiode.csv --columns time,brightness --rate 100 -o light.csv && "
        "wisp learn flicker light.csv -o light.wisp",
        "From a photodiode"}},
      run_learn_flicker,
  };
}

}  // namespace wisp::cli
