#pragma once
// Input nonlinearities of a plain ARX model: chosen, fitted and reported.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learn/arx/curve/curve_choice.hpp"
#include "wisp/base/progress.hpp"
#include "wisp/base/report.hpp"

namespace wisp::arx {

/// Curves of all inputs: of so many knots, or, where that is open, as held-out free runs say; then fitted to all rows.
/// Empty where there are none. Errors: as fit_input_curves(), kStopped. Precondition: the recordings have the channels.
Result<std::vector<InputCurve>> learn_curves(std::span<const Recording> recordings, const ChannelChoice& channels,
                                             const ArxOrders& orders, std::optional<int> knots,
                                             const Progress& progress, Report& report);

/// The recordings with each of the named inputs through its curve; as they are where there are none.
std::vector<Recording> with_curves(std::span<const Recording> recordings, const std::vector<std::string>& inputs,
                                   std::span<const InputCurve> curves);

}  // namespace wisp::arx
