// `wisp learn arx`: an ARX model of any recording.

#include <chrono>

#include "commands/commands.hpp"
#include "flags/order_flags.hpp"
#include "flags/recordings.hpp"
#include "reports/arx_description.hpp"
#include "reports/arx_figures.hpp"
#include "reports/arx_learning.hpp"
#include "reports/arx_parts.hpp"
#include "reports/arx_search.hpp"
#include "reports/curve_learning.hpp"
#include "reports/figures_json.hpp"
#include "reports/learned_model.hpp"
#include "terminal.hpp"

namespace wisp::cli {
namespace {

Model model_of(const ArxFit& fit, const ChannelChoice& channels, const ArxSources& sources,
               const Arguments& arguments) {
  Model model;
  model.name = std::filesystem::path(arguments.text("output")).stem().string();
  model.rate_hz = sources.rate_hz;
  auto span = sources.spans.begin();
  for (const std::string& name : channels.outputs) {
    model.outputs.push_back({.name = name, .unit = span->unit, .lowest = span->lowest, .highest = span->highest});
    ++span;
  }
  for (const std::string& name : channels.inputs) {
    model.inputs.push_back({.name = name, .unit = span->unit, .lowest = span->lowest, .highest = span->highest});
    ++span;
  }
  for (std::size_t k = 0; k < sources.curves.size(); ++k) {
    model.inputs[k].shape = InputShape::kCurve;
    model.inputs[k].curve = sources.curves[k];
  }
  model.dynamics = fit.model;
  model.training.program = "wisp " WISP_VERSION;
  for (const std::string& file : sources.files) {
    model.training.sources.push_back(std::filesystem::path(file).filename().string());
  }
  for (const char* flag : {"na", "nb", "nk", "coupling", "offset", "range", "input-curve"}) {
    const bool of_parts = arguments.on("merge") && std::string_view(flag) != "offset";  // the parts have their own
    if (arguments.has(flag) && !of_parts) model.training.recipe.push_back({flag, arguments.text(flag)});
  }
  if (fit.summary.stable.changed) model.training.recipe.push_back({"radius", arguments.text("radius")});
  model.training.figures = {{"fpe", fit.summary.fpe}, {"samples_used", static_cast<double>(fit.summary.samples_used)}};
  model.training.usable = fit.summary.usable;
  model.training.inputs.assign(model.inputs.size(), {});  // in the recordings' own units
  return model;
}

void report(const ArxFit& fit, const ChannelChoice& channels, Terminal& terminal) {
  const ArxSummary& summary = fit.summary;
  Json& result = terminal.result();
  result["na"] = json_of(fit.model.orders.na);
  result["nb"] = json_of(fit.model.orders.nb);
  result["nk"] = json_of(fit.model.orders.nk);
  describe_arx(fit.model, result);
  result["constant"] = json_of(fit.model.constant);
  result["operating_point"] = {{"outputs", json_of(fit.model.output_mean)}, {"inputs", json_of(fit.model.input_mean)}};
  result["V"] = json_of(summary.loss);
  const auto ny = channels.outputs.size();
  result["noise_covariance"] = Json::array();
  for (std::size_t i = 0; i < ny; ++i) {
    result["noise_covariance"].push_back(json_of(std::span(summary.noise_covariance).subspan(i * ny, ny)));
  }
  result["fpe"] = number(summary.fpe);
  result["aic"] = number(summary.aic);
  result["aicc"] = number(summary.aicc);
  result["bic"] = number(summary.bic);
  result["row_fpe"] = json_of(summary.row_fpe);
  result["fit_percent"] = {{"1", json_of(summary.fit_percent)}};
  if (!summary.free_run_fit_percent.empty()) result["fit_percent"]["inf"] = json_of(summary.free_run_fit_percent);
  result["samples_used"] = summary.samples_used;
  result["first_sample"] = summary.first_sample;
  result["episodes"] = {{"used", summary.episodes_used}, {"skipped", summary.episodes_skipped}};
  result["rows_left_out"] = summary.rows_left_out;
  result["condition"] = number(*std::max_element(summary.condition.begin(), summary.condition.end()));
  result["row_condition"] = json_of(summary.condition);
  result["method"] = summary.method;
  result["undetermined"] = Json::array();
  for (const RankProblem& problem : summary.rank_problems) {
    result["undetermined"].push_back(
        {{"row", problem.row}, {"channel", problem.channel}, {"lag", problem.lag}, {"reason", problem.reason}});
  }
  result["stable"] = json_of(summary.stable);
  result["usable"] = json_of(summary.usable);
  for (std::size_t i = 0; i < ny; ++i) {
    const std::string free_run = summary.free_run_fit_percent.empty()
                                     ? ""
                                     : ", free simulation " + shown(summary.free_run_fit_percent[i], 4) + " %";
    terminal.say(channels.outputs[i] + ": one-step fit " + shown(summary.fit_percent[i], 4) + " %" + free_run +
                 ", residual variance " + shown(summary.loss[i], 5));
  }
  terminal.say("FPE " + shown(summary.fpe, 6) + ", AIC " + shown(summary.aic, 6) + ", spectral radius " +
               shown(summary.stable.radius, 5) + (summary.stable.changed ? " (made stable)" : ""));
  terminal.say(std::string(summary.usable.verdict ? "usable: " : "not usable: ") + summary.usable.reason);
}

// What the residuals still know of their own past and of the inputs.
void report_tests(const ResidualTests& tests, const ChannelChoice& channels, Terminal& terminal) {
  Json white = Json::array(), independent = Json::array();
  for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
    white.push_back(number(tests.whiteness[i].p));
    Json row = Json::array();
    for (const Independence& pair : tests.independence[i]) row.push_back(number(pair.p));
    independent.push_back(std::move(row));
  }
  terminal.result()["whiteness_p"] = std::move(white);
  terminal.result()["independence_p"] = std::move(independent);
}

Result<void> draw(const LearnedArx& learned, const std::filesystem::path& folder, Terminal& terminal) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) return Error{folder.string() + ": cannot be made: " + code.message()};
  if (learned.tests) {
    if (auto ok = write_residual_figure(folder, *learned.tests, learned.channels); !ok) return ok;
  }
  const DrawnArx drawn{learned.fit.model, learned.channels, learned.sources.rate_hz, learned.fit.covariance};
  terminal.result()["responses"] = responses_json(drawn);
  return write_response_figures(folder, drawn);
}

