#include "learn/chain/chain_fit.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "learn/chain/modes/mode_chain.hpp"
#include "learn/chain/modes/mode_realisation.hpp"
#include "learn/chain/modes/mode_sorting.hpp"
#include "learn/chain/segments/segment_weights.hpp"
#include "wisp/model/file.hpp"

namespace wisp::chain {
namespace {

constexpr int kMaxHistory = 6;
constexpr std::size_t kMinSegments = 30;  // with fewer, transitions are anecdotes

Error out_of_range(const char* what, double found, const char* expected) {
  return {std::string(what) + " is " + std::to_string(found) + ", expected " + expected};
}

// A part of the data, cut and described.
struct Cut {
  Motion motion;
  Segmentation segmentation;
  FeatureTable features;
  std::size_t learned_pieces = 0;    // the first ones: the others are held out
  std::size_t learned_segments = 0;  // those of the learned pieces

  std::span<const Segment> segments() const { return segmentation.segments; }
};

std::size_t segments_of(std::span<const Segment> segments, std::size_t pieces) {
  return static_cast<std::size_t>(
      std::count_if(segments.begin(), segments.end(), [&](const Segment& one) { return one.piece < pieces; }));
}

Result<Cut> cut(std::span<const Recording> recordings, const ChainRecipe& recipe) {
  auto motion = motion_of(recordings, recipe.smooth_rows);
  if (!motion) return motion.error();
  auto segmentation = segment(*motion, recordings, segmentation_of(recipe));
  if (!segmentation) return segmentation.error();
  auto features = segment_features(*motion, segmentation->segments, recipe.features);
  if (!features) return features.error();
  Cut out{std::move(*motion), std::move(*segmentation), std::move(*features)};
  const std::size_t pieces = out.motion.pieces.size();
  out.learned_pieces = static_cast<std::size_t>(std::ceil(static_cast<double>(pieces) * (1 - recipe.holdout)));
  if (segments_of(out.segments(), out.learned_pieces) == 0) out.learned_pieces = pieces;
  out.learned_segments = segments_of(out.segments(), out.learned_pieces);
  return out;
}

void take_likelihoods(const ModeSequences& learned, const ModeSequences& judged, int modes, const ModeChain& chain,
                      ChainSummary& summary) {
  summary.log_likelihood = log_likelihood(chain, judged);
  summary.log_likelihood_1 = log_likelihood(estimate_chain(learned, modes, {.history = 1}), judged);
  summary.log_likelihood_2 = log_likelihood(estimate_chain(learned, modes, {.history = 2}), judged);
  ModeChain memoryless = chain;
  std::vector<double> overall(static_cast<std::size_t>(modes));
  double total = 0;
  for (const auto& sequence : learned) {
    for (std::uint16_t mode : sequence) {
      ++overall[mode];
      ++total;
    }
  }
  for (double& p : overall) p /= total;
  memoryless.contexts.resize(static_cast<std::size_t>(modes));
  for (ChainContext& context : memoryless.contexts) context.probability = overall;
  summary.log_likelihood_0 = log_likelihood(memoryless, judged);
}

std::vector<Output> outputs_of(const Motion& motion) {
  std::vector<Output> outputs;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Output output{std::string("pos.") + "xyz"[axis], "m", 0, 0};
    for (const MotionPiece& piece : motion.pieces) {
      for (const Triple& at : piece.position) {
        output.lowest = std::min(output.lowest, at[axis] - piece.position.front()[axis]);
        output.highest = std::max(output.highest, at[axis] - piece.position.front()[axis]);
      }
    }
    outputs.push_back(output);
  }
  if (!motion.has_orientation) return outputs;
  for (const char* name : {"q.w", "q.x", "q.y", "q.z"}) outputs.push_back({name, "", -1, 1});
  return outputs;
}

Training training_of(std::span<const Recording> recordings, const ChainRecipe& recipe, const ChainSummary& summary) {
  Training made;
  for (const Recording& recording : recordings) {
    const std::string name = std::filesystem::path(recording.source).filename().string();
    if (std::find(made.sources.begin(), made.sources.end(), name) == made.sources.end()) made.sources.push_back(name);
  }
  made.motion = MotionTraining{word_of(recipe.event), recipe.min_seconds, recipe.debounce, recipe.smooth_rows};
  made.recipe = {{"features", word_of(recipe.features)},
                 {"frame", recipe.features.heading_free ? "heading" : "world"},
                 {"modes", recipe.modes > 0 ? std::to_string(recipe.modes) : "auto"},
                 {"history", recipe.history > 0 ? std::to_string(recipe.history) : "auto"},
                 {"realisation", std::string(word_of(recipe.realisation))}};
  made.figures = {{"segments", static_cast<double>(summary.segments)},
                  {"mean_segment_seconds", summary.mean_segment_seconds}};
  if (std::isfinite(summary.silhouette)) made.figures.push_back({"silhouette", summary.silhouette});
  if (std::isfinite(summary.log_likelihood)) made.figures.push_back({"log_likelihood", summary.log_likelihood});
  const bool enough = summary.segments >= kMinSegments;
  made.usable = {
      enough, enough
                  ? std::to_string(summary.segments) + " segments in " + std::to_string(summary.modes) + " modes"
                  : "only " + std::to_string(summary.segments) + " segments, expected at least 30: record for longer"};
  return made;
}

std::vector<double> first_order(const ModeChain& chain, int modes) {
  ChainModel model;
  model.modes = modes;
  model.contexts = chain.contexts;
  return model.transitions();
}

Error too_few_segments(const Recording& first, const Cut& data, const ChainRecipe& recipe) {
  return {first.source + ": has " + std::to_string(data.segments().size()) +
          " segments in all, expected at least as many as modes, " + std::to_string(recipe.modes) + ", among the " +
          std::to_string(data.learned_segments) +
          " that are learned from: record for longer, hold out less, or ask for fewer modes"};
}

// How the modes that were learned from follow each other.
struct Walks {
  ModeSequences learned;
  ModeSequences judged;  // those held out, or, where none are, those learned
  ModeChain chain;
};

Walks walks_of(const Cut& data, std::span<const std::uint16_t> cluster, int modes, const ChainRecipe& recipe) {
  const std::size_t learned = data.learned_segments;
  Walks walks{by_stretch(data.segments().first(learned), cluster.first(learned)),
              by_stretch(data.segments().subspan(learned), cluster.subspan(learned)),
              {}};
  if (walks.judged.empty()) walks.judged = walks.learned;
  const ModeChainOptions order = recipe.history > 0 ? ModeChainOptions{.history = recipe.history}
                                                    : best_history(walks.learned, modes, kMaxHistory);
  const auto segments = data.segments().first(learned);
  walks.chain =
      estimate_chain(walks.learned, modes, order, by_stretch<double>(segments, segment_weights(data.motion, segments)));
  return walks;
}

ChainSummary summary_of(const Cut& data, const KMeans& found, const Walks& walks, const ChainModel& dynamics) {
  const std::size_t learned = data.learned_segments;
  ChainSummary summary;
  summary.segments = learned;
  summary.stored = dynamics.segments.size();
  summary.stretches_learned = data.learned_pieces;
  summary.stretches_held_out = data.motion.pieces.size() - data.learned_pieces;
  summary.modes = static_cast<int>(found.sizes.size());
  summary.mode_sizes = found.sizes;
  summary.history = dynamics.history();
  summary.initial = walks.chain.initial;
  summary.transitions = first_order(walks.chain, summary.modes);
  for (const Segment& one : data.segments().first(learned)) summary.mean_segment_seconds += one.end - one.begin;
  summary.mean_segment_seconds /= static_cast<double>(learned) * data.motion.rate_hz;
  const FeatureTable& table = data.features;
  summary.silhouette = silhouette(std::span(table.values).first(learned * table.features), table.features, found);
  take_likelihoods(walks.learned, walks.judged, summary.modes, walks.chain, summary);
  summary.warnings = data.motion.warnings;
  const auto& more = data.segmentation.warnings;
  summary.warnings.insert(summary.warnings.end(), more.begin(), more.end());
  return summary;
}

Model model_of(const Motion& motion, ChainModel dynamics, const ChainRecipe& recipe) {
  Model model;
  model.name = recipe.name;
  model.rate_hz = motion.rate_hz;
  model.outputs = outputs_of(motion);
  model.dynamics = std::move(dynamics);
  if (motion.has_orientation) {
    model.view = PoseView{recipe.half_width, recipe.half_length};
  } else {
    model.view = PositionView{recipe.half_width};
  }
  return model;
}

}  // namespace

