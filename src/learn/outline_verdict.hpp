#pragma once
// What a learned outline says of itself: whether to use it, and how it was made.

#include <span>

#include "wisp/learn/outline.hpp"

namespace wisp {

/// Whether the model may be used, with the first reason against it or a sentence in its favour.
Usable outline_verdict(const ArxSummary& fit, const OutlineSummary& summary);

/// Sources, options and figures, for the model's file.
Provenance outline_provenance(std::span<const Recording> recordings, const OutlineOptions& options,
                              const OutlineSummary& summary);

/// The name under which an input's scale stands among the figures: the recording's value that is 1 in the model.
std::string input_scale_figure(const std::string& input);

}  // namespace wisp
