#include "reports/arx_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "reports/clip_figures.hpp"
#include "reports/figures_json.hpp"
#include "wisp/draw/plot.hpp"
#include "wisp/learn/response.hpp"

namespace wisp::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kBreak = std::numeric_limits<double>::quiet_NaN();
constexpr double kSure = 1.959963985;  // standard deviations to either side of 95 %
constexpr std::size_t kMostOutputs = 4;
constexpr double kFar = 1.5;  // a zero farther from 0 would make the unit circle a dot: it is left to the figures

PlotSeries unit_circle() {
  PlotSeries circle{.colour = Colour{150, 150, 150}, .width = 1};
  for (int k = 0; k <= 180; ++k) {
    circle.x.push_back(std::cos(2 * std::numbers::pi * k / 180));
    circle.y.push_back(std::sin(2 * std::numbers::pi * k / 180));
  }
  return circle;
}

// A pole is a cross, by convention, a zero a ring.
PlotSeries crosses(const std::vector<std::complex<double>>& places) {
  constexpr double kArm = 0.04;
  PlotSeries series{.label = "poles ×", .width = 1.6};
  for (const auto& place : places) {
    for (double sign : {1.0, -1.0}) {
      for (double end : {-kArm, kArm}) {
        series.x.push_back(place.real() + end);
        series.y.push_back(place.imag() + sign * end);
      }
      series.x.push_back(kBreak);
      series.y.push_back(kBreak);
    }
  }
  return series;
}

PlotSeries rings(const std::vector<std::complex<double>>& places) {
  PlotSeries series{.label = "zeros", .shape = SeriesShape::kPoints, .marker = Marker::kRing, .marker_size = 8};
  for (const auto& place : places) {
    series.x.push_back(place.real());
    series.y.push_back(place.imag());
  }
  return series;
}

std::string pair_title(const DrawnArx& drawn, std::size_t output, std::size_t input) {
  return drawn.channels.outputs[output] + " from " + drawn.channels.inputs[input];
}

// Zeros of one pair that are near enough to be drawn, and how many are not.
struct NearZeros {
  std::vector<std::complex<double>> near;
  std::size_t far = 0;
};

NearZeros near_zeros(const ArxModel& model, std::size_t output, std::size_t input) {
  NearZeros found{zeros(model, static_cast<int>(output), static_cast<int>(input))};
  found.far = std::erase_if(found.near, [](const auto& zero) { return std::abs(zero) > kFar; });
  return found;
}

Plot pole_plot(const std::string& title, const std::vector<std::complex<double>>& poles, const NearZeros& zeros) {
  Plot plot{.title = title, .x = {.label = "real part"}, .y = {.label = "imaginary part"}, .equal_units = true};
  if (zeros.far > 0) {
    plot.title += " (" + std::to_string(zeros.far) + (zeros.far == 1 ? " zero" : " zeros") + " beyond |z| = 1.5)";
  }
  plot.series = {unit_circle(), crosses(poles)};
  if (!zeros.near.empty()) plot.series.push_back(rings(zeros.near));
  return plot;
}

PlotSheet pole_sheet(const DrawnArx& drawn) {
  const std::size_t outputs = std::min(drawn.channels.outputs.size(), kMostOutputs);
  PlotSheet sheet{.columns = static_cast<int>(std::max<std::size_t>(1, drawn.channels.inputs.size())),
                  .plot_width = 380,
                  .plot_height = 400};
  const auto all_poles = poles(drawn.model);
  if (drawn.channels.inputs.empty()) sheet.plots.push_back(pole_plot("Poles", all_poles, {}));
  double reach = 1.1;  // of all panels, so that they can be compared
  for (std::size_t i = 0; i < outputs; ++i) {
    for (std::size_t k = 0; k < drawn.channels.inputs.size(); ++k) {
      const NearZeros found = near_zeros(drawn.model, i, k);
      for (const auto& zero : found.near) {
        reach = std::max({reach, 1.1 * std::abs(zero.real()), 1.1 * std::abs(zero.imag())});
      }
      sheet.plots.push_back(pole_plot(pair_title(drawn, i, k), all_poles, found));
    }
  }
  for (Plot& plot : sheet.plots) {
    plot.x.lowest = plot.y.lowest = -reach;
    plot.x.highest = plot.y.highest = reach;
  }
  return sheet;
}

// Until what the slowest pole remembers is below a hundredth.
int settling_samples(const ArxModel& model) {
  constexpr int kFewest = 20, kMost = 600;
  const double radius = spectral_radius(model);
  const double settled = radius > 0 && radius < 1 ? std::log(0.01) / std::log(radius) : kMost;
  return model.orders.history() + static_cast<int>(std::clamp(settled, double{kFewest}, double{kMost}));
}

void add_band(const std::vector<double>& low, const std::vector<double>& high, PlotSeries& series) {
  series.low = low;
  series.high = high;
  series.interval = IntervalShape::kBand;
}

