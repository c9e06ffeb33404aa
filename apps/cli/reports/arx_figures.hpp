#pragma once
// The plots that identification people look at: poles and zeros, step and frequency responses with their bands, what
// the residuals still know.

#include <filesystem>

#include "terminal.hpp"
#include "wisp/learn/channel_choice.hpp"
#include "wisp/learn/residual_tests.hpp"
#include "wisp/model/arx.hpp"

namespace wisp::cli {

/// A model to be drawn. `covariance` is that of its coefficients (ArxFit's), or empty: then there are no bands.
struct DrawnArx {
  const ArxModel& model;
  const ChannelChoice& channels;
  double rate_hz = 1;
  std::span<const double> covariance{};
};

/// Writes `poles-zeros`, and per output `step` and `frequency`, with 95 % bands, into a folder that exists, each as PNG
/// and SVG. Models of more than four outputs have the responses of the first four.
/// Errors: a file cannot be written.
Result<void> write_response_figures(const std::filesystem::path& folder, const DrawnArx& drawn);

/// The numbers of these plots, for all outputs: `seconds` and `step` [output][input] {`value`, `sd`}; `hz` and
/// `frequency` [output][input] {`amplitude`, `amplitude_sd`, `phase`, `phase_sd`}, phases in radians. Standard
/// deviations are null without a covariance.
Json responses_json(const DrawnArx& drawn);

/// Writes `residuals`: autocorrelation and correlation with every input, with what chance allows.
/// Errors: a file cannot be written.
Result<void> write_residual_figure(const std::filesystem::path& folder, const ResidualTests& tests,
                                   const ChannelChoice& channels);

}  // namespace wisp::cli
