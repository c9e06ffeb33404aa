// Stubs for the parts missing from chains.wasm: everything but chains, and a chain's gust response, which needs pairs
// of recordings.

#include "learn/chain/gusts/gust_play.hpp"
#include "learn/flame/learn_outline.hpp"
#include "learns.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/learn/prepare.hpp"
#include "wisp/learn/validate.hpp"

namespace wisp {

using studio::left_out;

// Never called.
Result<Fit> learn_arx(std::span<const Recording>, const ArxRecipe&, const Progress&) { return Error{}; }
Result<Fit> learn_outline(std::span<const Recording>, const OutlineRecipe&, const Progress&) { return Error{}; }
Result<Report> validate_arx(const Model&, const Recording&, const ValidationOptions&, const Progress&) {
  return Error{};
}
Result<ValidatedOutline> validate_outline(const Model&, const Recording&, const ValidationOptions&, const Progress&) {
  return Error{};
}
Result<Recording> prepare(const Recording&, const Preparation&) { return Error{}; }
Result<std::vector<Recording>> prepare_all(std::span<const Recording>, const Preparation&) { return Error{}; }
std::string text_of(const Preparation&) { return {}; }

namespace chain {

Result<GustPairs> gust_pairs(const Recording&, const Recording&) {
  return left_out("pairs of a windy recording and its calm twin");
}
// Never called.
Result<GustFit> learn_gusts(const GustPairs&, std::size_t) { return Error{}; }
Result<GustPlay> play_gusts(const Model&, const GustPairs&, std::size_t, std::uint64_t) { return Error{}; }
ReportSection gusts_section(const GustPlayFigures&) { return {}; }
ReportSection scene_section(const GustScene&, std::size_t) { return {}; }

}  // namespace chain

}  // namespace wisp
