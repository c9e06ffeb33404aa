// Source: S. Arlot and A. Celisse, "A survey of cross-validation procedures for model selection", Statistics Surveys 4
// (2010), section 8.1: of dependent data whole blocks are left out.

#include "learn/outline/outline_turns.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace wisp {
namespace {

// Which turn holds a row out.
struct Turns {
  std::size_t block = 1;  // rows
  std::size_t count = 2;

  std::size_t of(std::size_t row) const { return row / block % count; }
};

Turns turns_of(const Recording& recording, std::size_t count) {
  const auto second = static_cast<std::size_t>(std::lround(recording.rate_hz));
  return {std::clamp<std::size_t>(second, 1, std::max<std::size_t>(1, recording.rows() / count)), count};
}

// The recordings without the outlines that one turn holds out.
std::vector<Recording> without(const PreparedOutlines& prepared, std::size_t turn, std::size_t count) {
  std::vector<Recording> out = prepared.recordings;
  for (Recording& recording : out) {
    const Turns turns = turns_of(recording, count);
    for (std::size_t c : prepared.layout.outputs) {
      auto& samples = recording.channels[c].samples;
      for (std::size_t row = 0; row < samples.size(); ++row) {
        if (turns.of(row) == turn) samples[row] = std::numeric_limits<double>::quiet_NaN();
      }
    }
  }
  return out;
}

// What the models predict, each of the rows that it was estimated without.
Result<std::vector<std::vector<double>>> predicted_in_turn(const std::vector<ArxModel>& models,
                                                           const Recording& recording, const ChannelChoice& channels,
                                                           int steps) {
  const Turns turns = turns_of(recording, models.size());
  std::vector<std::vector<double>> out;
  for (std::size_t turn = 0; turn < models.size(); ++turn) {
    auto series = predict(models[turn], recording, channels, {.steps = steps});
    if (!series) return series;
    if (out.empty()) out = *series;
    for (std::size_t i = 0; i < out.size(); ++i) {
      for (std::size_t row = 0; row < out[i].size(); ++row) {
        if (turns.of(row) == turn) out[i][row] = (*series)[i][row];
      }
    }
  }
  return out;
}

}  // namespace

Result<OutlineFigures> figures_in_turn(const OutlineEstimate& estimate, const PreparedOutlines& prepared,
                                       std::size_t turns) {
  assert(turns >= 2);
  std::vector<ArxModel> models;
  for (std::size_t turn = 0; turn < turns; ++turn) {
    auto model = estimate(without(prepared, turn, turns));
    if (!model) return model.error();
    models.push_back(*std::move(model));
  }
  const auto predicted = [&](std::size_t recording, int steps) {
    return predicted_in_turn(models, prepared.recordings[recording], prepared.channels, steps);
  };
  return outline_figures(predicted, prepared.recordings, prepared.layout, kJudgedSteps);
}

}  // namespace wisp
