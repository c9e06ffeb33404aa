#include "reports/switched_description.hpp"

#include "reports/figures_json.hpp"

namespace wisp::cli {
namespace {

Json matrix_of(std::span<const double> values, std::size_t rows) {
  Json all = Json::array();
  const std::size_t columns = rows > 0 ? values.size() / rows : 0;
  for (std::size_t r = 0; r < rows; ++r) all.push_back(json_of(values.subspan(r * columns, columns)));
  return all;
}

Json mode_json(const SwitchedArxModel& model, std::size_t k) {
  const ArxMode& mode = model.modes[k];
  const auto theta = json_of(model.orders, mode.theta);
  Json out = {{"A", theta.a},
              {"B", theta.b},
              {"constant", json_of(mode.constant)},
              {"shock", matrix_of(mode.shock, mode.constant.size())},
              {"radius", number(spectral_radius(mode_model(model, k)))}};
  if (!mode.std_error.empty()) {
    const auto errors = json_of(model.orders, mode.std_error);
    out["std_error"] = {{"A", errors.a}, {"B", errors.b}};
  }
  return out;
}

std::string name_of(const RegionSample& sample) {
  return (sample.input ? "u" : "y") + std::to_string(sample.channel) + "(t-" + std::to_string(sample.lag) + ")";
}

}  // namespace

void describe_switched(const SwitchedArxModel& model, Json& result) {
  result["modes"] = Json::array();
  for (std::size_t k = 0; k < model.modes.size(); ++k) result["modes"].push_back(mode_json(model, k));
  if (model.switching == Switching::kRegions) {
    Json columns = Json::array({"1"});
    for (const RegionSample& sample : region_samples(model.orders)) columns.push_back(name_of(sample));
    result["region_columns"] = std::move(columns);
    result["regions"] = matrix_of(model.regions, model.modes.size());
  } else {
    result["initial"] = json_of(model.initial);
    result["transitions"] = matrix_of(model.transitions, model.modes.size());
  }
  const bool found = !model.lyapunov.empty();
  result["lyapunov"] = found;
  result["bounded_by"] = found ? "a common Lyapunov function: no order of the modes makes it diverge"
                               : "the range that outputs are held to: no common Lyapunov function was found";
}

}  // namespace wisp::cli
