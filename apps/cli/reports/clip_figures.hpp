#pragma once
// Plots of a clip's brightness and sound.

#include <filesystem>

#include "wisp/base/report.hpp"
#include "wisp/draw/plot.hpp"

namespace wisp::cli {

/// Writes plots of a captured clip into a folder: the brightness histogram with the threshold and, if the clip has
/// sound, its waveform and the RMS of each captured frame, which follow `skipped` others. Errors: the clip's sound
/// cannot be read, a file cannot be written.
Result<void> write_clip_figures(const std::filesystem::path& folder, const std::filesystem::path& clip,
                                std::size_t skipped, const Report& captured);

/// Writes a sheet as NAME.png and NAME.svg into a folder, which is created if missing.
Result<void> write_figure(const std::filesystem::path& folder, const std::string& name, const PlotSheet& sheet);

}  // namespace wisp::cli
