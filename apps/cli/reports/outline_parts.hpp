#pragma once
// Parts of an outline's fit as files: `--partial` and `--merge` of `learn outline` and `learn flame`.

#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// --partial, --part, --merge, --expect.
std::vector<Flag> outline_part_flags();

/// Captures or reads the recordings of the share --part (with --merge: reads the named parts) and writes them to the
/// file of --partial, whole or not at all. Errors: as outline_recordings() and merged_recordings(), more shares than
/// recordings, a file that cannot be written.
Result<void> write_outline_part(const Arguments& arguments, Terminal& terminal);

/// The recordings in the named parts. Errors: a file that cannot be read, is not a part, was damaged, or holds what
/// another one does; a part that is missing.
Result<std::vector<Recording>> merged_recordings(const Arguments& arguments);

}  // namespace wisp::cli
