#include "reports/figures_json.hpp"

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
