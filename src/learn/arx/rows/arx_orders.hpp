#pragma once
// Which channels are inputs and outputs, and order matrices from a few numbers: which appear in which output's
// equation.

#include <string>
#include <vector>

#include "wisp/learn/arx_recipe.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

/// Channels by name, in the model's order. Roles in the recording do not matter: an output of one system may be another
/// one's input.
struct ChannelChoice {
  std::vector<std::string> inputs;   ///< may be empty: a model without input
  std::vector<std::string> outputs;  ///< at least one
};

/// The same orders in all entries that the coupling leaves.
struct UniformOrders {
  int outputs = 1;
  int inputs = 0;
  int na = 4;  ///< lags of outputs, 0 to 4096; 4 is two damped resonances an output, the paper's choice
  int nb = 4;  ///< lags of inputs, 0 to 4096
  int nk = 1;  ///< delay of inputs in samples, 0 to 4096; 1: an input acts on the next sample
  Coupling coupling = Coupling::kFull;
  int group = 1;  ///< consecutive outputs that belong together, ≥ 1: 2 where outputs are x, y of points
};

/// Returns na (outputs × outputs), nb and nk (outputs × inputs).
///
/// Precondition: the fields are in the ranges beside them.
ArxOrders make_orders(const UniformOrders& uniform);

namespace arx {

/// Outputs whose equations feed each other, as blocks of output indices. Different blocks simulate independently.
std::vector<std::vector<int>> coupled_outputs(const OrderMatrix& na);

}  // namespace arx

}  // namespace wisp
