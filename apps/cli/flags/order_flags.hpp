#pragma once
// --na, --nb, --nk and --coupling as order matrices.

#include "command.hpp"
#include "wisp/model/arx.hpp"

namespace wisp::cli {

/// What their help says besides.
struct OrderHelp {
  const char* fallback;    ///< of --na and --nb
  const char* of_a = "";   ///< what A belongs to
  const char* delay = "";  ///< what --nk may be besides
};

/// The flags.
std::vector<Flag> order_flags(const OrderHelp& help);

/// Errors: a matrix that cannot be understood or has not the shape of the channels, with what was found and expected.
Result<ArxOrders> orders_from(const Arguments& arguments, int outputs, int inputs);

/// Parses '4,2;3,4' (rows by semicolons) of the given shape, or one number for all entries; `flag` is for messages.
Result<OrderMatrix> parse_orders(const std::string& text, int rows, int columns, const std::string& flag);

}  // namespace wisp::cli
