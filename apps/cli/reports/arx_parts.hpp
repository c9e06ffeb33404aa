#pragma once
// Parts of a fit as files: `--partial` and `--merge` of `learn arx`, with which any job engine spreads the work.

#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/learn/triangular_factor.hpp"

namespace wisp::cli {

/// --partial, --part, --merge.
std::vector<Flag> part_flags();

/// What the part files that stand without dashes know together.
/// Errors: a file that cannot be read, is not a part, was damaged, or is of another model than the first; each is
/// named.
Result<TriangularFactor> merged_parts(const Arguments& arguments);

/// Writes what the recordings (or, with --merge, the parts) have to say to the file of --partial, whole or not at all.
/// Errors: as factor_of_tables and merged_parts, and where the file cannot be written.
Result<void> write_part(const Arguments& arguments, Terminal& terminal);

}  // namespace wisp::cli
