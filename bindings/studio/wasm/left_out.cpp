// What is learned by the program alone, for nobody films it in a page: models that switch, and lamps' flicker. Linked
// before the library, this is what the linker takes; with what each of the two modules leaves to the other it is a
// quarter of the code.

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

// Nothing comes to this.
void markov::describe(const SwitchedArxModel&, const std::string&, ReportSection&) {}

}  // namespace wisp
