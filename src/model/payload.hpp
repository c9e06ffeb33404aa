#pragma once
// A model as a FlatBuffer, and back. Shapes are checked here, meaning in check().

#include <cstddef>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

std::vector<std::byte> write_payload(const Model& model);

/// Errors: not a valid FlatBuffer of this schema, or a matrix whose size does not fit its shape.
Result<Model> read_payload(std::span<const std::byte> payload);

}  // namespace wisp
