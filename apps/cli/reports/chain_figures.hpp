#pragma once
// The plots of `wisp validate --figures` for segment chains.

#include <filesystem>
#include <vector>

#include "wisp/learn/chain_fidelity.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Writes recorded and synthesized falls side by side, seen from the side and from above, and one fall of each with its
/// events marked, the synthesized one's segments coloured by mode; into a folder (made where it is missing), each as
/// PNG and SVG.
/// Errors: a file cannot be written; as chain_fidelity().
Result<void> write_chain_figures(const std::filesystem::path& folder, const Model& model,
                                 const std::vector<Recording>& real, const ChainFidelityOptions& options);

}  // namespace wisp::cli
