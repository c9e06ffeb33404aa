#pragma once
// The `.wisp` file: one model, checked through and through when it is read.
//
// A 32-byte header (magic, format version, payload size, 64-bit hash of the payload) and a FlatBuffer as
// schema/wisp.fbs defines it.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

inline constexpr int kModelFormatVersion = 1;

/// The bytes of a model's file. The same model gives the same bytes.
/// Errors: the model itself is not valid (check()).
Result<std::vector<std::byte>> model_bytes(const Model& model);

/// Reads a model from the bytes of a file; `name` stands for the file in messages.
/// Errors, each saying what was found and what was expected: too short, not a Wisp model, a format version that this
/// build does not know, a wrong size, a wrong hash, a payload that is not a valid FlatBuffer, and everything that
/// check() finds.
Result<Model> parse_model(std::span<const std::byte> bytes, std::string_view name);

/// The same from and to a file, whole or not at all.
Result<Model> read_model(const std::filesystem::path& path);
Result<void> write_model(const std::filesystem::path& path, const Model& model);

/// Checks a model's meaning: rate, orders and shapes, finite numbers, ascending knots, ranges, and stability after
/// rounding to single precision.
Result<void> check(const Model& model);

}  // namespace wisp
