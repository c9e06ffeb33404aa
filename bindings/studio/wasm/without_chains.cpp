// What studio.wasm leaves out: chains, which the other module learns, and coefficients that are refined for simulation,
// which no recipe of the studio has.

#include "learn/arx/simulation/focus.hpp"
#include "learn/chain/learn_chain.hpp"
#include "learns.hpp"

namespace wisp {

const bool studio::kLearnsChains = false;

// Nothing comes to these.
Result<Fit> learn_chain(std::span<const Recording>, const ChainRecipe&, const Progress&) { return Error{}; }
Result<Report> validate_chain(const Model&, std::span<const Recording>, std::uint64_t, const Progress&) {
  return Error{};
}

namespace arx {

Result<FocusedFit> focus_fit(std::span<const Recording>, const ChannelChoice&, const ArxOptions&, ArxFit plain,
                             const FocusOptions& asked, const Progress&) {
  if (asked.focus == ArxFocus::kPrediction) return FocusedFit{.fit = std::move(plain)};
  return studio::left_out("coefficients that are refined for simulation");
}

}  // namespace arx
}  // namespace wisp
