#pragma once
// Recordings from MATLAB files. In a target of its own, wisp::matfile, for what it needs from outside (zlib).

#include <filesystem>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Which variables make a recording. A variable is named as in MATLAB: `u`, a field of a structure as `data.u`, one
/// column of a matrix as `u(:,2)`. A matrix of several columns gives a channel a column: u1, u2, …
struct MatOptions {
  double rate_hz = 0;         ///< samples a second; 0: from a scalar `Ts` (seconds) or `fs` (per second) in the file
  std::size_t max_bytes = 0;  ///< of numbers once unpacked; 0: 64 times the file's, at least 64 MB, at most 1 GB
  std::vector<std::string> inputs;   ///< variables that are inputs
  std::vector<std::string> outputs;  ///< variables that are outputs
};

/// Reads a recording from a MATLAB file of level 5 (`save` up to -v7), compressed or not.
/// Numbers of every class become doubles; NaN is a missing sample; rows and columns of a vector mean the same.
/// Returns inputs, then outputs, as one episode.
/// Errors, each with file and variable: not such a file, a variable that is not there (those that are, are listed), one
/// that is not a real, full, numeric vector or matrix, more than `max_bytes`, infinite numbers, variables of different
/// lengths, no rate.
Result<Recording> read_mat(const std::filesystem::path& path, const MatOptions& options);

/// Names of all numeric variables and fields of structures that read_mat can take, with their sizes: "u (1000 × 2)".
/// Errors: not a MATLAB file of level 5.
Result<std::vector<std::string>> list_mat(const std::filesystem::path& path);

}  // namespace wisp
