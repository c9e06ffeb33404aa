#include "reports/curve_learning.hpp"

#include <algorithm>
#include <cmath>

#include "reports/figures_json.hpp"

namespace wisp::cli {
namespace {

constexpr double kHeldOut = 0.3;  // of every recording, to choose by

CurvedInput curved_input(const std::string& name, std::span<const Recording> recordings) {
  CurvedInput input{{name}};
  bool first = true;
  for (const Recording& recording : recordings) {
    for (double u : recording.channels[*find_channel(recording, name)].samples) {
      if (std::isnan(u)) continue;
      input.lowest = first ? u : std::min(input.lowest, u);
      input.highest = first ? u : std::max(input.highest, u);
      first = false;
    }
  }
  return input;
}

Result<CurveChoice> choice_of(std::span<const Recording> recordings, const ChannelChoice& channels,
                              const CurveFitOptions& options, std::optional<int> knots) {
  std::vector<Recording> learned, held_out;
  for (const Recording& one : recordings) {
    const auto cut = static_cast<std::size_t>(std::lround((1 - kHeldOut) * static_cast<double>(one.rows())));
    learned.push_back(slice(one, 0, cut));
    held_out.push_back(slice(one, cut, one.rows()));
  }
  return choose_input_curves(learned, held_out, channels, options, knots);
}

}  // namespace

Flag curve_flag(const std::string& unless_said, const std::string& help) {
  return {
      "input-curve",
      Kind::kIntegerOrWord,
      "N|auto",
      unless_said,
      "a monotone curve of N knots, 3 to 16, that bends every input before the linear model sees it; 0: none; auto: "
      "3 to 6 knots or none, as held-out rows say" +
          help,
      {"auto"}};
}

std::optional<int> curve_knots_of(const Arguments& arguments) {
  if (arguments.text("input-curve") == "auto") return std::nullopt;
  return arguments.integer("input-curve");
}

Json curve_json(const CurveChoice& choice, const std::vector<std::string>& inputs,
                std::span<const CurveEstimate> curves) {
  Json json = {{"knots", choice.knots}, {"reason", choice.reason}, {"candidates", Json::array()}};
  for (const CurveCandidate& one : choice.candidates) {
    json["candidates"].push_back(
        {{"knots", one.knots}, {"held_out_gain_nats", number(one.gain)}, {"gain_se", number(one.gain_error)}});
  }
  json["curves"] = Json::array();
  for (std::size_t k = 0; k < curves.size(); ++k) {
    json["curves"].push_back({{"input", inputs[k]},
                              {"at", json_of(curves[k].curve.at)},
                              {"value", json_of(curves[k].curve.value)},
                              {"std_error", json_of(curves[k].std_error)}});
  }
  return json;
}

std::string curve_text(const InputCurve& curve) {
  std::string text;
  for (std::size_t k = 0; k < curve.at.size(); ++k) {
    text += (k > 0 ? ", " : "") + shown(curve.at[k]) + " → " + shown(curve.value[k]);
  }
  return text;
}

Result<std::vector<InputCurve>> learn_arx_curves(std::span<const Recording> recordings, const ChannelChoice& channels,
                                                 const ArxOrders& orders, const Arguments& arguments,
                                                 Terminal& terminal) {
  const auto knots = curve_knots_of(arguments);
  std::vector<InputCurve> curves;
  if (knots == 0 || channels.inputs.empty()) return curves;
  if (arguments.text("offset") == "none") {
    return Error{"--input-curve needs --offset mean or estimate: a curve has no level of its own"};
  }
  for (const Recording& recording : recordings) {
    for (const std::string& name : channels.inputs) {
      if (!find_channel(recording, name)) return Error{recording.source + ": there is no channel " + name};
    }
  }
  CurveFitOptions options{.orders = orders};
  for (const std::string& name : channels.inputs) options.inputs.push_back(curved_input(name, recordings));
  const auto choice = choice_of(recordings, channels, options, knots);
  if (!choice) return choice.error();
  std::vector<CurveEstimate> estimates;
  if (choice->knots > 0) {
    options.knots = choice->knots;
    auto fit = fit_input_curves(recordings, channels, options);
    if (!fit) return fit.error();
    estimates = std::move(fit->curves);
  }
  terminal.result()["input_curve"] = curve_json(*choice, channels.inputs, estimates);
  terminal.say(choice->reason);
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    terminal.say("curve of " + channels.inputs[k] + ": " + curve_text(estimates[k].curve));
    curves.push_back(std::move(estimates[k].curve));
  }
  return curves;
}

std::vector<Recording> bent_recordings(std::span<const Recording> recordings, const std::vector<std::string>& inputs,
                                       std::span<const InputCurve> curves) {
  std::vector<Recording> out(recordings.begin(), recordings.end());
  for (Recording& recording : out) {
    for (std::size_t k = 0; k < curves.size(); ++k) {
      for (double& u : recording.channels[*find_channel(recording, inputs[k])].samples) u = value_at(curves[k], u);
    }
  }
  return out;
}

}  // namespace wisp::cli
