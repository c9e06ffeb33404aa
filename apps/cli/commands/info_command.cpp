// `wisp info`: what a model file holds.

#include "commands/commands.hpp"
#include "reports/figures_json.hpp"
#include "terminal.hpp"
#include "wisp/base/file.hpp"
#include "wisp/learn/dynamics_report.hpp"
#include "wisp/learn/extinction_report.hpp"
#include "wisp/model/file.hpp"

namespace wisp::cli {
namespace {

// A curve as knot → value pairs.
std::string curve_text(const InputCurve& curve) {
  std::string text;
  for (std::size_t k = 0; k < curve.at.size(); ++k) {
    text += (k > 0 ? ", " : "") + shown(curve.at[k]) + " → " + shown(curve.value[k]);
  }
  return text;
}

Json channels_of(const Model& model) {
  Json inputs = Json::array(), outputs = Json::array();
  for (const Input& input : model.inputs) {
    inputs.push_back({{"name", input.name},
                      {"unit", input.unit},
                      {"range", {number(input.lowest), number(input.highest)}},
                      {"shape", std::string(splits_sign(input.shape) ? "split sign" : "linear") +
                                    (has_curve(input.shape) ? " bent by a curve" : "") +
                                    (has_powers(input.shape) ? ", its square root and its square" : "")}});
    if (has_curve(input.shape)) {
      inputs.back()["curve"] = {{"at", json_of(input.curve.at)}, {"value", json_of(input.curve.value)}};
    }
  }
  for (const Output& output : model.outputs) {
    outputs.push_back(
        {{"name", output.name}, {"unit", output.unit}, {"range", {number(output.lowest), number(output.highest)}}});
  }
  return {{"inputs", inputs}, {"outputs", outputs}};
}

Json view_of(const Model& model) {
  if (const auto* pose = std::get_if<PoseView>(&model.view)) {
    return {{"kind", "pose"}, {"half_width", number(pose->half_width)}, {"half_length", number(pose->half_length)}};
  }
  if (const auto* position = std::get_if<PositionView>(&model.view)) {
    return {{"kind", "position"}, {"half_width", number(position->half_width)}};
  }
  const auto* outline = std::get_if<OutlineView>(&model.view);
  if (!outline) return {{"kind", "plain"}};
  return {{"kind", "outline"},
          {"points", model.outputs.size() / 2},
          {"knots", json_of(outline->knots)},
          {"metres_per_unit", number(outline->metres_per_unit)},
          {"pixels_per_unit", number(outline->pixels_per_unit)}};
}

Json dynamics_of(const ArxModel& arx) {
  return {{"kind", "arx"},
          {"na", json_of(arx.orders.na)},
          {"nb", json_of(arx.orders.nb)},
          {"nk", json_of(arx.orders.nk)},
          {"history", arx.orders.history()},
          {"noise_rank", arx.noise.rank},
          {"radius", number(spectral_radius(arx))}};
}

std::string played_as(const ChainModel& chain) {
  if (chain.splines) return "splines";
  return chain.systems ? "systems" : "segments";
}

Json rows_of(const std::vector<double>& matrix, int columns) {
  Json rows = Json::array();
  for (std::size_t k = 0; k < matrix.size(); k += static_cast<std::size_t>(columns)) {
    rows.push_back(json_of(std::span(matrix).subspan(k, static_cast<std::size_t>(columns))));
  }
  return rows;
}

Json dynamics_of(const ChainModel& chain) {
  return {{"kind", "chain"},
          {"played_as", played_as(chain)},
          {"segments", chain.segments.size()},
          {"modes", chain.modes},
          {"history", chain.history()},
          {"histories", chain.contexts.size()},
          {"heading_free", chain.heading_free},
          {"best_of", chain.segments.breadth},
          {"blend_share", number(chain.blend.share)},
          {"initial", json_of(chain.initial)},
          {"transitions", rows_of(chain.transitions(), chain.modes)}};
}

Json dynamics_of(const SwitchedArxModel& switched) {
  return {{"kind", "switched arx"},
          {"switching", switched.switching == Switching::kMarkov ? "markov" : "regions"},
          {"na", json_of(switched.orders.na)},
          {"nb", json_of(switched.orders.nb)},
          {"nk", json_of(switched.orders.nk)},
          {"history", switched.orders.history()}};
}

// One line for people.
std::string line_of(const Json& dynamics, const Model& model) {
  if (dynamics["kind"] == "chain") {
    return "chain of " + dynamics["segments"].dump() + " segments in " + dynamics["modes"].dump() +
           " modes, histories of up to " + dynamics["history"].dump();
  }
  if (dynamics["kind"] == "switched arx") {
    return "arx of " + std::to_string(std::get<SwitchedArxModel>(model.dynamics).modes.size()) + " modes switched by " +
           (dynamics["switching"] == "markov" ? "a Markov chain" : "regions") + ", history of " +
           dynamics["history"].dump() + " samples";
  }
  return "arx, history of " + dynamics["history"].dump() + " samples, spectral radius " +
         shown(dynamics["radius"].get<double>(), 5);
}

Json made_by(const Training& made) {
  Json options = Json::object(), figures = Json::object();
  for (const Note& note : made.recipe) options[note.name] = note.value;
  for (const Figure& figure : made.figures) figures[figure.name] = number(figure.value);
  return {{"program", made.program}, {"sources", made.sources}, {"options", options}, {"figures", figures}};
}

std::string names_of(const Json& channels) {
  std::string text;
  for (const Json& channel : channels) text += (text.empty() ? "" : ", ") + channel["name"].get<std::string>();
  return text.empty() ? "none" : text;
}

std::string listed(const Json& object) {
  std::string text;
  for (const auto& [name, value] : object.items()) {
    text += (text.empty() ? "" : ", ") + name + " " + (value.is_string() ? value.get<std::string>() : value.dump());
  }
  return text;
}

void describe(const Json& result, const Model& model, Terminal& terminal) {
  terminal.say(result["name"].get<std::string>() + ": " + result["view"]["kind"].get<std::string>() + " model at " +
               shown(result["rate_hz"].get<double>(), 5) + " steps a second, " +
               std::to_string(result["bytes"].get<std::size_t>()) + " bytes");
  terminal.say("inputs    " + names_of(result["inputs"]));
  terminal.say("outputs   " + names_of(result["outputs"]));
  terminal.say("dynamics  " + line_of(result["dynamics"], model));
  terminal.say("cost      " + result["cost"]["multiply_adds_per_frame"].dump() + " multiply-adds a frame, " +
               result["cost"]["operations_per_frame"].dump() + " operations with noise and view");
  terminal.say("made by   " + result["made"]["program"].get<std::string>() + " from " +
               result["made"]["sources"].dump());
  terminal.say("options   " + listed(result["made"]["options"]));
  terminal.say("figures   " + listed(result["made"]["figures"]));
  terminal.say(std::string(result["usable"]["verdict"].get<bool>() ? "usable    " : "NOT usable: ") +
               result["usable"]["reason"].get<std::string>());
}

Result<void> run(const Arguments& arguments, Terminal& terminal) {
  const auto bytes = read_file(arguments.positional());
  if (!bytes) return bytes.error();
  const auto model = parse_model(*bytes, arguments.positional());
  if (!model) return model.error();
  const auto cost = cost_of(*model);
  if (!cost) return cost.error();

  Json& result = terminal.result();
  result["name"] = model->name;
  result["format_version"] = kModelFormatVersion;
  result["bytes"] = bytes->size();
  result["rate_hz"] = model->rate_hz;
  result.update(channels_of(*model));
  result["dynamics"] = std::visit([](const auto& kind) { return dynamics_of(kind); }, model->dynamics);
  result["view"] = view_of(*model);
  result["cost"] = *cost;
  result["made"] = made_by(model->training);
  result["usable"] = json_of(model->training.usable);
  describe(result, *model, terminal);
  terminal.show(dynamics_report(*model, "dynamics."));
  for (const Input& input : model->inputs) {
    if (has_curve(input.shape)) terminal.say("curve     " + input.name + ": " + curve_text(input.curve));
  }
  terminal.show({.sections = {extinction_section(*model)}});
  return {};
}

}  // namespace

Command info_command() {
  return {
      "info",
      "Says what a model file holds, how it was made, and what it costs a frame.",
      {{"MODEL", "the model, a .wisp file"}},
      {},
      {{"wisp info flame.wisp", "The facts of a model"}},
      run,
  };
}

}  // namespace wisp::cli
