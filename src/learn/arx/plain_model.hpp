#pragma once
// A model whose outputs stand for themselves, around dynamics that were just learned.

#include <span>
#include <string>
#include <vector>

#include "learn/arx/rows/arx_design.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::arx {

/// What a channel did over the samples that were learned from.
struct ChannelSpan {
  std::string unit;
  double lowest = 0, highest = 0;  ///< 0 where it has no sample
};

/// What a model needs to know of what it was learned from.
struct Sources {
  double rate_hz = 0;
  std::vector<ChannelSpan> spans{};  ///< outputs, then inputs
  std::vector<std::string> files{};
  bool own_levels = false;  ///< whether every recording was taken about its own means
};

/// Whether the squares of a channel's samples are numbers. Errors: they are not; a constant channel is no error.
Result<void> check_size(const std::string& name, const ChannelSpan& span);

/// Of recordings in memory. Errors: there is none, or one has not a channel; as check_size().
Result<Sources> sources_of(std::span<const Recording> recordings, const ChannelChoice& channels);

/// Name, rate, channels with their units and ranges, and sources; in the recordings' own units.
Model plain_model(const std::string& name, const ChannelChoice& channels, const Sources& sources);

/// Recordings whose channels are moved so that the mean of each is `means` (outputs, then inputs), or, where that is
/// empty, the mean of all recordings together: what MATLAB's detrend(z, 0) does to several experiments.
std::vector<Recording> about_own_levels(std::span<const Recording> recordings, const ChannelChoice& channels,
                                        std::vector<double> means = {});

/// A recording as a model sees it: about its own level where the recordings of the training were. `moved`, where not
/// null, takes what was added to every output for that.
Recording seen_by(const Model& model, const Recording& recording, std::vector<double>* moved = nullptr);

/// The channels that a model was learned from.
ChannelChoice channels_of(const Model& model);

/// Order matrices as a recipe says them. Errors: a matrix of another shape, an order out of range, each by name.
Result<ArxOrders> orders_of(const OrderChoice& na, const OrderChoice& nb, const OrderChoice& nk, Coupling coupling,
                            const ChannelChoice& channels);

/// Settings of the recipe as notes: na, nb, nk and coupling, as they were decided.
std::vector<Note> order_notes(const ArxOrders& orders, Coupling coupling);

}  // namespace wisp::arx
