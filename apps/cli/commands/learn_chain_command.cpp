// `wisp learn chain` and its preset `wisp learn leaf`: learn a segment chain from recorded motion.

#include "commands/commands.hpp"
#include "flags/motion_flags.hpp"
#include "flags/recipe_flags.hpp"
#include "flags/recordings.hpp"
#include "reports/learned_model.hpp"
#include "terminal.hpp"
#include "wisp/learn/learn.hpp"

namespace wisp::cli {
namespace {

// Applies --range to recordings of falls. A pair (windy and calm) stays whole, as a gust needs all repeated falls.
Result<std::vector<Recording>> falls_in_range(std::vector<Recording> recordings, const Arguments& arguments) {
  for (Recording& recording : recordings) {
    if (find_attribute(recording, "pair")) continue;
    auto part = in_range(std::move(recording), arguments, "range");
    if (!part) return part.error();
    recording = std::move(*part);
  }
  return recordings;
}

// Reads recordings. With --skip-bad those without valid motion are skipped; otherwise learning reports the error.
Result<std::vector<Recording>> read_motions(const Arguments& arguments, Terminal& terminal) {
  auto recordings = read_tables(arguments.positionals(), arguments, terminal, motion_table(arguments));
  if (!recordings || !arguments.on("skip-bad")) return recordings;
  std::erase_if(*recordings, [&](const Recording& recording) {
    const auto sound = check_motion(recording);
    return !sound && leave_out(recording.source, sound.error(), arguments, terminal);
  });
  if (recordings->empty()) return Error{arguments.positionals().front() + ": none of the recordings can be used"};
  return recordings;
}

Result<void> run_learn_chain(const Arguments& arguments, Terminal& terminal) {
  ChainRecipe recipe;
  if (auto ok = read_recipe(arguments, recipe); !ok) return ok;
  recipe.name = model_name(arguments);
  const std::string output = model_path(arguments);
  if (auto ok = check_writable(output); !ok) return ok;
  auto read = read_motions(arguments, terminal);
  if (!read) return read.error();
  const auto recordings = falls_in_range(std::move(*read), arguments);
  if (!recordings) return recordings.error();
  const auto fit = learn(*recordings, recipe, terminal.progress());
  if (!fit) return fit.error();
  return hand_over(*fit, output, terminal);
}

std::vector<Flag> flags(const ChainRecipe& defaults) {
  const std::vector<Flag> of_tables = {
      {"range", Kind::kSamples, "A:B", "", "rows to learn falls from, 1-based and inclusive"},
      {"inputs", Kind::kNames, "A,B", "", "columns of a plain table that are inputs"},
      {"outputs", Kind::kNames, "C,D", "", "columns of a plain table that are outputs"},
  };
  return flags_of({{output_flag()}, recipe_flags(defaults), of_tables, motion_flags(), recording_flags()});
}

constexpr const char* kRecordings =
    "recordings with pos.x, pos.y, pos.z (metres, z up) and, where known, q.w, q.x, q.y, q.z; two that share the "
    "attribute pair, one windy and one calm, teach the response to gusts";

}  // namespace

Command learn_chain_command() {
  return {
      "learn chain",
      "Learns a chain of segments from recordings of something that moves: cut at events, sorted into modes, counted.",
      {{"REC", kRecordings, true}},
      flags(ChainRecipe{}),
      {{"wisp learn chain falls.csv -o disc.wisp --event min:horizontal_speed --smooth 7",
        "Tracks of falling paper: positions only"}},
      run_learn_chain,
  };
}

Command learn_leaf_command() {
  return {
      "learn leaf",
      "Learns how a leaf falls: `learn chain`, cut where the leaf stalls.",
      {{"REC", kRecordings, true}},
      flags(LeafRecipe{}),
      {{"wisp learn leaf drops.csv -o leaf.wisp", "From `wisp simulate leaf`"},
       {"wisp learn leaf drops.csv gusts.csv gusts.calm.csv -o leaf.wisp",
        "The same with its response to gusts, from `wisp simulate leaf --pairs`"},
       {"wisp learn leaf drops.csv -o paper.wisp --modes 6 --best-of 0 --blend 0", "The paper's own chain"}},
      run_learn_chain,
  };
}

}  // namespace wisp::cli
