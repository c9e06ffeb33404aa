#include "learn/arx/rows/arx_orders.hpp"

#include <cassert>
#include <cstdlib>

namespace wisp {
namespace {

bool coupled(const UniformOrders& uniform, int i, int j) {
  const int apart = std::abs(i / uniform.group - j / uniform.group);
  switch (uniform.coupling) {
    case Coupling::kFull:
      return true;
    case Coupling::kDiagonal:
      return apart == 0;
    case Coupling::kBand:
      return apart <= uniform.reach;
  }
  return false;
}

}  // namespace

ArxOrders make_orders(const UniformOrders& uniform) {
  assert(uniform.outputs >= 1 && uniform.inputs >= 0 && uniform.group >= 1 && uniform.reach >= 0);
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
