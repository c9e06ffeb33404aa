#include "reports/figures_json.hpp"

#include "wisp/learn/prediction.hpp"
#include "wisp/run/cost.hpp"

namespace wisp::cli {

Json json_of(const OrderMatrix& orders) {
  Json rows = Json::array();
  for (int i = 0; i < orders.rows(); ++i) {
    Json row = Json::array();
    for (int j = 0; j < orders.columns(); ++j) row.push_back(orders(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json json_of(const Usable& usable) { return {{"verdict", usable.verdict}, {"reason", usable.reason}}; }

Json json_of(std::span<const double> values) {
  Json list = Json::array();
  for (double value : values) list.push_back(number(value));
  return list;
}

Json json_of(const ArxStability& stability) {
  return {{"radius", number(stability.radius)},
          {"changed", stability.changed},
          {"estimated_radius", number(stability.estimated)},
          {"loss_factor", number(stability.loss_factor)},
          {"moved_std_errors", number(stability.moved)}};
}

Coefficients json_of(const ArxOrders& orders, const std::vector<std::vector<double>>& rows) {
  Coefficients out{Json::array(), Json::array()};
  for (int i = 0; i < orders.outputs(); ++i) {
    std::span<const double> rest(rows[i]);
    const auto take = [&rest](int count) {
      const Json lags = json_of(rest.first(count));
      rest = rest.subspan(count);
      return lags;
    };
    Json a = Json::array(), b = Json::array();
    for (int j = 0; j < orders.outputs(); ++j) a.push_back(take(orders.na(i, j)));
    for (int k = 0; k < orders.inputs(); ++k) b.push_back(take(orders.nb(i, k)));
    out.a.push_back(std::move(a));
    out.b.push_back(std::move(b));
  }
  return out;
}

Json by_steps(const std::vector<int>& steps, const std::vector<double>& values) {
  Json out = Json::object();
  for (std::size_t k = 0; k < steps.size() && k < values.size(); ++k) {
    out[steps[k] == kFreeRun ? "inf" : std::to_string(steps[k])] = number(values[k]);
  }
  return out;
}

std::vector<double> mean_per_step(const std::vector<std::vector<double>>& per_step) {
  std::vector<double> means;
  for (const auto& values : per_step) {
    double sum = 0;
    for (double value : values) sum += value;
    means.push_back(values.empty() ? 0 : sum / static_cast<double>(values.size()));
  }
  return means;
}

Result<Json> cost_of(const Model& model) {
  const auto cost = count_operations(model);
  if (!cost) return cost.error();
  return Json{{"multiply_adds_per_frame", cost->multiply_adds_per_frame},
              {"operations_per_frame", cost->operations_per_frame},
              {"worst_operations_per_frame", cost->worst_operations},
              {"steered_operations_per_frame", cost->steered_operations},
              {"operations_between_steps", cost->between_operations}};
}

}  // namespace wisp::cli
