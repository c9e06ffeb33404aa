#include "learn/arx/report/arx_description.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "learn/arx/judge/response.hpp"
#include "learn/arx/report/report_values.hpp"
#include "record/number_text.hpp"

namespace wisp::arx {
namespace {

// Beyond this eigenvalues take longer than anyone waits for a description.
constexpr int kMaxStates = 256;
constexpr int kMaxStatesForZeros = 48;
constexpr int kMaxStatesTold = 12;
constexpr int kMaxCoefficientsTold = 60;

int states_of(const ArxModel& model) {
  int longest = 0;
  for (int order : model.orders.na.values()) longest = std::max(longest, order);
  return longest * model.orders.outputs();
}

ReportList places(const std::vector<std::complex<double>>& values) {
  ReportList list;
  for (const auto& value : values) list.push_back(ReportList{value.real(), value.imag()});
  return list;
}

std::string pole_text(std::complex<double> pole, double rate_hz) {
  const double radius = std::abs(pole);
  const std::string place = "|z| " + number_text(radius, 4);
  if (radius == 0) return "a pure delay (z = 0)";
  const std::complex<double> s = std::log(pole) * rate_hz;
  if (pole.imag() == 0 && pole.real() > 0) {
    return s.real() < 0 ? place + ": time constant " + number_text(-1 / s.real(), 3) + " s"
                        : place + ": does not decay";
  }
  const double natural = std::abs(s);
  return place + ": " + number_text(std::abs(s.imag()) / (2 * std::numbers::pi), 3) + " Hz, damping ratio " +
         number_text(-s.real() / natural, 2);
}

// One row's coefficients, as the equation has them: y(t-1), u(t-3).
void tell_row(const ArxModel& model, const Model& of, int i, ReportSection& section) {
  std::size_t at = 0;
  const auto tell_one = [&](const char* matrix, const std::string& channel, int lag) {
    const double error = model.std_error.empty() ? 0 : model.std_error[i][at];
    add_line(section, std::string(matrix) + "  " + channel + "(t-" + std::to_string(lag) + ")", model.theta[i][at],
             model.std_error.empty() ? "" : "± " + number_text(error, 3));
    ++at;
  };
  for (int j = 0; j < model.orders.outputs(); ++j) {
    for (int lag = 1; lag <= model.orders.na(i, j); ++lag) tell_one("A", of.outputs[j].name, lag);
  }
  for (int k = 0; k < model.orders.inputs(); ++k) {
    for (int l = 0; l < model.orders.nb(i, k); ++l) tell_one("B", of.inputs[k].name, model.orders.nk(i, k) + l);
  }
}

}  // namespace

void describe(const ArxModel& model, const std::string& prefix, ReportSection& section) {
  CoefficientLists theta = lists_of(model.orders, model.theta);
  add(section, prefix + "A", std::move(theta.a));
  add(section, prefix + "B", std::move(theta.b));
  if (!model.std_error.empty()) {
    CoefficientLists errors = lists_of(model.orders, model.std_error);
    add(section, prefix + "std_error.A", std::move(errors.a));
    add(section, prefix + "std_error.B", std::move(errors.b));
  }
  const int states = states_of(model);
  add(section, prefix + "poles", states <= kMaxStates ? ReportValue(places(poles(model))) : ReportValue());
  add(section, prefix + "zeros",
      states <= kMaxStatesForZeros
          ? ReportValue(per_pair(model.orders, [&](int i, int k) { return places(zeros(model, i, k)); }))
          : ReportValue());
  const std::vector<double> rest{0.0};
  add(section, prefix + "static_gain",
      per_pair(model.orders, [&](int i, int k) { return frequency_response(model, i, k, rest).value.front().real(); }));
}

void tell_poles(const ArxModel& model, double rate_hz, Report& report) {
  if (states_of(model) > kMaxStatesTold) return;
  ReportSection& section = report.add("Poles");
  for (const auto& pole : poles(model)) {
    if (pole.imag() >= 0) add_line(section, "pole", pole_text(pole, rate_hz));  // of a pair, one
  }
}

void tell(const ArxModel& model, const Model& of, Report& report) {
  int count = 0;
  for (int i = 0; i < model.orders.outputs(); ++i) count += model.orders.row_size(i);
  for (int i = 0; count <= kMaxCoefficientsTold && i < model.orders.outputs(); ++i) {
    tell_row(model, of, i, report.add("Coefficients of " + of.outputs[i].name + ", ± standard error"));
  }
  if (count > kMaxCoefficientsTold) {
    add_line(report.add("Coefficients"), "number", count, "too many to show here");
  }
  tell_poles(model, of.rate_hz, report);
}

}  // namespace wisp::arx
