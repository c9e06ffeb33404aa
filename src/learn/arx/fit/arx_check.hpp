#pragma once
// What is wrong with a request for a fit, before anything is computed.

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/arx/rows/arx_design.hpp"
#include "learn/arx/rows/arx_rows.hpp"
#include "wisp/base/result.hpp"

namespace wisp {

/// Shapes and ranges of order matrices, against the channels named.
Result<void> check_orders(const ArxOrders& orders, const ChannelChoice& channels);

/// Shapes and ranges of the options, against the channels named.
Result<void> check_options(const ArxOptions& options, const ChannelChoice& channels);

/// Whether there are rows enough for the coefficients of every output.
Result<void> check_rows(const RowPlan& plan, const ArxDesign& design);

}  // namespace wisp
