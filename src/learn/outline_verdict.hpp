#pragma once
// What a learned outline says of itself: whether to use it, and how it was made.

#include <span>
#include <string_view>

#include "wisp/learn/outline.hpp"

namespace wisp {

/// Whether the model may be used, with the first reason against it or a sentence in its favour.
Usable outline_verdict(const ArxSummary& fit, const OutlineSummary& summary);

/// Sources, options and figures, for the model's file.
Provenance outline_provenance(std::span<const Recording> recordings, const OutlineOptions& options,
                              const OutlineSummary& summary);

/// The name under which an input's scale stands among the figures: the recording's value that is 1 in the model.
std::string input_scale_figure(const std::string& input);

/// The name of the figure that says how loud it was where an input was the recording's 1 (wisp/record/loudness.hpp).
std::string one_rms_figure(const std::string& input);

/// The name of the figure that says whether all outlines ran on along their underside, 1 or 0.
inline constexpr std::string_view kUndersideFigure = "underside";

/// A figure of the model's provenance, 0 where it has none of that name or a negative one.
double positive_figure(const Model& model, const std::string& name);

}  // namespace wisp
