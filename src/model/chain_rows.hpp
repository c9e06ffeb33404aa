#pragma once
// The rows, rates and successors of a chain's segments as a file has them. Rows and rates are whole numbers, each as
// what it has over a prediction, in Rice codes. R. F. Rice, Some practical universal noiseless coding techniques, JPL
// 79-22, 1979. Nothing is lost.
//
// Motion is smooth, so a row is predicted by the cubic through the rows before it (a straight line or a parabola at
// first), and a rate by the parabola through the first or last three rows.

#include <cstdint>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/chain.hpp"

namespace wisp {

/// The rows and rates of a chain, as bytes.
std::vector<std::uint8_t> packed_segments(const ChainModel& chain);

/// Reads them into a chain of which all else is known.
/// Errors: bytes that are none of this code, too few or too many.
Result<void> unpack_segments(std::span<const std::uint8_t> bytes, ChainModel& chain);

/// The successors of all segments, as bytes: each as which one of its mode it is.
std::vector<std::uint8_t> packed_successors(const ChainModel& chain);

/// Reads them into a chain whose segments have their modes.
/// Errors: too few bytes, or too many; a successor that its mode has not.
Result<void> unpack_successors(std::span<const std::uint8_t> bytes, ChainModel& chain);

}  // namespace wisp
