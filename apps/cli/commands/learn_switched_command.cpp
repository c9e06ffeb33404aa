// `wisp learn switched`: several ARX modes, and what decides between them.

#include <chrono>
#include <cmath>

#include "commands/commands.hpp"
#include "flags/order_flags.hpp"
#include "flags/recordings.hpp"
#include "reports/figures_json.hpp"
#include "reports/learned_model.hpp"
#include "reports/switched_description.hpp"
#include "terminal.hpp"
#include "wisp/learn/switched_fit.hpp"

namespace wisp::cli {
namespace {

struct Range {
  std::string unit;
  double lowest = 0;
  double highest = 0;
};

Range range_of(const std::string& name, const std::vector<Recording>& recordings) {
  Range range;
  bool first = true;
  for (const Recording& recording : recordings) {
    const auto& found = recording.channels[*find_channel(recording, name)];
    range.unit = found.unit;
    for (double sample : found.samples) {
      if (std::isnan(sample)) continue;
      range.lowest = first ? sample : std::min(range.lowest, sample);
      range.highest = first ? sample : std::max(range.highest, sample);
      first = false;
    }
  }
  return range;
}

Model model_of(const SwitchedFit& fit, const ChannelChoice& channels, const std::vector<Recording>& recordings,
               const Arguments& arguments) {
  Model model;
  model.name = std::filesystem::path(arguments.text("output")).stem().string();
  model.rate_hz = recordings.front().rate_hz;
  for (const std::string& name : channels.outputs) {
    const Range range = range_of(name, recordings);
    model.outputs.push_back({name, range.unit, range.lowest, range.highest});
  }
  for (const std::string& name : channels.inputs) {
    const Range range = range_of(name, recordings);
    model.inputs.push_back({name, range.unit, range.lowest, range.highest, InputShape::kLinear});
  }
  model.dynamics = fit.model;
  model.training.program = "wisp " WISP_VERSION;
  for (const Recording& recording : recordings) {
    model.training.sources.push_back(std::filesystem::path(recording.source).filename().string());
  }
  for (const char* flag : {"na", "nb", "nk", "coupling", "offset", "range", "modes", "switching"}) {
    if (arguments.has(flag)) model.training.recipe.push_back({flag, arguments.text(flag)});
  }
  model.training.figures = {{"samples_used", static_cast<double>(fit.summary.samples_used)},
                            {"held_out", static_cast<double>(fit.summary.held_out)}};
  for (const SwitchedCandidate& candidate : fit.summary.candidates) {
    model.training.figures.push_back(
        {"held_out_log_likelihood_" + std::to_string(candidate.modes), candidate.held_out_log_likelihood});
  }
  model.training.usable = fit.summary.usable;
  model.training.inputs.assign(model.inputs.size(), {});  // in the recordings' own units
  return model;
}

void report_differences(const std::vector<ModeDifference>& differences, Terminal& terminal) {
  Json& all = terminal.result()["mode_differences"] = Json::array();
  for (const ModeDifference& pair : differences) {
    all.push_back({{"modes", {pair.first, pair.second}},
                   {"coefficients", pair.coefficients},
                   {"compared", pair.compared},
                   {"most_std_errors", number(pair.most_std_errors)},
                   {"noise_ratio", number(pair.noise_ratio)}});
    const std::string times = ", noise " + shown(pair.noise_ratio, 2) + " times as large";
    terminal.say("modes " + std::to_string(pair.first) + " and " + std::to_string(pair.second) +
                 (pair.same_coefficients()
                      ? " differ in the size of their noise alone: no coefficient by more than 3 standard errors"
                      : " differ in " + std::to_string(pair.coefficients) + " of " + std::to_string(pair.compared) +
                            " coefficients by more than 3 standard errors") +
                 times);
  }
}

void report(const SwitchedFit& fit, const ChannelChoice& channels, Terminal& terminal) {
  const SwitchedSummary& summary = fit.summary;
  Json& result = terminal.result();
  result["switching"] = fit.model.switching == Switching::kMarkov ? "markov" : "regions";
  describe_switched(fit.model, result);
  result["candidates"] = Json::array();
  for (const SwitchedCandidate& candidate : summary.candidates) {
    result["candidates"].push_back({{"modes", candidate.modes},
                                    {"log_likelihood", number(candidate.log_likelihood)},
                                    {"held_out_log_likelihood", number(candidate.held_out_log_likelihood)},
                                    {"gain_std_error", number(candidate.gain_std_error)},
                                    {"determined", candidate.determined}});
    terminal.say(std::to_string(candidate.modes) + (candidate.modes == 1 ? " mode: " : " modes: ") +
                 shown(candidate.held_out_log_likelihood, 4) + " a row held out" +
                 (candidate.determined ? "" : ", but a mode has too few rows"));
  }
  result["mode_rows"] = summary.mode_rows;
  result["mode_changed"] = summary.mode_changed;
  result["samples_used"] = summary.samples_used;
  result["held_out"] = summary.held_out;
  result["fit_percent"] = {{"1", json_of(summary.fit_percent)}};
  if (!summary.free_run_fit_percent.empty()) result["fit_percent"]["inf"] = json_of(summary.free_run_fit_percent);
  result["usable"] = json_of(summary.usable);
  for (std::size_t k = 0; k < summary.mode_rows.size(); ++k) {
    terminal.say("mode " + std::to_string(k) + ": acts in " + std::to_string(summary.mode_rows[k]) +
                 " rows, spectral radius " + shown(summary.mode_radius[k], 5));
  }
  report_differences(summary.differences, terminal);
  for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
    const std::string free_run = summary.free_run_fit_percent.empty()
                                     ? ""
                                     : ", free simulation " + shown(summary.free_run_fit_percent[i], 4) + " %";
    terminal.say(channels.outputs[i] + ": one-step fit " + shown(summary.fit_percent[i], 4) + " %" + free_run);
  }
  terminal.say("bounded by " + result["bounded_by"].get<std::string>());
  terminal.say(std::string(summary.usable.verdict ? "usable: " : "not usable: ") + summary.usable.reason);
}

Result<std::vector<Recording>> ranged(std::vector<Recording> whole, const Arguments& arguments) {
  for (Recording& recording : whole) {
    auto part = in_range(std::move(recording), arguments, "range");
    if (!part) return part.error();
    recording = std::move(*part);
  }
  return whole;
}

Result<void> run(const Arguments& arguments, Terminal& terminal) {
  const auto start = std::chrono::steady_clock::now();
  if (arguments.text("nk") == "auto") {
    return Error{"--nk is auto, which `learn switched` does not find: `learn arx --nk auto` does, for a single model"};
  }
  if (arguments.text("modes") == "0") return Error{"--modes is 0, expected 1 to 64, or auto"};
  terminal.result()["seed"] = arguments.integer("seed");
  auto whole = read_tables(arguments.positionals(), arguments, terminal);
  if (!whole) return whole.error();
  const auto recordings = ranged(std::move(*whole), arguments);
  if (!recordings) return recordings.error();
  const ChannelChoice channels{arguments.names("inputs"), arguments.names("outputs")};
  auto orders =
      orders_from(arguments, static_cast<int>(channels.outputs.size()), static_cast<int>(channels.inputs.size()));
  if (!orders) return orders.error();
  SwitchedOptions options;
  options.orders = std::move(*orders);
  options.switching = arguments.text("switching") == "markov" ? Switching::kMarkov : Switching::kRegions;
  options.modes = arguments.text("modes") == "auto" ? 0 : arguments.integer("modes");
  options.most_modes = arguments.integer("most-modes");
  options.subtract_means = arguments.text("offset") == "mean";
  options.holdout = arguments.number("holdout");
  options.seed = static_cast<std::uint64_t>(arguments.integer("seed"));
  const auto fit = fit_switched(*recordings, channels, options);
  if (!fit) return fit.error();
  for (const std::string& warning : fit->summary.warnings) terminal.warn(warning);
  report(*fit, channels, terminal);
  if (auto ok = write_learned(arguments.text("output"), model_of(*fit, channels, *recordings, arguments)); !ok)
    return ok;
  terminal.result()["output"] = arguments.text("output");
  terminal.result()["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {};
}

std::vector<Flag> flags() {
  std::vector<Flag> all = {
      {"output", Kind::kPath, "M.wisp", "", "where to write the model", {}, true},
      {"inputs", Kind::kNames, "A,B", "", "channels that are inputs; none: a model of the outputs alone"},
      {"outputs", Kind::kNames, "C,D", "", "channels that are outputs", {}, true},
  };
  for (Flag& flag : order_flags({"2", " in every mode"})) all.push_back(std::move(flag));
  all.insert(
      all.end(),
      {
          {"switching",
           Kind::kChoice,
           "S",
           "regions",
           "what decides which mode acts: regions of the regressors, or a Markov chain",
           {"regions", "markov"}},
          {"modes",
           Kind::kIntegerOrWord,
           "K",
           "auto",
           "how many, or auto: as many as predict rows held out surely better",
           {"auto"}},
          {"most-modes", Kind::kInteger, "K", "6", "the largest number that auto tries"},
          {"holdout", Kind::kNumber, "P", "0.3", "share of each stretch, its end, that judges the number of modes"},
          {"range", Kind::kSamples, "A:B", "", "rows to learn from, 1-based and inclusive"},
          {"offset",
           Kind::kChoice,
           "O",
           "mean",
           "the operating point: mean removes means, none does not; every mode has a constant either way",
           {"mean", "none"}},
          {"seed", Kind::kInteger, "N", "1", "of the starts that are tried"},
      });
  for (Flag& flag : recording_flags()) all.push_back(std::move(flag));
  return all;
}

}  // namespace

Command learn_switched_command() {
  return {
      "learn switched",
      "Estimates several ARX modes, and the regions or the Markov chain that decide which of them acts.",
      {{"REC", "recordings: CSV files, or MATLAB files whose variables --inputs and --outputs name", true}},
      flags(),
      {
          {"wisp learn switched tanks.csv -o tanks.wisp --inputs u1 --outputs y1 --dt 4 --na 2 --nb 2 --nk 1",
           "A tank that overflows: as many regions as rows held out ask for"},
          {"wisp learn switched gusts.csv -o gusts.wisp --inputs u --outputs y --switching markov --modes 3",
           "Three modes that follow each other by chance"},
      },
      run,
  };
}

}  // namespace wisp::cli
