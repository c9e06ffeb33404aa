#pragma once
// The paper's figure 8: what gusts do to a fall, seen from above, simulated and played by the model.

#include <filesystem>
#include <span>

#include "wisp/base/result.hpp"
#include "wisp/learn/gust_play.hpp"

namespace wisp::cli {

/// Writes `gusts-above`, a row of the sheet a gust: on the left the recorded falls, on the right the model's. Thin
/// lines are clones, thick ones their means, green where the wind blows; dashed is the mean without wind. Errors: the
/// folder cannot be made, a file cannot be written.
///
/// Precondition: !scenes.empty().
Result<void> write_gust_figure(const std::filesystem::path& folder, std::span<const GustScene> scenes);

}  // namespace wisp::cli
