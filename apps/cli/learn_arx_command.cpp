// `wisp learn arx`: an ARX model of any recording.

#include <chrono>

#include "arx_search.hpp"
#include "commands.hpp"
#include "figures_json.hpp"
#include "order_flags.hpp"
#include "recordings.hpp"
#include "terminal.hpp"
#include "wisp/learn/arx_fit.hpp"
#include "wisp/model/file.hpp"

namespace wisp::cli {
namespace {

ArxOffset offset_of(const Arguments& arguments) {
  if (arguments.text("offset") == "none") return ArxOffset::kNone;
  return arguments.text("offset") == "estimate" ? ArxOffset::kEstimate : ArxOffset::kMean;
}

// Lowest and highest of a channel over all recordings.
template <class Channel>
void take_range(Channel& channel, const std::vector<Recording>& recordings) {
  bool first = true;
  for (const Recording& recording : recordings) {
    const auto& found = recording.channels[*find_channel(recording, channel.name)];
    channel.unit = found.unit;
    for (double sample : found.samples) {
      if (std::isnan(sample)) continue;
      channel.lowest = first ? sample : std::min(channel.lowest, sample);
      channel.highest = first ? sample : std::max(channel.highest, sample);
      first = false;
    }
  }
}

Model model_of(const ArxFit& fit, const ChannelChoice& channels, const std::vector<Recording>& recordings,
               const Arguments& arguments) {
  Model model;
  model.name = std::filesystem::path(arguments.text("output")).stem().string();
  model.rate_hz = recordings.front().rate_hz;
  for (const std::string& name : channels.inputs) {
    model.inputs.push_back({.name = name, .unit = "", .lowest = 0, .highest = 0});
    take_range(model.inputs.back(), recordings);
  }
  for (const std::string& name : channels.outputs) {
    model.outputs.push_back({.name = name, .unit = "", .lowest = 0, .highest = 0});
    take_range(model.outputs.back(), recordings);
  }
  model.dynamics = fit.model;
  model.provenance.program = "wisp " WISP_VERSION;
  for (const Recording& recording : recordings) {
    model.provenance.sources.push_back(std::filesystem::path(recording.source).filename().string());
  }
  for (const char* flag : {"na", "nb", "nk", "coupling", "offset", "range"}) {
    if (arguments.has(flag)) model.provenance.options.push_back({flag, arguments.text(flag)});
  }
  model.provenance.figures = {{"fpe", fit.summary.fpe},
                              {"samples_used", static_cast<double>(fit.summary.samples_used)}};
  model.provenance.usable = fit.summary.usable;
  return model;
}

Result<void> report(const ArxFit& fit, const ChannelChoice& channels, Terminal& terminal) {
  const ArxSummary& summary = fit.summary;
  Json& result = terminal.result();
  const auto theta = json_of(fit.model.orders, fit.model.theta);
  const auto errors = json_of(fit.model.orders, fit.model.std_error);
  result["na"] = json_of(fit.model.orders.na);
  result["nb"] = json_of(fit.model.orders.nb);
  result["nk"] = json_of(fit.model.orders.nk);
  result["A"] = theta.a;
  result["B"] = theta.b;
  result["std_error"] = {{"A", errors.a}, {"B", errors.b}};
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
  result["samples_used"] = summary.samples_used;
  result["first_sample"] = summary.first_sample;
  result["episodes"] = {{"used", summary.episodes_used}, {"skipped", summary.episodes_skipped}};
  result["rows_left_out"] = summary.rows_left_out;
  result["condition"] = number(*std::max_element(summary.condition.begin(), summary.condition.end()));
  result["row_condition"] = json_of(summary.condition);
  result["method"] = summary.method;
  result["stable"] = json_of(summary.stable);
  result["usable"] = json_of(summary.usable);
  for (std::size_t i = 0; i < ny; ++i) {
    terminal.say(channels.outputs[i] + ": one-step fit " + shown(summary.fit_percent[i], 4) + " %, residual variance " +
                 shown(summary.loss[i], 5));
  }
  terminal.say("FPE " + shown(summary.fpe, 6) + ", AIC " + shown(summary.aic, 6) + ", spectral radius " +
               shown(summary.stable.radius, 5) + (summary.stable.changed ? " (made stable)" : ""));
  terminal.say(std::string(summary.usable.verdict ? "usable: " : "not usable: ") + summary.usable.reason);
  return {};
}

Result<std::vector<Recording>> ranged(const std::vector<Recording>& whole, const Arguments& arguments) {
  std::vector<Recording> parts;
  for (const Recording& recording : whole) {
    auto part = in_range(recording, arguments, "range");
    if (!part) return part.error();
    parts.push_back(std::move(*part));
  }
  return parts;
}

Result<void> run(const Arguments& arguments, Terminal& terminal) {
  const auto start = std::chrono::steady_clock::now();
  const auto whole = read_tables(arguments.positionals(), arguments, terminal);
  if (!whole) return whole.error();
  const auto recordings = ranged(*whole, arguments);
  if (!recordings) return recordings.error();
  const ChannelChoice channels{arguments.names("inputs"), arguments.names("outputs")};
  auto orders = arguments.has("search") ? search_arx_orders(*recordings, *whole, channels, arguments, terminal)
                                        : orders_from(arguments, static_cast<int>(channels.outputs.size()),
                                                      static_cast<int>(channels.inputs.size()));
  if (!orders) return orders.error();
  ArxOptions options;
  options.orders = std::move(*orders);
  options.offset = offset_of(arguments);
  options.ridge = arguments.number("ridge");
  const auto fit = fit_arx(*recordings, channels, options);
  if (!fit) return fit.error();
  for (const std::string& warning : fit->summary.warnings) terminal.warn(warning);
  if (auto ok = report(*fit, channels, terminal); !ok) return ok;
  if (auto ok = write_model(arguments.text("output"), model_of(*fit, channels, *recordings, arguments)); !ok) return ok;
  terminal.result()["output"] = arguments.text("output");
  terminal.result()["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {};
}

std::vector<Flag> flags() {
  std::vector<Flag> all = {
      {"output", Kind::kPath, "M.wisp", "", "where to write the model", {}, true},
      {"inputs", Kind::kNames, "A,B", "", "channels that are inputs; none: a model of the outputs alone"},
      {"outputs", Kind::kNames, "C,D", "", "channels that are outputs", {}, true},
      {"na", Kind::kText, "N", "4", "order of A: a number, or a matrix row by row such as '4,2;3,4'"},
      {"nb", Kind::kText, "N", "4", "order of B: a number, or a matrix with a row an output and a column an input"},
      {"nk", Kind::kText, "N", "1", "delay in samples, likewise"},
      {"coupling",
       Kind::kChoice,
       "C",
       "full",
       "which outputs appear in an output's equation: full, diagonal, band",
       {"full", "diagonal", "band"}},
      {"range", Kind::kSamples, "A:B", "", "rows to learn from, 1-based and inclusive"},
      {"offset",
       Kind::kChoice,
       "O",
       "mean",
       "the operating point: mean removes means, none, estimate adds a constant term",
       {"mean", "none", "estimate"}},
      {"ridge", Kind::kNumber, "R", "0", "weight of the coefficients' size, as a share of each regressor's energy"},
      {"common-start", Kind::kSwitch, "", "",
       "judge all candidates of --search on the same rows, those that the longest one can predict"},
  };
  for (auto* more : {&search_flags, &recording_flags}) {
    for (Flag& flag : (*more)()) all.push_back(std::move(flag));
  }
  return all;
}

}  // namespace

Command learn_arx_command() {
  return {
      "learn arx",
      "Estimates an ARX model by least squares: y(t) + A1 y(t-1) + … = B1 u(t-nk) + … + e(t).",
      {{"REC", "recordings: CSV files, or MATLAB files whose variables --inputs and --outputs name", true}},
      flags(),
      {
          {"wisp learn arx hairdryer.csv -o dryer.wisp --inputs u1 --outputs y1 --dt 0.08 --na 2 --nb 2 --nk 3 --range "
           "1:300",
           "A classic: a hair dryer's air temperature from its heating power"},
          {"wisp learn arx hairdryer.csv -o dryer.wisp --inputs u1 --outputs y1 --dt 0.08 --range 1:500 "
           "--search na=1:10,nb=1:10,nk=0:3 --by validation --validate 501:1000",
           "The orders that predict unseen rows best"},
      },
      run,
  };
}

}  // namespace wisp::cli
