#include "reports/coloured_learning.hpp"

#include <string>

#include "reports/figures_json.hpp"
#include "wisp/learn/prediction.hpp"

namespace wisp::cli {
namespace {

void report(const ColouredArxFit& fit, const ChannelChoice& channels, Terminal& terminal) {
  const bool sums = fit.model.noise.colour == NoiseColour::kMovingAverage;
  Json outputs = Json::array();
  for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
    const auto row = static_cast<int>(i);
    const ArxModel& arx = fit.model.model;
    Json a = Json::array(), b = Json::array();
    for (int j = 0; j < arx.orders.outputs(); ++j) a.push_back(json_of(arx.a(row, j)));
    for (int k = 0; k < arx.orders.inputs(); ++k) b.push_back(json_of(arx.b(row, k)));
    outputs.push_back({{"A", std::move(a)},
                       {"B", std::move(b)},
                       {"std_error", json_of(arx.std_error[i])},
                       {sums ? "C" : "D", json_of(fit.model.filter[i])},
                       {"filter_std_error", json_of(fit.model.filter_std_error[i])},
                       {"V", number(fit.loss[i])}});
    std::string filter;
    for (double one : fit.model.filter[i]) filter += " " + shown(one, 4);
    terminal.say(channels.outputs[i] + (sums ? ": C = 1" : ": D = 1") + filter);
  }
  terminal.result()["noise_model"] = {{"form", sums ? "ARMAX" : "ARARX"},
                                      {"outputs", std::move(outputs)},
                                      {"passes", fit.passes},
                                      {"converged", fit.converged}};
}

std::string reason_for(bool stable, bool converged) {
  if (!stable) return "the model is unstable: it cannot be played";
  return converged ? "stable, and the search for the noise model settled"
                   : "the search for the noise model did not settle: record longer or lower its order";
}

}  // namespace

Result<ArxFit> fit_coloured(std::span<const Recording> recordings, const ChannelChoice& channels,
                            const ColouredArxOptions& options, Terminal& terminal) {
  const auto fitted = fit_coloured_arx(recordings, channels, options);
  if (!fitted) return fitted.error();
  report(*fitted, channels, terminal);
  ArxFit out;
  out.model = as_white(fitted->model);
  const auto figures = prediction_figures(out.model, recordings, channels, {.steps = {1, kFreeRun}});
  if (!figures) return figures.error();
  ArxSummary& summary = out.summary;
  const std::size_t ny = channels.outputs.size();
  summary.loss = fitted->loss;
  summary.noise_covariance.assign(ny * ny, 0.0);
  for (std::size_t i = 0; i < ny; ++i) summary.noise_covariance[i * ny + i] = fitted->loss[i];
  summary.fit_percent = figures->front().fit_percent;
  if (!channels.inputs.empty()) summary.free_run_fit_percent = figures->back().fit_percent;
  summary.condition.assign(ny, 1.0);
  summary.samples_used = fitted->samples_used;
  summary.first_sample = options.orders.history();
  summary.method = "prediction errors, " + std::to_string(fitted->passes) + " passes of Gauss and Newton's search";
  summary.stable.radius = summary.stable.estimated = spectral_radius(out.model);
  const bool stable = summary.stable.radius < 1;
  summary.usable = {stable && fitted->converged, reason_for(stable, fitted->converged)};
  return out;
}

}  // namespace wisp::cli
