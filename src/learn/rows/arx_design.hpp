#pragma once
// Orders of a model from a few numbers, and the design of its regression: a layout of the lagged channels (columns) of
// all output rows, and for each output row its columns in that layout.

#include <Eigen/Core>
#include <vector>

#include "learn/rows/lag_gram.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

/// Equal orders for all entries of the order matrices that the coupling leaves non-zero.
struct UniformOrders {
  int outputs = 1;
  int inputs = 0;
  int na = 4;  ///< lags of outputs, 0 to 4096; 4 allows two damped resonances per output
  int nb = 4;  ///< lags of inputs, 0 to 4096
  int nk = 1;  ///< delay of inputs in samples, 0 to 4096; 1: an input acts on the next sample
  Coupling coupling = Coupling::kFull;
  int group = 1;  ///< number of consecutive outputs that are always coupled, ≥ 1; 2 where outputs are x, y of points
};

/// na (outputs × outputs), nb and nk (outputs × inputs). Precondition: the fields are in the ranges beside them.
ArxOrders make_orders(const UniformOrders& uniform);

/// Output rows with equal regressors, which share a factorisation.
struct SharedRows {
  std::vector<int> columns;  ///< positions in the layout, in theta's order; the constant, where estimated, comes last
  std::vector<int> outputs;
};

struct ArxDesign {
  LagLayout layout;
  std::vector<SharedRows> groups;
};

/// Regressors of one output row in theta's order; the constant, where it is estimated, comes last.
std::vector<LaggedChannel> row_regressors(const ArxOrders& orders, int output, ArxOffset offset);

/// Sign of a coefficient in the model: −1 for those of A, which are on the left side of the equation.
inline double sign_of(const LaggedChannel& column, int outputs) {
  return column.channel != kConstantChannel && column.channel < outputs ? -1.0 : 1.0;
}

/// Groups output rows by equal regressors, columns of `layout`; with `apart` every output is a group of its own.
std::vector<SharedRows> shared_rows(const ArxOrders& orders, ArxOffset offset, const LagLayout& layout,
                                    bool apart = false);

/// Layout of the lagged channels that a model of these orders uses.
LagLayout layout_of(const ArxOrders& orders);

/// Design of the regression, on a layout of its regressors, its targets and the constant.
ArxDesign make_design(const ArxOrders& orders, ArxOffset offset, bool apart = false);

}  // namespace wisp
