#pragma once
// Plots of what a clip gave: its brightness, and its sound.

#include <filesystem>

#include "wisp/base/report.hpp"
#include "wisp/draw/plot.hpp"

namespace wisp::cli {

/// Writes what capture() reported of a clip: the brightness histogram with the threshold, and, where the clip has
/// sound, the sound as it is beside its root mean square frame by frame, into a folder that exists. Errors: the clip's
/// sound cannot be read, a file cannot be written.
Result<void> write_clip_figures(const std::filesystem::path& folder, const std::filesystem::path& clip,
                                const Report& captured);

/// Writes a sheet as NAME.png and NAME.svg.
Result<void> write_figure(const std::filesystem::path& folder, const std::string& name, const PlotSheet& sheet);

}  // namespace wisp::cli
