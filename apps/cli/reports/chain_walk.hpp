#pragma once
// How `wisp run` has a segment chain walk.

#include <optional>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"

namespace wisp::cli {

/// The flags of steering.
std::vector<Flag> chain_walk_flags();

/// Where they say that a walk is to be, if they do.
/// Errors: they are given for another kind of model, or a number is out of its range.
Result<std::optional<SteerTarget>> steer_target_from(const Model& model, const Arguments& arguments);

/// Steers every instance that lives to a target, if there is one.
void steer_all(const std::optional<SteerTarget>& target, Bank& bank);

/// Warns of a target that hardly any walk comes to, however it is steered.
void warn_of_target(const Model& model, const std::optional<SteerTarget>& target, Terminal& terminal);

}  // namespace wisp::cli
