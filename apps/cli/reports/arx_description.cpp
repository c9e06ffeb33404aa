#include "reports/arx_description.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reports/figures_json.hpp"
#include "wisp/learn/response.hpp"

namespace wisp::cli {
namespace {

// Beyond this eigenvalues take longer than anyone waits for a description.
constexpr int kMostStates = 256;
constexpr int kMostStatesForZeros = 48;

int states_of(const ArxModel& model) {
  int longest = 0;
  for (int order : model.orders.na.values()) longest = std::max(longest, order);
  return longest * model.orders.outputs();
}

Json places(const std::vector<std::complex<double>>& values) {
  Json list = Json::array();
  for (const auto& value : values) list.push_back({number(value.real()), number(value.imag())});
  return list;
}

template <class Value>
Json per_pair(const ArxModel& model, Value value) {
  Json rows = Json::array();
  for (int i = 0; i < model.orders.outputs(); ++i) {
    Json row = Json::array();
    for (int k = 0; k < model.orders.inputs(); ++k) row.push_back(value(i, k));
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string pole_text(std::complex<double> pole, double rate_hz) {
  const double radius = std::abs(pole);
  const std::string place = "|z| " + shown(radius, 4);
  if (radius == 0) return "a pure delay (z = 0)";
  const std::complex<double> s = std::log(pole) * rate_hz;
  if (pole.imag() == 0 && pole.real() > 0) {
    return s.real() < 0 ? place + ": time constant " + shown(-1 / s.real()) + " s" : place + ": does not decay";
  }
  const double natural = std::abs(s);
  return place + ": " + shown(std::abs(s.imag()) / (2 * std::numbers::pi)) + " Hz, damping ratio " +
         shown(-s.real() / natural, 2);
}

}  // namespace

void describe_arx(const ArxModel& model, Json& result) {
  const auto theta = json_of(model.orders, model.theta);
  result["A"] = theta.a;
  result["B"] = theta.b;
  if (!model.std_error.empty()) {
    const auto errors = json_of(model.orders, model.std_error);
    result["std_error"] = {{"A", errors.a}, {"B", errors.b}};
  }
  const int states = states_of(model);
  result["poles"] = states <= kMostStates ? places(poles(model)) : Json(nullptr);
  result["zeros"] = states <= kMostStatesForZeros
                        ? per_pair(model, [&](int i, int k) { return places(zeros(model, i, k)); })
                        : Json(nullptr);
  const std::vector<double> rest{0.0};
  result["static_gain"] =
      per_pair(model, [&](int i, int k) { return number(frequency_response(model, i, k, rest).value.front().real()); });
}

void say_poles(const ArxModel& model, double rate_hz, Terminal& terminal) {
  constexpr int kMostShown = 12;
  if (states_of(model) > kMostShown) return;
  std::vector<std::string> lines;
  for (const auto& pole : poles(model)) {
    if (pole.imag() >= 0) lines.push_back(pole_text(pole, rate_hz));  // of a pair, one
  }
  for (const std::string& line : lines) terminal.say("pole      " + line);
}

}  // namespace wisp::cli
