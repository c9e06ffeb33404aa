#pragma once
// Lossless serialisation of the rows and rates of a chain's segments: differences of integers from a prediction, in
// Rice codes (R. F. Rice, Some practical universal noiseless coding techniques, JPL 79-22, 1979).
//
// Motion is smooth, so a row is predicted by the parabola through the three rows before it (with fewer rows: by a line,
// a constant, or 0), and a rate by the parabola through the first or last three rows.

#include <cstdint>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/chain.hpp"

namespace wisp {

/// Serialises the rows and rates of a chain.
std::vector<std::uint8_t> packed_segments(const ChainModel& chain);

/// Reads rows and rates into a chain whose motion and segments' modes and steps are set.
/// Errors: too few or too many bytes, or numbers outside 16 bits.
Result<void> unpack_segments(std::span<const std::uint8_t> bytes, ChainModel& chain);

}  // namespace wisp
