#pragma once
// Which channels of a recording are the system's inputs and outputs.

#include <string>
#include <vector>

namespace wisp {

/// Channels by name, in the model's order. Roles in the recording do not matter: an output of one system may be another
/// one's input.
struct ChannelChoice {
  std::vector<std::string> inputs;   ///< may be empty: a model without input
  std::vector<std::string> outputs;  ///< at least one
};

}  // namespace wisp
