#pragma once
// `wisp learn arx --search`: the grid, the criterion, and the table of candidates.

#include <optional>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/learn/channel_choice.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// --search, --by, --validate, --steps.
std::vector<Flag> search_flags();

/// Orders, and the first row that is predicted where it is not the orders' own.
struct ChosenOrders {
  ArxOrders orders;
  std::optional<int> first_sample{};
};

/// Searches the grid of --search, reports its candidates, and returns the best one's orders; with --common-start also
/// the start that all candidates had, so that the best one is fitted as it was judged. `whole` are the recordings
/// before --range was taken, from which --validate takes its rows.
/// Errors: a grid that cannot be understood, validation asked for without --validate, and those of search_orders().
Result<ChosenOrders> search_arx_orders(const std::vector<Recording>& estimation, const std::vector<Recording>& whole,
                                       const ChannelChoice& channels, const Arguments& arguments, Terminal& terminal);

}  // namespace wisp::cli
