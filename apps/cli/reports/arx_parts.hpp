#pragma once
// Recordings too large for memory, and parts of a fit as files: `--partial` and `--merge` of `learn arx`, with which
// any job engine spreads the work.

#include <string>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/learn/parts.hpp"

namespace wisp::cli {

/// --partial, --part, --merge, --expect.
std::vector<Flag> arx_part_flags();

/// Whether learning from the named recordings at once would take more than --memory.
bool too_large(const Arguments& arguments);

/// A part, and the names of the files that are in it.
struct NamedPart {
  ArxPart part;
  std::vector<std::string> sources;
};

/// The named tables, or the share of --part of each, at bounded memory. --range chooses their rows; MATLAB files are
/// read whole; a bad one is the error, or left out with --skip-bad.
Result<NamedPart> part_of_tables(const ArxRecipe& recipe, const Arguments& arguments, Terminal& terminal);

/// What the named part files know together. Errors: a file that cannot be read, is not a part, was damaged, or is of
/// another model than the first; each is named.
Result<NamedPart> merged_parts(const Arguments& arguments);

/// Writes what the recordings (or, with --merge, the parts) have to say to the file of --partial, whole or not at all.
/// Errors: as part_of_tables and merged_parts, and where the file cannot be written.
Result<void> write_part(const ArxRecipe& recipe, const Arguments& arguments, Terminal& terminal);

}  // namespace wisp::cli
