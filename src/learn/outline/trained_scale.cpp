#include "learn/outline/trained_scale.hpp"

namespace wisp {

Result<double> trained_scale(const Model& model, const std::string& input) {
  for (std::size_t k = 0; k < model.training.inputs.size(); ++k) {
    if (model.inputs[k].name == input) return model.training.inputs[k].scale;
  }
  return Error{model.name + ": does not say what its input " + input + " was in recordings, expected a model that " +
               "was learned from some; learn it with this program"};
}

}  // namespace wisp
