#pragma once
// Models whose outputs are recorded channels, without an outline: their channels, sources, centring and orders.

#include <span>
#include <string>
#include <vector>

#include "learn/rows/arx_design.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::arx {

/// Unit and range of a channel over the training samples.
struct ChannelSpan {
  std::string unit;
  double lowest = 0, highest = 0;  ///< 0 without samples
};

/// Facts about the training recordings that a model stores.
struct Sources {
  double rate_hz = 0;
  std::vector<ChannelSpan> spans{};  ///< outputs, then inputs
  std::vector<std::string> files{};
  bool own_levels = false;  ///< whether each recording was centred on its own means
};

/// Checks the samples of a channel. Errors: a range below 1e-120 but not 0, or a magnitude above 1e120: squares come
/// near the limits of double precision.
Result<void> check_size(const std::string& name, const ChannelSpan& span);

/// Sources of recordings in memory. Errors: as find_signals() and check_size().
Result<Sources> sources_of(std::span<const Recording> recordings, const ChannelChoice& channels);

/// Returns a model without dynamics: name, rate, channels with units and ranges, and sources, in the recordings' units.
Model plain_model(const std::string& name, const ChannelChoice& channels, const Sources& sources);

/// Returns the recordings, each shifted so that the means of its channels are `means` (outputs, then inputs) or, if
/// `means` is empty, the means over all recordings; like MATLAB's detrend(z, 0) for several experiments.
std::vector<Recording> about_own_levels(std::span<const Recording> recordings, const ChannelChoice& channels,
                                        std::vector<double> means = {});

/// Returns the recording, shifted to the model's means if training recordings were each centred on their own means.
/// `moved`, if not null, receives the shift added to each output.
Recording seen_by(const Model& model, const Recording& recording, std::vector<double>* moved = nullptr);

/// Names of the model's inputs and outputs.
ChannelChoice channels_of(const Model& model);

/// Order matrices from a recipe, na 0 between uncoupled outputs. Errors: no output, wrong shapes, orders out of range.
Result<ArxOrders> orders_of(const OrderChoice& na, const OrderChoice& nb, const OrderChoice& nk, Coupling coupling,
                            const ChannelChoice& channels);

/// Notes for the training record: na, nb, nk and coupling.
std::vector<Note> order_notes(const ArxOrders& orders, Coupling coupling);

}  // namespace wisp::arx
