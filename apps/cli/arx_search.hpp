#pragma once
// `wisp learn arx --search`: the grid, the criterion, and the table of candidates.

#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/learn/channel_choice.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// --search, --by, --validate, --steps.
std::vector<Flag> search_flags();

/// Searches the grid of --search, reports its candidates, and returns the best one's orders. `whole` are the recordings
/// before --range was taken, from which --validate takes its rows.
/// Errors: a grid that cannot be understood, validation asked for without --validate, and those of search_orders().
Result<ArxOrders> search_arx_orders(const std::vector<Recording>& estimation, const std::vector<Recording>& whole,
                                    const ChannelChoice& channels, const Arguments& arguments, Terminal& terminal);

}  // namespace wisp::cli