PlotSheet step_sheet(const DrawnArx& drawn, std::size_t output) {
  PlotSheet sheet{.columns = static_cast<int>(std::min<std::size_t>(3, drawn.channels.inputs.size())),
                  .plot_width = 520};
  const int samples = settling_samples(drawn.model);
  for (std::size_t k = 0; k < drawn.channels.inputs.size(); ++k) {
    const StepResponse step =
        step_response(drawn.model, static_cast<int>(output), static_cast<int>(k), samples, drawn.covariance);
    Plot plot{.title = "Step response: " + pair_title(drawn, output, k),
              .x = {.label = "seconds"},
              .y = {.label = drawn.channels.outputs[output]}};
    PlotSeries series{.label = step.sd.empty() ? "" : "with its 95 % band", .y = step.value};
    std::vector<double> low, high;
    for (std::size_t t = 0; t < step.value.size(); ++t) {
      series.x.push_back(static_cast<double>(t) / drawn.rate_hz);
      if (step.sd.empty()) continue;
      low.push_back(step.value[t] - kSure * step.sd[t]);
      high.push_back(step.value[t] + kSure * step.sd[t]);
    }
    add_band(low, high, series);
    plot.series.push_back(std::move(series));
    sheet.plots.push_back(std::move(plot));
  }
  return sheet;
}

constexpr int kFrequencies = 240;

// From a thousandth of the highest frequency up to it, evenly on a logarithmic axis.
std::vector<double> angular_frequencies() {
  std::vector<double> omega;
  for (int k = 0; k < kFrequencies; ++k) {
    omega.push_back(std::numbers::pi * std::pow(10.0, 3.0 * (k + 1 - kFrequencies) / (kFrequencies - 1)));
  }
  return omega;
}

// The band of an amplitude is taken in its logarithm, which keeps it above zero.
PlotSeries amplitude_series(const FrequencyResponse& response, const std::vector<double>& hertz) {
  PlotSeries series{.label = response.amplitude_sd.empty() ? "" : "with its 95 % band", .x = hertz};
  std::vector<double> low, high;
  for (std::size_t f = 0; f < hertz.size(); ++f) {
    const double amplitude = std::abs(response.value[f]);
    series.y.push_back(amplitude);
    if (response.amplitude_sd.empty()) continue;
    const double ratio = std::exp(kSure * std::min(response.amplitude_sd[f] / amplitude, 2.0));
    low.push_back(amplitude / ratio);
    high.push_back(amplitude * ratio);
  }
  add_band(low, high, series);
  return series;
}

// Degrees, without jumps of a whole turn. A phase less sure than a half turn has no band to draw.
PlotSeries phase_series(const FrequencyResponse& response, const std::vector<double>& hertz) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  PlotSeries series{.x = hertz};
  std::vector<double> low, high;
  double turns = 0;
  for (std::size_t f = 0; f < hertz.size(); ++f) {
    double degrees = kDegrees * std::arg(response.value[f]) + turns;
    if (f > 0) {
      const double jump = 360 * std::round((series.y.back() - degrees) / 360);
      turns += jump;
      degrees += jump;
    }
    series.y.push_back(degrees);
    if (response.phase_sd.empty()) continue;
    const double wide = std::min(kSure * kDegrees * response.phase_sd[f], 180.0);
    low.push_back(degrees - wide);
    high.push_back(degrees + wide);
  }
  add_band(low, high, series);
  return series;
}

PlotSheet frequency_sheet(const DrawnArx& drawn, std::size_t output) {
  const std::size_t inputs = drawn.channels.inputs.size();
  PlotSheet sheet{.columns = static_cast<int>(inputs), .plot_width = 460, .plot_height = 260};
  const std::vector<double> omega = angular_frequencies();
  std::vector<double> hertz;
  for (double w : omega) hertz.push_back(w * drawn.rate_hz / (2 * std::numbers::pi));
  std::vector<Plot> phases;
  for (std::size_t k = 0; k < inputs; ++k) {
    const FrequencyResponse response =
        frequency_response(drawn.model, static_cast<int>(output), static_cast<int>(k), omega, drawn.covariance);
    Plot amplitude{.title = "Frequency response: " + pair_title(drawn, output, k),
                   .x = {.label = "Hz", .logarithmic = true},
                   .y = {.label = "amplitude", .logarithmic = true}};
    amplitude.series.push_back(amplitude_series(response, hertz));
    sheet.plots.push_back(std::move(amplitude));
    Plot phase{.x = {.label = "Hz", .logarithmic = true}, .y = {.label = "phase, degrees"}};
    phase.series.push_back(phase_series(response, hertz));
    phases.push_back(std::move(phase));
  }
  for (Plot& phase : phases) sheet.plots.push_back(std::move(phase));
  return sheet;
}

Json or_null(const std::vector<double>& values) { return values.empty() ? Json(nullptr) : json_of(values); }

Json step_json(const StepResponse& step) { return {{"value", json_of(step.value)}, {"sd", or_null(step.sd)}}; }

