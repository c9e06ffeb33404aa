#include "learn/chain/modes/mode_realisation.hpp"

#include <cmath>

#include "learn/chain/chain_drift.hpp"
#include "learn/chain/modes/mode_parts.hpp"
#include "learn/chain/modes/mode_splines.hpp"
#include "learn/chain/modes/mode_systems.hpp"
#include "learn/chain/motion/height_bound.hpp"
#include "learn/chain/segments/segment_store.hpp"
#include "learn/chain/segments/segment_weights.hpp"

namespace wisp::chain {
namespace {

constexpr int kMaxPartHistory = 2;  // of halves: a longer one has thousands of rows

RealisedChain stored_chain(const ModeWalk& walk, const ChainRecipe& recipe) {
  const SegmentStoreOptions storing{.heading_free = recipe.features.heading_free,
                                    .max_bytes = recipe.max_bytes,
                                    .bounded_height = height_is_bounded(walk.motion, walk.segments),
                                    .breadth = recipe.best_of};
  const auto store = store_segments(walk.motion, walk.segments, walk.cluster, walk.modes, storing);
  RealisedChain out;
  ChainModel& dynamics = out.dynamics;
  dynamics.motion = walk.motion.has_orientation ? ChainMotion::kPose : ChainMotion::kPosition;
  dynamics.heading_free = recipe.features.heading_free;
  dynamics.modes = walk.modes;
  dynamics.segments = store.segments;
  dynamics.initial = walk.chain.initial;
  dynamics.contexts = walk.chain.contexts;
  dynamics.blend_steps = static_cast<int>(std::lround(recipe.blend * walk.motion.rate_hz));
  for (std::size_t source : store.source) out.origin.push_back(source + walk.segments[source].piece);
  return out;
}

Result<RealisedChain> chain_of_systems(const ModeWalk& walk, const ChainRecipe& recipe) {
  const bool linear = recipe.realisation == Realisation::kLinear;
  auto systems = fit_mode_systems(walk.motion, walk.segments, walk.cluster, walk.modes,
                                  {.degree = linear ? 1 : 2, .noisy = linear});
  if (!systems) return systems.error();
  ChainRecipe few = recipe;
  few.max_bytes = 1;  // one for each mode, with which lives begin
  few.best_of = 0;
  RealisedChain out = stored_chain(walk, few);
  out.dynamics.systems = std::move(*systems);
  return out;
}

// A chain whose modes are chains of halves of segments.
Result<RealisedChain> chain_of_parts(const ModeWalk& walk, const ChainRecipe& recipe) {
  const auto parts = mode_parts(walk.motion, walk.segments, walk.cluster, walk.modes, recipe.features, recipe.seed);
  if (!parts) return parts.error();
  // Twice as many kinds: tables of what joins what are as large with half of the successors.
  const int history = recipe.history > 0 ? recipe.history : kMaxPartHistory;
  const ModeChain chain =
      estimate_chain(by_stretch<std::uint16_t>(parts->segments, parts->cluster), parts->modes,
                     {.history = history, .back_off = recipe.history == 0},
                     by_stretch<double>(parts->segments, segment_weights(walk.motion, parts->segments)));
  ChainRecipe fewer = recipe;
  fewer.best_of = (recipe.best_of + 1) / 2;
  return stored_chain({walk.motion, parts->segments, parts->cluster, parts->modes, chain}, fewer);
}

}  // namespace

Result<RealisedChain> realised_chain(const ModeWalk& walk, const ChainRecipe& recipe) {
  if (recipe.realisation == Realisation::kLinear || recipe.realisation == Realisation::kOde) {
    return chain_of_systems(walk, recipe);
  }
  auto out = recipe.realisation == Realisation::kChain ? chain_of_parts(walk, recipe)
                                                       : Result<RealisedChain>(stored_chain(walk, recipe));
  if (!out) return out;
  if (recipe.realisation == Realisation::kSpline) as_splines(out->dynamics);
  out->dynamics.drift = drift_of(out->dynamics, walk.motion.rate_hz);
  return out;
}

}  // namespace wisp::chain
