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

// Reads recordings of falls, within --range. A pair (windy and calm) stays whole, as a gust needs all repeated falls.
// With --skip-bad those without valid motion are skipped; otherwise learning reports the error.
Result<std::vector<Recording>> read_motions(const Arguments& arguments, Terminal& terminal) {
  return read_all(arguments.positionals(), arguments, terminal, [&](const std::string& path) -> Result<Recording> {
    auto falls = read_table(path, arguments, motion_table(arguments));
    if (falls && !find_attribute(*falls, "pair")) falls = in_range(*std::move(falls), arguments, "range");
    if (!falls || !arguments.on("skip-bad")) return falls;
    const auto sound = check_motion(*falls);
    return sound ? std::move(falls) : sound.error();
  });
}

Result<void> run_learn_chain(const Arguments& arguments, Terminal& terminal) {
  ChainRecipe recipe;
  if (auto ok = read_recipe(arguments, recipe); !ok) return ok;
  recipe.name = model_name(arguments);
  const auto recordings = read_motions(arguments, terminal);
  if (!recordings) return recordings.error();
  return hand_over(learn(*recordings, recipe, terminal.progress()), arguments, terminal);
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