Result<void> check_recipe(const ChainRecipe& recipe) {
  if (recipe.modes < 0 || recipe.modes > static_cast<int>(kMaxModes))
    return out_of_range("the number of modes", recipe.modes, "1 to 256, or 0 for auto");
  if (recipe.history < 0 || recipe.history > 16)
    return out_of_range("the chain's history", recipe.history, "1 to 16, or 0 for auto");
  if (!(recipe.holdout >= 0 && recipe.holdout <= 0.9))
    return out_of_range("the share that is held out", recipe.holdout, "0 to 0.9");
  if (!(recipe.blend >= 0 && recipe.blend <= 0.5))
    return out_of_range("the seconds that a join is spread over", recipe.blend, "0 to 0.5");
  if (recipe.best_of < 0 || recipe.best_of > 256)
    return out_of_range("the number of best-joining successors", recipe.best_of, "0 to 256");
  if (recipe.max_bytes == 0) return out_of_range("the size of the store", 0, "bytes above 0");
  return {};
}

Result<ChainFit> fit_chain(std::span<const Recording> recordings, const ChainRecipe& recipe, const Progress& progress) {
  if (auto ok = check_recipe(recipe); !ok) return ok.error();
  if (!go_on(progress, "cutting motion", 0)) return Error{std::string(kStopped)};
  const auto data = cut(recordings, recipe);
  if (!data) return data.error();
  if (!go_on(progress, "sorting segments", 0)) return Error{std::string(kStopped)};
  const std::size_t learned = data->learned_segments;
  if (learned < static_cast<std::size_t>(recipe.modes)) return too_few_segments(recordings.front(), *data, recipe);
  const auto sorted = sorted_segments(data->features, learned, data->segments(), recipe, progress);
  if (!sorted) return sorted.error();
  if (!go_on(progress, "joining segments", 0)) return Error{std::string(kStopped)};
  const int modes = static_cast<int>(sorted->found.sizes.size());
  const Walks walks = walks_of(*data, sorted->cluster, modes, recipe);
  auto realised = realised_chain(
      {data->motion, data->segments().first(learned), std::span(sorted->cluster).first(learned), modes, walks.chain},
      recipe);
  if (!realised) return realised.error();

  ChainFit fit;
  fit.summary = summary_of(*data, sorted->found, walks, realised->dynamics);
  fit.origin = std::move(realised->origin);
  for (std::size_t k = 0; k < data->motion.pieces.size(); ++k) {
    const MotionPiece& piece = data->motion.pieces[k];
    auto part = slice(recordings[piece.recording], piece.first_row, piece.first_row + piece.rows());
    (k < data->learned_pieces ? fit.learned : fit.held_out).push_back(std::move(part));
  }
  fit.model = model_of(data->motion, std::move(realised->dynamics), recipe);
  fit.model.training = training_of(recordings, recipe, fit.summary);
  if (auto ok = check(fit.model); !ok) return ok.error();
  return fit;
}

}  // namespace wisp::chain
