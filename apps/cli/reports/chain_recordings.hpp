#pragma once
// Recordings of something that moves, as commands of chains take them: found sound before anything is learned.

#include <string>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Whether a recording can tell motion. Errors: no position, no stretch that is long enough, no orientation where it
/// should have one, as motion_of(); a position further than 1000 km away.
Result<void> check_motion(const Recording& recording);

/// Whether a recording can be one of a pair. Errors: as check_motion(); a wind that is missing somewhere; an attribute
/// `clones` that is no whole number.
Result<void> check_paired(const Recording& recording);

/// Reads recordings to learn from and checks each, a pair's by check_paired(). A bad one is the error, or is left out
/// with --skip-bad.
Result<std::vector<Recording>> read_motions(const std::vector<std::string>& paths, const Arguments& arguments,
                                            Terminal& terminal);

/// How many episodes repeat an earlier one, row by row: they teach nothing, and judge nothing where they are held out.
struct Repeats {
  std::size_t episodes = 0;
  std::size_t repeated = 0;
};
Repeats repeats_in(const std::vector<Recording>& recordings);

}  // namespace wisp::cli
