#pragma once
// Outputs that integrate: whose dynamics have a pole at 1, or two.

#include <span>
#include <string>
#include <vector>

#include "learn/arx/fit/arx_fit.hpp"

namespace wisp::arx {

/// Poles at 1, 0 to 2, of every output that remembers no other output; 0 elsewhere. A pole is at 1 where holding it
/// there costs no more of the squared error than the test of Dickey and Fuller allows (5 %), and where the model
/// simulates better with it than the given options do; `plain` is fit_arx() with these.
std::vector<int> find_integrators(std::span<const Recording> recordings, const ChannelChoice& channels,
                                  const ArxOptions& options, const ArxFit& plain);

/// Sets the poles, held as near to 1 as the stored model stays stable in single precision, and a constant beside them.
/// Errors: as fit_arx.
Result<ArxFit> fit_integrators(std::span<const Recording> recordings, const ChannelChoice& channels,
                               const std::vector<int>& integrators, ArxOptions& options);

/// How many poles at 1 one output has from some inputs, with four lags.
int integrators_in(std::span<const Recording> recordings, const std::vector<std::string>& inputs,
                   const std::string& output);

}  // namespace wisp::arx
