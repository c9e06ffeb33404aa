#pragma once
// Detection and fitting of integrating outputs, those with one or two poles at 1.

#include <span>
#include <string>
#include <vector>

#include "learn/fit/arx_fit.hpp"

namespace wisp::arx {

/// Returns the number of poles at 1, 0 to 2, of every output without lags of other outputs; 0 for the others. A pole
/// counts where fixing it at 1 raises the squared error by no more than the Dickey–Fuller test allows (5 %), and where
/// the model then simulates better than `plain`, the result of fit_arx() with the given options.
std::vector<int> find_integrators(std::span<const Recording> recordings, const ChannelChoice& channels,
                                  const ArxOptions& options, const ArxFit& plain);

/// Fits with poles fixed as near to 1 as single precision keeps the model stable, and with an estimated constant.
/// Errors: as fit_arx.
Result<ArxFit> fit_integrators(std::span<const Recording> recordings, const ChannelChoice& channels,
                               const std::vector<int>& integrators, ArxOptions& options);

/// Number of poles at 1 of one output, given some inputs and four lags.
int integrators_in(std::span<const Recording> recordings, const std::vector<std::string>& inputs,
                   const std::string& output);

}  // namespace wisp::arx
