#pragma once
// Simulated clips as files.

#include <filesystem>

#include "terminal.hpp"
#include "wisp/simulate/candle_clip.hpp"

namespace wisp::cli {

/// Simulates, encodes as it goes, and writes clip and truth, each whole or not at all. Returns the truth.
/// Errors: as simulate_candle() and VideoWriter.
Result<Recording> write_simulated_clip(const std::filesystem::path& path, const CandleClipOptions& options,
                                       Terminal& terminal);

/// CLIP.truth.csv for CLIP.mp4.
std::filesystem::path truth_path(const std::filesystem::path& clip);

}  // namespace wisp::cli
