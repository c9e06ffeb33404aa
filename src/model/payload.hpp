#pragma once
// A model as a FlatBuffer, and back. Shapes are checked here, contents in check().
//
// Rows and rates of a chain's segments are integers, stored as differences from a prediction, in Rice codes. R. F.
// Rice, Some practical universal noiseless coding techniques, JPL 79-22, 1979. Lossless. Motion is smooth, so a row is
// predicted by the cubic through the rows before it (a straight line or a parabola at first), and a rate by the
// parabola through the first or last three rows.

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

/// The numbers of a stored vector; none if it is absent. The verifier bounds a vector but does not align its elements
/// beyond 4 bytes, so they are copied out as bytes.
template <class Number>
std::vector<Number> copied(const wisp_flatbuffers::Vector<Number>* stored) {
  std::vector<Number> out(stored ? stored->size() : 0);
  if (!out.empty()) std::memcpy(out.data(), stored->Data(), out.size() * sizeof(Number));
  return out;
}

std::vector<std::byte> write_payload(const Model& model);

/// Errors: not a valid FlatBuffer of this schema, or a matrix whose size does not fit its shape.
Result<Model> read_payload(std::span<const std::byte> payload);

/// Writes a chain.
wisp_flatbuffers::Offset<file::Chain> write_chain(wisp_flatbuffers::FlatBufferBuilder& builder,
                                                  const ChainModel& chain);

/// Errors: an enumeration that this program does not know, or probabilities whose number does not fit the histories.
Result<ChainModel> read_chain(const file::Chain& stored);

/// Serialises the rows and rates of a chain.
std::vector<std::uint8_t> packed_segments(const ChainModel& chain);

/// Reads them into a chain whose other fields are set.
/// Errors: bytes that are not of this code, too few or too many.
Result<void> unpack_segments(std::span<const std::uint8_t> bytes, ChainModel& chain);

}  // namespace wisp
