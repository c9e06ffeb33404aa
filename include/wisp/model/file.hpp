#pragma once
// The `.wisp` file: one model, fully checked when it is read.
//
// A 32-byte header (magic, format version, payload size, 64-bit hash of the payload) and a FlatBuffer defined by
// schema/wisp.fbs.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

inline constexpr int kModelFormatVersion = 1;

/// Returns the bytes of a model's file. Equal models give equal bytes. Errors: the model itself is not valid (check()).
Result<std::vector<std::byte>> model_bytes(const Model& model);

/// Reads a model from the bytes of a file; `name` stands for the file in messages.
/// Errors, each saying what was found and what was expected: too short, not a Wisp model, a format version unknown to
/// this build, a wrong size, a wrong hash, a payload that is not a valid FlatBuffer, and those of check().
Result<Model> parse_model(std::span<const std::byte> bytes, std::string_view name);

/// Read and write a model's file, completely or not at all.
Result<Model> read_model(const std::filesystem::path& path);
Result<void> write_model(const std::filesystem::path& path, const Model& model);

/// Checks a model's content: rate, orders and shapes, finite numbers, ascending knots, ranges, and stability after
/// rounding to single precision.
Result<void> check(const Model& model);

}  // namespace wisp
