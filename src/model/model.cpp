#include "wisp/model/model.hpp"

namespace wisp {

std::size_t regressor_count(const std::vector<Input>& inputs) {
  std::size_t count = 0;
  for (const Input& input : inputs) count += static_cast<std::size_t>(regressor_count(input.shape));
  return count;
}

int regressor_count(InputShape shape) { return (splits_sign(shape) ? 2 : 1) * (has_powers(shape) ? 3 : 1); }

bool splits_sign(InputShape shape) { return shape == InputShape::kSplitSign || has_powers(shape); }

bool has_powers(InputShape shape) { return shape == InputShape::kSplitSignPowers; }

}  // namespace wisp
