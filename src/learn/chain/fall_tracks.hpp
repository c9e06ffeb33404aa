#pragma once
// Tracks of recorded and synthesized falls, to be plotted.

#include <span>

#include "learn/chain/chain_fidelity.hpp"
#include "wisp/base/report.hpp"

namespace wisp::chain {

/// Falls from the side and from above (ids `falls-side.SIDE`, `falls-above.SIDE`, SIDE being recorded or synthesized),
/// and one of each with its events (`segments.SIDE.track`, `segments.SIDE.events`), the synthesized one's track by mode
/// (`segments.synthesized.mode_K`).
/// Errors: as chain_fidelity().
Result<ReportSection> fall_tracks(const Model& model, std::span<const Recording> real,
                                  const ChainFidelityOptions& options);

}  // namespace wisp::chain
