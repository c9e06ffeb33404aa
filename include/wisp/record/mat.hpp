#pragma once
// Recordings from MATLAB files. In a separate target, wisp::matfile, because it needs zlib.

#include <filesystem>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Selection of the variables that make a recording. A variable is named as in MATLAB: `u`, a field of a structure as
/// `data.u`, one column of a matrix as `u(:,2)`. A matrix of several columns yields one channel per column: u1, u2, …;
/// unless a variable has that name, `u2` selects column 2 of `u`.
struct MatOptions {
  double rate_hz = 0;         ///< samples per second; 0: by a scalar `fs` or `Ts` (seconds), or a vector `t` or `time`
  std::size_t max_bytes = 0;  ///< maximum of unpacked bytes; 0: 64 times the file's size, within 64 MB and 1 GB
  std::vector<std::string> inputs;   ///< variables that are inputs
  std::vector<std::string> outputs;  ///< variables that are outputs
};

/// Reads a recording from a MATLAB file of level 5 (`save` up to -v7), compressed or not. Numbers of every class become
/// doubles; NaN is a missing sample; row and column vectors are equivalent. Returns inputs, then outputs, as one
/// episode. Errors, each with file and variable: not such a file, a missing variable (the existing ones are listed),
/// one that is not a real, full, numeric vector or matrix, more than `max_bytes`, infinite numbers, variables of
/// different lengths, no rate, uneven time, no variable named.
Result<Recording> read_mat(const std::filesystem::path& path, const MatOptions& options);

/// Returns names and sizes of the numeric variables and structure fields, about ten thousand at most: "u (1000 × 2)".
/// Errors: not a MATLAB file of level 5.
Result<std::vector<std::string>> list_mat(const std::filesystem::path& path);

}  // namespace wisp
