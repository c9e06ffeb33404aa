#include "reports/curve_learning.hpp"

#include "reports/figures_json.hpp"

namespace wisp::cli {
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

}  // namespace wisp::cli
