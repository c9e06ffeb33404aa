// Models that switch, and lamps' flicker, are learned by the program alone: nobody films them in a page, and they are a
// tenth of the module. Linked before the library, this is what the linker takes.

#include "learn/flicker/learn_flicker.hpp"
#include "learn/switched/learn_switched.hpp"

namespace wisp {
namespace {
Error left_out() { return Error{"models that switch are not learned here; learn them with the program"}; }
}  // namespace

Result<Fit> learn_switched(std::span<const Recording>, const SwitchedRecipe&, const Progress&) { return left_out(); }
Result<Fit> learn_flicker(std::span<const Recording>, const FlickerRecipe&, const Progress&) { return left_out(); }
Result<Report> validate_switched(const Model&, const Recording&, const ValidationOptions&, const Progress&) {
  return left_out();
}
}  // namespace wisp
