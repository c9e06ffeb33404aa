#include "learn/rows/arx_design.hpp"

#include <algorithm>
#include <cassert>
#include <cstdlib>

namespace wisp {
namespace {

bool coupled(const UniformOrders& uniform, int i, int j) {
  const int apart = std::abs(i / uniform.group - j / uniform.group);
  return uniform.coupling == Coupling::kFull || apart <= (uniform.coupling == Coupling::kBand ? 1 : 0);
}

}  // namespace

std::vector<LaggedChannel> row_regressors(const ArxOrders& orders, int output, ArxOffset offset) {
  std::vector<LaggedChannel> columns;
  for (int j = 0; j < orders.outputs(); ++j) {
    for (int lag = 1; lag <= orders.na(output, j); ++lag) columns.push_back({j, lag});
  }
  for (int k = 0; k < orders.inputs(); ++k) {
    for (int lag = 0; lag < orders.nb(output, k); ++lag)
      columns.push_back({orders.outputs() + k, orders.nk(output, k) + lag});
  }
  if (offset == ArxOffset::kEstimate) columns.push_back({kConstantChannel, 0});
  return columns;
}

std::vector<SharedRows> shared_rows(const ArxOrders& orders, ArxOffset offset, const LagLayout& layout, bool apart) {
  std::vector<SharedRows> groups;
  for (int i = 0; i < orders.outputs(); ++i) {
    std::vector<int> columns;
    for (const LaggedChannel& column : row_regressors(orders, i, offset)) columns.push_back(layout.find(column));
    const auto same =
        std::find_if(groups.begin(), groups.end(), [&](const SharedRows& group) { return group.columns == columns; });
    if (!apart && same != groups.end()) {
      same->outputs.push_back(i);
    } else {
      groups.push_back({std::move(columns), {i}});
    }
  }
  return groups;
}

ArxDesign make_design(const ArxOrders& orders, ArxOffset offset, bool apart) {
  std::vector<LaggedChannel> used;
  for (int i = 0; i < orders.outputs(); ++i) {
    const auto row = row_regressors(orders, i, offset);
    used.insert(used.end(), row.begin(), row.end());
  }
  LagLayout layout(orders.outputs(), orders.inputs(), used);
  auto groups = shared_rows(orders, offset, layout, apart);
  return {std::move(layout), std::move(groups)};
}

LagLayout layout_of(const ArxOrders& orders) { return make_design(orders, ArxOffset::kMean).layout; }

ArxOrders make_orders(const UniformOrders& uniform) {
  assert(uniform.outputs >= 1 && uniform.inputs >= 0 && uniform.group >= 1);
  ArxOrders orders{OrderMatrix(uniform.outputs, uniform.outputs),
                   OrderMatrix(uniform.outputs, uniform.inputs, uniform.nb),
                   OrderMatrix(uniform.outputs, uniform.inputs, uniform.nk)};
  for (int i = 0; i < uniform.outputs; ++i) {
    for (int j = 0; j < uniform.outputs; ++j) {
      if (coupled(uniform, i, j)) orders.na(i, j) = uniform.na;
    }
  }
  return orders;
}

}  // namespace wisp
