#include "learn/arx/arx_curves.hpp"

#include <algorithm>
#include <cmath>

#include "learn/arx/learn_arx.hpp"
#include "learn/arx/report/fit_report.hpp"

namespace wisp::arx {
namespace {

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

}  // namespace

Result<std::vector<InputCurve>> learn_curves(std::span<const Recording> recordings, const ChannelChoice& channels,
                                             const ArxOrders& orders, std::optional<int> knots,
                                             const Progress& progress, Report& report) {
  std::vector<InputCurve> curves;
  if (knots == 0 || channels.inputs.empty()) return curves;
  if (auto ok = check_progress(progress, "choosing input curves", 0); !ok) return ok.error();
  CurveFitOptions options{.orders = orders};
  for (const std::string& name : channels.inputs) options.inputs.push_back(curved_input(name, recordings));
  const auto choice = choose_input_curves(folds_of(recordings), channels, options, knots);
  if (!choice) return choice.error();
  std::vector<CurveEstimate> estimates;
  if (choice->knots > 0) {
    if (auto ok = check_progress(progress, "fitting input curves", 0); !ok) return ok.error();
    options.knots = choice->knots;
    auto fit = fit_input_curves(recordings, channels, options);
    if (!fit) return fit.error();
    estimates = std::move(fit->curves);
  }
  add_curves(*choice, channels.inputs, estimates, report);
  for (CurveEstimate& one : estimates) curves.push_back(std::move(one.curve));
  return curves;
}

std::vector<Recording> with_curves(std::span<const Recording> recordings, const std::vector<std::string>& inputs,
                                   std::span<const InputCurve> curves) {
  std::vector<Recording> out(recordings.begin(), recordings.end());
  for (Recording& recording : out) {
    for (std::size_t k = 0; k < curves.size(); ++k) {
      for (double& u : recording.channels[*find_channel(recording, inputs[k])].samples) u = value_at(curves[k], u);
    }
  }
  return out;
}

}  // namespace wisp::arx
