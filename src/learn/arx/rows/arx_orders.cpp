#include "learn/arx/rows/arx_orders.hpp"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <numeric>

namespace wisp {
namespace {

bool coupled(const UniformOrders& uniform, int i, int j) {
  const int apart = std::abs(i / uniform.group - j / uniform.group);
  return uniform.coupling == Coupling::kFull || apart <= (uniform.coupling == Coupling::kBand ? 1 : 0);
}

}  // namespace

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

namespace arx {

std::vector<std::vector<int>> coupled_outputs(const OrderMatrix& na) {
  std::vector<int> label(static_cast<std::size_t>(na.rows()));
  std::iota(label.begin(), label.end(), 0);
  for (bool changed = true; changed;) {
    changed = false;
    for (int i = 0; i < na.rows(); ++i) {
      for (int j = 0; j < na.columns(); ++j) {
        if (na(i, j) == 0 || label[i] == label[j]) continue;
        label[i] = label[j] = std::min(label[i], label[j]);
        changed = true;
      }
    }
  }
  std::vector<std::vector<int>> blocks(label.size());
  for (std::size_t i = 0; i < label.size(); ++i) blocks[label[i]].push_back(static_cast<int>(i));
  std::erase_if(blocks, [](const std::vector<int>& block) { return block.empty(); });
  return blocks;
}

}  // namespace arx
}  // namespace wisp
