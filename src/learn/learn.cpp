#include "wisp/learn/learn.hpp"

#include "learn/arx/learn_arx.hpp"
#include "learn/switched/learn_switched.hpp"

namespace wisp {
namespace {

struct Learner {
  std::span<const Recording> recordings;
  const Progress& progress;

  Result<Fit> operator()(const ArxRecipe& recipe) const { return learn_arx(recordings, recipe, progress); }
  Result<Fit> operator()(const SwitchedRecipe& recipe) const { return learn_switched(recordings, recipe, progress); }
};

}  // namespace

Result<Fit> learn(std::span<const Recording> recordings, const Recipe& recipe, const Progress& progress) {
  return std::visit(Learner{recordings, progress}, recipe);
}

Result<Report> validate(const Model& model, const Recording& recording, const ArxValidation& options,
                        const Progress& progress) {
  if (std::holds_alternative<SwitchedArxModel>(model.dynamics)) {
    return validate_switched(model, recording, options, progress);
  }
  return validate_arx(model, recording, options, progress);
}

}  // namespace wisp
