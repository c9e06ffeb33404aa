#pragma once
// What was played, as a recording: `run` writes it frame by frame, `run --loop` from a loop.

#include <string>

#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Empty channels: the model's inputs, then the outputs of each instance, named i0., i1., … where they are several.
Recording played_channels(const Model& model, int instances, const std::string& seed);

/// The same of bodies, whose falls are recorded one after the other, each instance an episode; flags are left out.
///
/// Precondition: the recording has played_channels() of that model.
Recording one_after_the_other(const Recording& side_by_side, const Model& model, int instances,
                              const std::string& seed);

/// Whether a model's instances are bodies, each an episode of its own.
bool are_bodies(const Model& model, int instances);

}  // namespace wisp::cli
