// `wisp learn switched`: ARX modes switched by a Markov chain; `wisp learn flicker`: the same for flame light in lamps.

#include "commands/commands.hpp"
#include "flags/arx_flags.hpp"
#include "flags/recipe_flags.hpp"
#include "flags/recordings.hpp"
#include "reports/learned_model.hpp"
#include "terminal.hpp"
#include "wisp/learn/learn.hpp"

namespace wisp::cli {
namespace {

Result<SwitchedRecipe> switched_recipe(const Arguments& arguments) {
  if (arguments.text("nk") == "auto") {
    return Error{"--nk is auto, which `learn switched` does not find: `learn arx --nk auto` does, for a single model"};
  }
  SwitchedRecipe recipe;
  if (auto ok = read_recipe(arguments, recipe); !ok) return ok.error();
  auto na = order_choice(arguments, "na"), nb = order_choice(arguments, "nb"), nk = order_choice(arguments, "nk");
  for (const auto* choice : {&na, &nb, &nk}) {
    if (!*choice) return choice->error();
  }
  recipe.name = model_name(arguments);
  recipe.na = *std::move(na);
  recipe.nb = *std::move(nb);
  recipe.nk = *std::move(nk);
  return recipe;
}

Result<void> run_learn_switched(const Arguments& arguments, Terminal& terminal) {
  const auto recipe = switched_recipe(arguments);
  if (!recipe) return recipe.error();
  auto whole = read_tables(arguments.positionals(), arguments, terminal);
  if (!whole) return whole.error();
  const auto recordings = in_range(std::move(*whole), arguments, terminal);
  if (!recordings) return recordings.error();
  auto fit = learn(*recordings, *recipe, terminal.progress());
  if (!fit) return fit.error();
  if (arguments.has("range")) fit->model.training.recipe.push_back({"range", arguments.text("range")});
  return hand_over(fit, arguments, terminal);
}

std::vector<Flag> switched_flags() {
  const Flag range{"range", Kind::kSamples, "A:B", "", "rows to learn from, 1-based and inclusive"};
  auto of_recipe = recipe_flags(SwitchedRecipe{});
  flag_named(of_recipe, "outputs").required = true;
  return flags_of({{output_flag(), range}, of_recipe, order_flags({"2", " in every mode"}), recording_flags()});
}

Result<void> run_learn_flicker(const Arguments& arguments, Terminal& terminal) {
  FlickerRecipe recipe;
  if (auto ok = read_recipe(arguments, recipe); !ok) return ok;
  recipe.name = model_name(arguments);
  // A plain table states no roles: --channel names its column of light, and without it every column is an output.
  CsvOptions plain{.every_column = recipe.output.empty()};
  if (!recipe.output.empty()) plain.outputs = {recipe.output};
  const auto recordings = read_tables(arguments.positionals(), arguments, terminal, plain);
  if (!recordings) return recordings.error();
  return hand_over(learn(*recordings, recipe, terminal.progress()), arguments, terminal);
}

}  // namespace

Command learn_switched_command() {
  return {
      "learn switched",
      "Estimates several ARX modes and the Markov chain that switches them.",
      {{"REC", "recordings: CSV files, or MATLAB files whose variables --inputs and --outputs name", true}},
      switched_flags(),
      {
          {"wisp learn switched gusts.csv -o gusts.wisp --inputs u --outputs y --modes 3",
           "Three modes that follow each other by chance"},
      },
      run_learn_switched,
  };
}

Command learn_flicker_command() {
  return {
      "learn flicker",
      "Learns the light of a flame, calm and restless by turns, for a lamp to play.",
      {{"REC", "recordings of brightness, from `capture brightness`", true}},
      flags_of({{output_flag()}, recipe_flags(FlickerRecipe{}), recording_flags()}),
      {{"wisp capture brightness candle.mp4 -o light.csv && wisp learn flicker light.csv -o light.wisp",
        "From a clip of a candle"},
       {"wisp capture brightness photodiode.csv --columns time,brightness --rate 100 -o light.csv && "
        "wisp learn flicker light.csv -o light.wisp",
        "From a photodiode"}},
      run_learn_flicker,
  };
}

}  // namespace wisp::cli