Json frequency_json(const FrequencyResponse& response) {
  Json amplitude = Json::array(), phase = Json::array();
  for (const auto& value : response.value) {
    amplitude.push_back(number(std::abs(value)));
    phase.push_back(number(std::arg(value)));
  }
  return {{"amplitude", std::move(amplitude)},
          {"amplitude_sd", or_null(response.amplitude_sd)},
          {"phase", std::move(phase)},
          {"phase_sd", or_null(response.phase_sd)}};
}

Plot correlation_plot(const std::string& title, const std::vector<double>& values, int first_lag, double bound) {
  Plot plot{.title = title, .x = {.label = "lag, samples", .whole_numbers = true}, .y = {.label = "correlation"}};
  PlotSeries stems{.width = 2}, heads{.shape = SeriesShape::kPoints, .marker = Marker::kDot, .marker_size = 4};
  double most = 2 * bound;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double lag = first_lag + static_cast<double>(k);
    stems.x.insert(stems.x.end(), {lag, lag, kBreak});
    stems.y.insert(stems.y.end(), {0, values[k], kBreak});
    heads.x.push_back(lag);
    heads.y.push_back(values[k]);
    most = std::max(most, std::abs(values[k]));
  }
  heads.colour = stems.colour = Colour{31, 90, 166};
  plot.series = {std::move(stems), std::move(heads)};
  plot.y.lowest = -1.1 * most;
  plot.y.highest = 1.1 * most;
  const double last_lag = first_lag + static_cast<double>(values.size()) - 1;
  const double first = static_cast<double>(first_lag);
  plot.series.push_back({.label = "95 % lie within by chance",
                         .x = {first, last_lag, kBreak, first, last_lag},
                         .y = {bound, bound, kBreak, -bound, -bound},
                         .colour = Colour{190, 40, 40},
                         .dash = Dash::kDashed});
  return plot;
}

std::string p_text(double p) {
  if (p < 0.0001) return "p < 0.0001";
  return "p " + shown(p, 2);
}

}  // namespace

Result<void> write_response_figures(const fs::path& folder, const DrawnArx& drawn) {
  if (auto ok = write_figure(folder, "poles-zeros", pole_sheet(drawn)); !ok) return ok;
  if (drawn.channels.inputs.empty()) return {};
  const std::size_t outputs = std::min(drawn.channels.outputs.size(), kMostOutputs);
  for (std::size_t i = 0; i < outputs; ++i) {
    const std::string of = drawn.channels.outputs.size() == 1 ? "" : "-" + drawn.channels.outputs[i];
    if (auto ok = write_figure(folder, "step" + of, step_sheet(drawn, i)); !ok) return ok;
    if (auto ok = write_figure(folder, "frequency" + of, frequency_sheet(drawn, i)); !ok) return ok;
  }
  return {};
}

Json responses_json(const DrawnArx& drawn) {
  const int samples = settling_samples(drawn.model);
  const std::vector<double> omega = angular_frequencies();
  Json seconds = Json::array(), hertz = Json::array(), steps = Json::array(), frequencies = Json::array();
  for (int t = 0; t < samples; ++t) seconds.push_back(t / drawn.rate_hz);
  for (double w : omega) hertz.push_back(w * drawn.rate_hz / (2 * std::numbers::pi));
  for (int i = 0; i < drawn.model.orders.outputs(); ++i) {
    Json step_row = Json::array(), frequency_row = Json::array();
    for (int k = 0; k < drawn.model.orders.inputs(); ++k) {
      step_row.push_back(step_json(step_response(drawn.model, i, k, samples, drawn.covariance)));
      frequency_row.push_back(frequency_json(frequency_response(drawn.model, i, k, omega, drawn.covariance)));
    }
    steps.push_back(std::move(step_row));
    frequencies.push_back(std::move(frequency_row));
  }
  return {{"seconds", std::move(seconds)},
          {"step", std::move(steps)},
          {"hz", std::move(hertz)},
          {"frequency", std::move(frequencies)}};
}

Result<void> write_residual_figure(const fs::path& folder, const ResidualTests& tests, const ChannelChoice& channels) {
  const std::size_t outputs = std::min(channels.outputs.size(), kMostOutputs);
  PlotSheet sheet{.columns = static_cast<int>(1 + channels.inputs.size()), .plot_width = 420, .plot_height = 260};
  for (std::size_t i = 0; i < outputs; ++i) {
    const Whiteness& white = tests.whiteness[i];
    sheet.plots.push_back(correlation_plot("Residual of " + channels.outputs[i] + ", white? " + p_text(white.p),
                                           white.correlation, 1, white.bound));
    for (std::size_t k = 0; k < channels.inputs.size(); ++k) {
      const Independence& pair = tests.independence[i][k];
      sheet.plots.push_back(correlation_plot("… independent of " + channels.inputs[k] + "? " + p_text(pair.p),
                                             pair.correlation, -static_cast<int>(pair.correlation.size() / 2),
                                             pair.bound));
    }
  }
  return write_figure(folder, "residuals", sheet);
}

}  // namespace wisp::cli
