#include "wisp/model/model.hpp"

namespace wisp {

std::size_t regressor_count(const std::vector<Input>& inputs) {
  std::size_t count = 0;
  for (const Input& input : inputs) count += input.shape == InputShape::kSplitSign ? 2 : 1;
  return count;
}

}  // namespace wisp
