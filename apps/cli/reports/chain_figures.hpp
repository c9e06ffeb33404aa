#pragma once
// The plots of `wisp validate --figures` for segment chains.

#include <filesystem>

#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"

namespace wisp::cli {

/// Draws the series of a chain's report, into a folder (made where it is missing), each sheet as PNG and SVG. Of falls:
/// recorded and synthesized ones side by side, seen from the side and from above, and one of each with its events
/// marked, the synthesized one's segments coloured by mode. Of gusts, the paper's figure 8: a row a gust, on the left
/// the recorded falls, on the right the model's; thin lines are clones, thick ones their means, green where the wind
/// blows; dashed is the mean without wind.
/// Errors: the folder cannot be made, a file cannot be written.
Result<void> write_chain_figures(const std::filesystem::path& folder, const Report& report);

}  // namespace wisp::cli
