#pragma once
// Serialised rows and rates of a chain's segments. Rows and rates are integers, stored as differences from
// a prediction, in Rice codes. R. F. Rice, Some practical universal noiseless coding techniques, JPL 79-22, 1979.
// Lossless.
//
// Motion is smooth, so a row is predicted by the cubic through the rows before it (a straight line or a parabola at
// first), and a rate by the parabola through the first or last three rows.

#include <cstdint>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/chain.hpp"

namespace wisp {

/// Serialises the rows and rates of a chain.
std::vector<std::uint8_t> packed_segments(const ChainModel& chain);

/// Reads them into a chain whose other fields are set.
/// Errors: bytes that are not of this code, too few or too many.
Result<void> unpack_segments(std::span<const std::uint8_t> bytes, ChainModel& chain);

}  // namespace wisp
