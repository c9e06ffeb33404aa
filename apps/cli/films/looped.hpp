#pragma once
// A model's play as a recording, and loops of it (`--loop` of run and of export).

#include <string>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/export/export.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// The flag of `run` and `export`.
Flag loop_flag();

/// Plays the take that --loop, --seconds, --instances, --seed, --noise and --wind describe; adds its size to the
/// result. Errors: as take(); --wind for a model without inputs.
Result<Take> take_from(const Model& model, const Arguments& arguments, Terminal& terminal, bool round = false);

/// `run --loop`: writes the loop as numbers (.csv) or, of outlines, as a film (.mp4) whose last frame meets its first.
/// Errors: as take_from(); a flag that does not go with a loop; another name.
Result<void> write_loop(const Model& model, const Arguments& arguments, Terminal& terminal);

/// A take in a constant wind as a recording; of several bodies one episode each.
Recording recording_of(const Model& model, const Take& taken, double wind, const std::string& seed);

/// Empty channels: the model's inputs, then the outputs of each instance, named i0., i1., … where they are several.
Recording played_channels(const Model& model, int instances, const std::string& seed);

/// Converts such a recording of bodies to one episode an instance, one after the other.
///
/// Precondition: the recording has played_channels() of that model.
Recording one_after_the_other(const Recording& side_by_side, const Model& model, int instances,
                              const std::string& seed);

/// Whether several instances of the model are recorded as one episode each.
bool are_bodies(const Model& model, int instances);

}  // namespace wisp::cli
