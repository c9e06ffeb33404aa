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

struct ChainWalk {
  int history = 0;                   ///< as ChainFacet::set_history()
  std::optional<float> temperature;  ///< as ChainFacet::set_temperature()
  std::optional<SteerTarget> target;
};

/// The flags that say so.
std::vector<Flag> chain_walk_flags();

/// What they say. Errors: they are given for another kind of model, or a number is out of its range.
Result<ChainWalk> chain_walk_from(const Model& model, const Arguments& arguments);

void set_walk(const ChainWalk& walk, Bank& bank);

/// Steers every instance that lives to the walk's target, if there is one.
void steer_all(const ChainWalk& walk, Bank& bank);

/// Says, of a chain, how it repeats itself without chance.
void say_chain_loop(const Model& model, const ChainWalk& walk, Terminal& terminal);

/// Warns of a target that hardly any walk comes to, however it is steered.
void warn_of_target(const Model& model, const ChainWalk& walk, Terminal& terminal);

}  // namespace wisp::cli
