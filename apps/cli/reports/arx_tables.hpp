#pragma once
// Tables taken into a fit a stretch at a time, at bounded memory.

#include <cstdint>
#include <string>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/learn/triangular_factor.hpp"

namespace wisp::cli {

/// Which share of every table's rows: part `index` (0-based) of `count`.
struct TableShare {
  std::size_t index = 0;
  std::size_t count = 1;
};

/// Takes the named recordings, or the share of each, into an empty factor. --range chooses their rows; CSV files are
/// read a stretch at a time, MATLAB files whole; a bad one is the error, or left out with --skip-bad.
Result<TriangularFactor> factor_of_tables(const Arguments& arguments, const TableShare& share, Terminal& terminal);

/// Bytes of all recordings together, as they are on disk; those that are not there count nothing.
std::uintmax_t bytes_on_disk(const std::vector<std::string>& paths);

struct StreamedFit {
  ArxFit fit;
  TriangularFactor factor;         ///< knows channels, rate and ranges
  std::vector<std::string> paths;  ///< of the recordings that were not left out
};

/// The fit of recordings too large for memory. They are read twice: to learn, and to simulate the model over them as
/// fit_arx does. Orders are those of the flags.
/// Errors: as factor_of_tables and fit_arx.
Result<StreamedFit> fit_of_tables(const Arguments& arguments, const ArxOptions& options, Terminal& terminal);

}  // namespace wisp::cli
