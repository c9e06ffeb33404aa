// Stubs for the parts missing from studio.wasm: chains, which the other module learns.

#include "learn/chain/learn_chain.hpp"
#include "learns.hpp"

namespace wisp {

// Never called.
Result<Fit> learn_chain(std::span<const Recording>, const ChainRecipe&, const Progress&) { return Error{}; }
Result<Report> validate_chain(const Model&, std::span<const Recording>, std::uint64_t, const Progress&) {
  return Error{};
}

}  // namespace wisp
