#pragma once
// A loop of a model's play, `--loop` of run and of export: what is taken, and what it becomes as numbers and as a
// film.

#include <string>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/export/export.hpp"

namespace wisp::cli {

/// The flag of `run` and `export`.
Flag loop_flag();

/// What the flags ask for, --loop, --seconds, --instances, --seed, --noise and --wind, played; its size goes into the
/// result. Errors: as take(); --wind for a model without inputs.
Result<Take> take_from(const Model& model, const Arguments& arguments, Terminal& terminal);

/// `run --loop`: writes the loop as numbers (.csv) or, of outlines, as a film (.mp4) whose last frame meets its first.
/// Errors: as take_from(); a flag that does not go with a loop; another name.
Result<void> write_loop(const Model& model, const Arguments& arguments, Terminal& terminal);

}  // namespace wisp::cli
