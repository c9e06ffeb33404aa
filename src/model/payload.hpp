#pragma once
// A model as a FlatBuffer, and back. Shapes are checked here, contents in check().

#include <cstddef>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"
#include "wisp_generated.h"

namespace wisp {

std::vector<std::byte> write_payload(const Model& model);

/// Errors: not a valid FlatBuffer of this schema, or a matrix whose size does not fit its shape.
Result<Model> read_payload(std::span<const std::byte> payload);

/// Writes a chain.
wisp_flatbuffers::Offset<file::Chain> write_chain(wisp_flatbuffers::FlatBufferBuilder& builder,
                                                  const ChainModel& chain);

/// Errors: an enumeration that this program does not know, or probabilities whose number does not fit the histories.
Result<ChainModel> read_chain(const file::Chain& stored);

}  // namespace wisp
