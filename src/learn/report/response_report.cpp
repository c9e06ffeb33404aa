#include "learn/report/fit_report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "learn/judge/response.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/report/report_values.hpp"

namespace wisp::arx {
namespace {

constexpr int kFrequencies = 240;

// Length of a response in samples: the longest lag, plus 20 to 600 in which the slowest pole decays to 1 %.
int settling_samples(const ArxModel& model) {
  constexpr int kMin = 20, kMax = 600;
  const double radius = spectral_radius(model);
  // Without feedback the response ends with the longest lag.
  const double settled = radius <= 0 ? 0 : radius < 1 ? std::log(0.01) / std::log(radius) : kMax;
  return model.orders.history() + static_cast<int>(std::clamp(settled, double{kMin}, double{kMax}));
}

// Angular frequencies from π/1000 to π (half the sampling rate), equally spaced on a logarithmic axis.
std::vector<double> angular_frequencies() {
  std::vector<double> omega;
  for (int k = 0; k < kFrequencies; ++k) {
    omega.push_back(std::numbers::pi * std::pow(10.0, 3.0 * (k + 1 - kFrequencies) / (kFrequencies - 1)));
  }
  return omega;
}

// A curve and its confidence band, of width 0 without standard deviations.
struct Curve {
  std::vector<double> y, low, high;

  void push(double value, double below, double above) {
    y.push_back(value);
    low.push_back(below);
    high.push_back(above);
  }
};

Curve step_curve(const StepResponse& step) {
  Curve curve;
  for (std::size_t t = 0; t < step.value.size(); ++t) {
    const double wide = step.sd.empty() ? 0 : kNormal95 * step.sd[t];
    curve.push(step.value[t], step.value[t] - wide, step.value[t] + wide);
  }
  return curve;
}

// The band of an amplitude is computed in its logarithm, so it stays positive.
Curve amplitude_curve(const FrequencyResponse& response) {
  Curve curve;
  for (std::size_t f = 0; f < response.value.size(); ++f) {
    const double amplitude = std::abs(response.value[f]);
    const double sd = response.amplitude_sd.empty() ? 0 : response.amplitude_sd[f];
    const double ratio = amplitude > 0 ? std::exp(kNormal95 * std::min(sd / amplitude, 2.0)) : 1;
    curve.push(amplitude, amplitude / ratio, amplitude * ratio);
  }
  return curve;
}

// Unwrapped phase in degrees. Its band is limited to half a turn on either side.
Curve phase_curve(const FrequencyResponse& response) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  Curve curve;
  double turns = 0;
  for (std::size_t f = 0; f < response.value.size(); ++f) {
    double degrees = kDegrees * std::arg(response.value[f]) + turns;
    if (f > 0) {
      const double jump = 360 * std::round((curve.y.back() - degrees) / 360);
      turns += jump;
      degrees += jump;
    }
    const double sd = response.phase_sd.empty() ? 0 : response.phase_sd[f];
    const double wide = std::min(kNormal95 * kDegrees * sd, 180.0);
    curve.push(degrees, degrees - wide, degrees + wide);
  }
  return curve;
}

using Places = std::vector<std::complex<double>>;

// Returns poles and zeros without pairs that cancel, such as poles of outputs that do not act on this output.
std::pair<Places, Places> without_cancelling(Places poles, const Places& zeros) {
  constexpr double kSame = 1e-6;
  Places left;
  for (const auto& zero : zeros) {
    const auto same =
        std::find_if(poles.begin(), poles.end(), [&](const auto& pole) { return std::abs(pole - zero) < kSame; });
    same == poles.end() ? left.push_back(zero) : void(poles.erase(same));
  }
  return {std::move(poles), std::move(left)};
}

void add_places(const std::string& id, const std::string& label, const Places& places, ReportSection& section) {
  ReportSeries& series = section.series.emplace_back(ReportSeries{id, label, "real part", "imaginary part", {}, {}});
  for (const auto& place : places) series.x.push_back(place.real()), series.y.push_back(place.imag());
}

// Adds the series of one input's effect on one output and, if `listed`, the lists of `responses`.
void add_pair(const Responding& of, int output, int input, bool listed, ReportSection& section) {
  const std::vector<double> omega = angular_frequencies();
  const StepResponse step = step_response(of.model, output, input, settling_samples(of.model), of.covariance);
  const FrequencyResponse frequency = frequency_response(of.model, output, input, omega, of.covariance);
  std::vector<double> seconds, hertz, amplitude, phase;
  for (std::size_t t = 0; t < step.value.size(); ++t) seconds.push_back(static_cast<double>(t) / of.rate_hz);
  for (double w : omega) hertz.push_back(w * of.rate_hz / (2 * std::numbers::pi));
  for (const auto& value : frequency.value) amplitude.push_back(std::abs(value)), phase.push_back(std::arg(value));
  if (listed) {
    const std::string index = "[" + std::to_string(output) + "][" + std::to_string(input) + "].";
    if (output == 0 && input == 0) add_all(section, "responses.", "seconds", seconds, "hz", hertz);
    add_all(section, "responses.step" + index, "value", step.value, "sd", list_or_none(step.sd));
    add_all(section, "responses.frequency" + index, "amplitude", amplitude, "amplitude_sd",
            list_or_none(frequency.amplitude_sd), "phase", phase, "phase_sd", list_or_none(frequency.phase_sd));
  }
  const std::string label = of.channels.outputs[output] + " from " + of.channels.inputs[input];
  const std::string place = "." + std::to_string(output) + "." + std::to_string(input);
  const auto [left_poles, left_zeros] = without_cancelling(poles(of.model), zeros(of.model, output, input));
  add_places("poles" + place, label, left_poles, section);
  add_places("zeros" + place, label, left_zeros, section);
  const auto plot = [&](const std::string& what, const std::string& x_label, const std::string& y_label,
                        const std::vector<double>& x, const Curve& curve) {
    section.series.push_back({what + place, label, x_label, y_label, x, curve.y});
    if (of.covariance.empty()) return;
    section.series.push_back({what + place + ".low", label, x_label, y_label, x, curve.low});
    section.series.push_back({what + place + ".high", label, x_label, y_label, x, curve.high});
  };
  plot("step", "time, s", of.channels.outputs[output], seconds, step_curve(step));
  plot("amplitude", "frequency, Hz", "amplitude", hertz, amplitude_curve(frequency));
  plot("phase", "frequency, Hz", "phase, degrees", hertz, phase_curve(frequency));
}

}  // namespace

void add_poles(const ArxModel& model, Report& report) { add_places("poles", "poles", poles(model), report.add("")); }

void add_responses(const Responding& responding, bool listed, Report& report) {
  add_poles(responding.model, report);
  ReportSection& section = report.sections.back();
  const ArxOrders& orders = responding.model.orders;
  for (int i = 0; i < orders.outputs(); ++i) {
    for (int k = 0; k < orders.inputs(); ++k) add_pair(responding, i, k, listed, section);
  }
}

}  // namespace wisp::arx
