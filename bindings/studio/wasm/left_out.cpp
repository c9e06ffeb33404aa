// Stubs for models learned only by the program, as pages do not film them: switched models and flicker of lamps. The
// linker takes them before the library. Together with the parts left to the other module, that saves a quarter of the
// code.

#include "learn/flicker/learn_flicker.hpp"
#include "learn/markov/learn_markov.hpp"
#include "learns.hpp"

namespace wisp {

using studio::left_out;

Result<Fit> learn_switched(std::span<const Recording>, const SwitchedRecipe&, const Progress&) {
  return left_out("models that switch");
}
Result<Fit> learn_flicker(std::span<const Recording>, const FlickerRecipe&, const Progress&) {
  return left_out("lamps");
}
Result<Report> validate_switched(const Model&, const Recording&, const ValidationOptions&, const Progress&) {
  return left_out("models that switch");
}

// Never called; the linker needs a definition.
void markov::describe(const SwitchedArxModel&, const std::string&, ReportSection&) {}

}  // namespace wisp
