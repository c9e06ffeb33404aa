// `wisp learn switched`: several ARX modes that a Markov chain switches.

#include <chrono>

#include "commands/commands.hpp"
#include "flags/order_flags.hpp"
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
  if (arguments.text("modes") == "0") return Error{"--modes is 0, expected 1 to 64, or auto"};
  auto na = order_choice(arguments, "na"), nb = order_choice(arguments, "nb"), nk = order_choice(arguments, "nk");
  for (const auto* choice : {&na, &nb, &nk}) {
    if (!*choice) return choice->error();
  }
  return SwitchedRecipe{
      .name = model_name(arguments),
      .inputs = arguments.names("inputs"),
      .outputs = arguments.names("outputs"),
      .na = std::move(*na),
      .nb = std::move(*nb),
      .nk = std::move(*nk),
      .coupling = coupling_of(arguments),
      .modes = arguments.text("modes") == "auto" ? std::nullopt : std::optional(arguments.integer("modes")),
      .seed = static_cast<std::uint64_t>(arguments.integer("seed"))};
}

Result<void> run_learn_switched(const Arguments& arguments, Terminal& terminal) {
  const auto start = std::chrono::steady_clock::now();
  const auto recipe = switched_recipe(arguments);
  if (!recipe) return recipe.error();
  auto whole = read_tables(arguments.positionals(), arguments, terminal);
  if (!whole) return whole.error();
  const auto recordings = in_range(std::move(*whole), arguments);
  if (!recordings) return recordings.error();
  auto fit = learn(*recordings, *recipe, terminal.progress());
  if (!fit) return fit.error();
  if (arguments.has("range")) fit->model.training.recipe.push_back({"range", arguments.text("range")});
  return hand_over(*fit, model_path(arguments), start, terminal);
}

std::vector<Flag> switched_flags() {
  std::vector<Flag> all = {
      output_flag(),
      {"inputs", Kind::kNames, "A,B", "", "channels that are inputs; none: a model of the outputs alone"},
      {"outputs", Kind::kNames, "C,D", "", "channels that are outputs", {}, true},
  };
  for (Flag& flag : order_flags({"2", " in every mode"})) all.push_back(std::move(flag));
  all.insert(all.end(), {
                            {"modes",
                             Kind::kIntegerOrWord,
                             "K",
                             "auto",
                             "how many, or auto: as many, up to 6, as predict held-out rows surely better",
                             {"auto"}},
                            {"range", Kind::kSamples, "A:B", "", "rows to learn from, 1-based and inclusive"},
                            {"seed", Kind::kInteger, "N", "1", "of the starts that are tried"},
                        });
  for (Flag& flag : recording_flags()) all.push_back(std::move(flag));
  return all;
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

}  // namespace wisp::cli
