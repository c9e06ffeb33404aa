// What is learned by the program alone, for nobody films it in a page: models that switch, lamps' flicker, a fall's
// answer to gusts, which wants pairs of recordings, modes that are systems, and coefficients that are refined for
// simulation, which no recipe of the studio asks for. Linked before the library, this is what the linker takes; it is
// an eighth of the module.

#include "learn/arx/simulation/focus.hpp"
#include "learn/chain/gusts/gust_report.hpp"
#include "learn/chain/modes/mode_systems.hpp"
#include "learn/flicker/learn_flicker.hpp"
#include "learn/switched/learn_switched.hpp"

namespace wisp {
namespace {
Error left_out(const char* what) { return Error{std::string(what) + " are not learned here; use the program"}; }
}  // namespace

Result<Fit> learn_switched(std::span<const Recording>, const SwitchedRecipe&, const Progress&) {
  return left_out("models that switch");
}
Result<Fit> learn_flicker(std::span<const Recording>, const FlickerRecipe&, const Progress&) {
  return left_out("lamps");
}
Result<Report> validate_switched(const Model&, const Recording&, const ValidationOptions&, const Progress&) {
  return left_out("models that switch");
}

namespace arx {

Result<FocusedFit> focus_fit(std::span<const Recording>, const ChannelChoice&, const ArxOptions&, ArxFit plain,
                             ArxFocus focus, const Progress&) {
  if (focus == ArxFocus::kPrediction) return FocusedFit{.fit = std::move(plain)};
  return left_out("coefficients that are refined for simulation");
}

}  // namespace arx

namespace chain {

Result<GustFit> learn_gusts(const Recording&, const Recording&, const GustOptions&) {
  return left_out("pairs of a windy recording and its calm twin");
}
Result<GustPlay> play_gusts(const Model&, const Recording&, const Recording&, const GustPlayOptions&) {
  return left_out("pairs of a windy recording and its calm twin");
}
// Nothing comes to these: what they report of fails.
ReportSection gusts_section(const GustFigures&) { return {}; }
ReportSection gusts_section(const GustPlayFigures&) { return {}; }
ReportSection scene_section(const GustScene&, std::size_t) { return {}; }

Result<ModeSystems> fit_mode_systems(const Motion&, std::span<const Segment>, std::span<const std::uint16_t>, int,
                                     const ModeSystemOptions&) {
  return left_out("modes that are systems");
}

}  // namespace chain
}  // namespace wisp