Result<void> run(const Arguments& arguments, Terminal& terminal) {
  const auto start = std::chrono::steady_clock::now();
  if (const double radius = arguments.number("radius"); !(radius > 0 && radius < 1)) {
    return Error{"--radius is " + arguments.text("radius") + ", expected a number between 0 and 1"};
  }
  if (curve_knots_of(arguments) != 0 && (arguments.has("partial") || arguments.on("merge"))) {
    return Error{"--input-curve needs the recordings in one place: learn without --partial and --merge"};
  }
  if (arguments.has("partial")) return write_part(arguments, terminal);
  const auto learned = learn_arx(arguments, terminal);
  if (!learned) return learned.error();
  const ArxFit& fit = learned->fit;
  for (const std::string& warning : fit.summary.warnings) terminal.warn(warning);
  report(fit, learned->channels, terminal);
  if (learned->tests) report_tests(*learned->tests, learned->channels, terminal);
  say_poles(fit.model, learned->sources.rate_hz, terminal);
  const bool playable = fit.summary.stable.radius < 1;
  if (playable) {
    const Model model = model_of(fit, learned->channels, learned->sources, arguments);
    if (auto ok = write_learned(arguments.text("output"), model); !ok) return ok;
  } else {
    terminal.warn(arguments.text("output") + " was not written: an unstable model cannot be played");
  }
  if (arguments.has("figures")) {
    if (auto ok = draw(*learned, arguments.text("figures"), terminal); !ok) return ok;
  }
  terminal.result()["output"] = playable ? Json(arguments.text("output")) : Json(nullptr);
  terminal.result()["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {};
}

std::vector<Flag> flags() {
  std::vector<Flag> all = {
      {"output", Kind::kPath, "M.wisp", "", "where to write the model", {}, true, "partial"},
      {"inputs", Kind::kNames, "A,B", "", "channels that are inputs; none: a model of the outputs alone"},
      {"outputs", Kind::kNames, "C,D", "", "channels that are outputs", {}, true, "merge"},
  };
  for (Flag& flag : order_flags({"4", "", "; auto finds every input's delay to every output"}))
    all.push_back(std::move(flag));
  all.insert(
      all.end(),
      {
          {"range", Kind::kSamples, "A:B", "", "rows to learn from, 1-based and inclusive"},
          {"offset",
           Kind::kChoice,
           "O",
           "mean",
           "the operating point: mean removes means, none, estimate adds a constant term",
           {"mean", "none", "estimate"}},
          {"noise-model", Kind::kText, "M", "white",
           "what colours the residual: white; ar:N (ARARX, v = e/D) or ma:N (ARMAX, v = C e), by prediction errors; "
           "the "
           "model that is written has a white residual and the more lags. Needs the recordings in memory"},
          {"ridge", Kind::kNumber, "R", "0", "weight of the coefficients' size, as a share of each regressor's energy"},
          {"radius", Kind::kNumber, "R", "0.999",
           "an unstable estimate is brought within this spectral radius, between 0 and 1, with the least loss of fit; "
           "a "
           "smaller one may simulate better"},
          {"keep-unstable", Kind::kSwitch, "", "",
           "leave an unstable estimate as it is, to compare; it cannot be played"},
          {"common-start", Kind::kSwitch, "", "",
           "judge all candidates of --search, and fit the best, on the same rows: those that the longest one can "
           "predict"},
      });
  all.push_back(curve_flag("0", "; needs the recordings in memory"));
  all.push_back(
      {"figures", Kind::kPath, "DIR", "",
       "draw poles and zeros, step and frequency responses with their 95 % bands, and residual tests there; --json "
       "has their numbers as responses"});
  all.push_back({"memory", Kind::kInteger, "MIB", "256",
                 "recordings that are larger than this together are read a stretch at a time (never with --search)"});
  for (auto* more : {&search_flags, &part_flags, &recording_flags}) {
    for (Flag& flag : (*more)()) all.push_back(std::move(flag));
  }
  return all;
}

}  // namespace

Command learn_arx_command() {
  return {
      "learn arx",
      "Estimates an ARX model by least squares: y(t) + A1 y(t-1) + … = B1 u(t-nk) + … + e(t).",
      {{"REC",
        "recordings: CSV files, or MATLAB files whose variables --inputs and --outputs name; with --merge, parts",
        true}},
      flags(),
      {
          {"wisp learn arx hairdryer.csv -o dryer.wisp --inputs u1 --outputs y1 --dt 0.08 --na 2 --nb 2 --nk 3 --range "
           "1:300",
           "A classic: a hair dryer's air temperature from its heating power"},
          {"wisp learn arx hairdryer.csv -o dryer.wisp --inputs u1 --outputs y1 --dt 0.08 --range 1:500 "
           "--search na=1:10,nb=1:10,nk=0:3 --by validation --validate 501:1000",
           "The orders that predict unseen rows best"},
          {"wisp learn arx long.csv --partial 2.part --part 2/8 --inputs u --outputs y && wisp learn arx --merge "
           "*.part "
           "-o long.wisp",
           "One of eight jobs, each with its share of the rows, and what makes one model of all of them"},
      },
      run,
  };
}

}  // namespace wisp::cli
