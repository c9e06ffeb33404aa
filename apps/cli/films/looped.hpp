#pragma once
// Plays of a model as recordings, and loops of them (`--loop` of run and of export).

#include <string>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/export/export.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Returns the flag --loop of `run` and `export`.
Flag loop_flag();

/// Plays the take requested by --loop, --seconds, --instances, --seed, --noise and --wind or --input; adds its size to
/// the result. `round`: as TakeOptions::round. Errors: those of take() and InputTrack::from().
Result<Take> take_from(const Model& model, const Arguments& arguments, Terminal& terminal, bool round = false);

/// `run --loop`: writes the loop as numbers (.csv) or, for outlines, as a film (.mp4) whose last frame joins its first.
/// Errors: as take_from(); a flag that contradicts a loop; another extension.
Result<void> write_loop(const Model& model, const Arguments& arguments, Terminal& terminal);

/// Converts a take in constant wind to a recording; several bodies give one episode each.
Recording recording_of(const Model& model, const Take& taken, double wind, const std::string& seed);

/// Returns a recording without rows: the inputs, then each instance's outputs (of several prefixed i0., i1., …).
Recording played_channels(const Model& model, int instances, const std::string& seed);

/// Converts a recording of several bodies to consecutive episodes, one per instance. Precondition: the recording has
/// played_channels() of that model.
Recording one_after_the_other(const Recording& side_by_side, const Model& model, int instances,
                              const std::string& seed);

/// Returns whether several instances of the model are recorded as one episode each.
bool are_bodies(const Model& model, int instances);

}  // namespace wisp::cli
