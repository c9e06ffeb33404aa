#pragma once
// Conversion of a model to a FlatBuffer, and back. Reading checks sizes of matrices; check() checks the rest.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/chain.hpp"
#include "wisp/model/model.hpp"
#include "wisp_generated.h"

namespace wisp {

/// Returns the numbers of a stored vector; none if it is absent. They are copied as bytes, since a verified vector may
/// still have elements that are only aligned to 4 bytes.
template <class Number>
std::vector<Number> copied(const wisp_flatbuffers::Vector<Number>* stored) {
  std::vector<Number> out(stored ? stored->size() : 0);
  if (!out.empty()) std::memcpy(out.data(), stored->Data(), out.size() * sizeof(Number));
  return out;
}

std::vector<std::byte> write_payload(const Model& model);

/// Reads a model. Errors: not a valid FlatBuffer of this schema, an unknown kind of dynamics, view or input, a matrix
/// whose size does not fit its shape, and those of read_chain().
Result<Model> read_payload(std::span<const std::byte> payload);

wisp_flatbuffers::Offset<file::Chain> write_chain(wisp_flatbuffers::FlatBufferBuilder& builder,
                                                  const ChainModel& chain);

/// Reads a chain. Errors: an unknown kind of motion; too few or many successors, rows or rates; a drift not of 3 axes.
Result<ChainModel> read_chain(const file::Chain& stored);

}  // namespace wisp
