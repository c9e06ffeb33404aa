#include "wisp/learn/chain.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "learn/chain/chain_drift.hpp"
#include "learn/chain/modes/mode_chain.hpp"
#include "learn/chain/modes/mode_parts.hpp"
#include "learn/chain/modes/mode_splines.hpp"
#include "learn/chain/modes/mode_systems.hpp"
#include "learn/chain/segments/segment_weights.hpp"
#include "learn/numeric/clustering.hpp"
#include "wisp/learn/motion.hpp"
#include "wisp/model/file.hpp"
#include "wisp/record/number_text.hpp"

namespace wisp {
namespace {

constexpr int kMostAutoModes = 12;
constexpr int kMostHistory = 6;
constexpr int kMostPartHistory = 2;         // of halves: a longer one has thousands of rows
constexpr std::size_t kLeastSegments = 30;  // with fewer, transitions are anecdotes

Result<void> check_options(const ChainOptions& options) {
  if (options.modes < 0 || options.modes > static_cast<int>(kMostModes)) {
    return Error{"the number of modes is " + std::to_string(options.modes) + ", expected 1 to 256, or auto"};
  }
  if (options.history < 0 || options.history > 16) {
    return Error{"the chain's history is " + std::to_string(options.history) + ", expected 1 to 16, or auto"};
  }
  if (!(options.holdout >= 0 && options.holdout <= 0.9)) {
    return Error{"the share that is held out is " + std::to_string(options.holdout) + ", expected 0 to 0.9"};
  }
  if (!(options.blend_share >= 0 && options.blend_share <= 0.5)) {
    return Error{"joins fade over a share of " + std::to_string(options.blend_share) +
                 " of a segment, expected 0 to 0.5"};
  }
  if (options.store.breadth < 0 || options.store.breadth > 256 || options.store.most_bytes == 0) {
    return Error{"the number of best followers or the size of the store is out of range, expected 0 to 256 and not 0"};
  }
  return {};
}

// Segments that follow each other, as sequences of their modes.
ModeSequences sequences_of(std::span<const Segment> segments, std::span<const std::uint16_t> cluster) {
  ModeSequences sequences;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    if (k == 0 || segments[k].piece != segments[k - 1].piece) sequences.emplace_back();
    sequences.back().push_back(cluster[k]);
  }
  return sequences;
}

// What they stand for, in the same sequences.
ModeWeights weights_of(const Motion& motion, std::span<const Segment> segments) {
  const std::vector<double> weight = segment_weights(motion, segments);
  ModeWeights weights;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    if (k == 0 || segments[k].piece != segments[k - 1].piece) weights.emplace_back();
    weights.back().push_back(weight[k]);
  }
  return weights;
}

// A part of the data, cut and described.
struct Cut {
  Motion motion;
  Segmentation segmentation;
};

Result<Cut> cut(std::span<const Recording> recordings, const ChainOptions& options) {
  auto motion = motion_of(recordings, options.smooth_rows);
  if (!motion) return motion.error();
  auto segmentation = segment(*motion, recordings, options.segmentation);
  if (!segmentation) return segmentation.error();
  return Cut{std::move(*motion), std::move(*segmentation)};
}

// Segments in order: those of the first `learned` pieces are learned from.
std::size_t learned_segments(const Cut& data, std::size_t pieces) {
  std::size_t count = 0;
  for (const Segment& segment : data.segmentation.segments) count += segment.piece < pieces ? 1 : 0;
  return count;
}

std::vector<std::uint16_t> nearest(const FeatureTable& table, const KMeans& found) {
  std::vector<std::uint16_t> cluster;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < found.sizes.size(); ++k) {
      double distance = 0;
      for (std::size_t i = 0; i < table.features; ++i) {
        const double away = table.values[row * table.features + i] - found.middles[k * table.features + i];
        distance += away * away;
      }
      if (distance >= least) continue;
      least = distance;
      best = k;
    }
    cluster.push_back(static_cast<std::uint16_t>(best));
  }
  return cluster;
}

// What the learned and the held-out part of the segments were sorted into.
struct Sorted {
  KMeans found;
  std::vector<std::uint16_t> cluster;  // of all segments
};

Result<Sorted> sorted(const FeatureTable& table, std::size_t learned, int modes, const ChainOptions& options) {
  const KMeansOptions clustering{.clusters = modes, .restarts = options.restarts, .seed = options.seed};
  auto found = k_means(std::span(table.values).first(learned * table.features), table.features, clustering);
  if (!found) return found.error();
  auto cluster = nearest(table, *found);
  // A row that was given to an empty cluster stays there.
  std::copy(found->cluster.begin(), found->cluster.end(), cluster.begin());
  return Sorted{std::move(*found), std::move(cluster)};
}

ModeChainOptions order_of(const ModeSequences& learned, int modes, int history) {
  if (history > 0) return {.history = history};
  return best_history(learned, modes, kMostHistory);
}

// Mean log-likelihood of held-out features, each mode a normal distribution of one variance around its middle: the one
// measure that chains of different numbers of modes share.
double feature_likelihood(const FeatureTable& table, std::size_t learned, const Sorted& modes,
                          std::span<const Segment> segments, int count) {
  const std::size_t columns = table.features;
  const double variance =
      std::max(1e-12, modes.found.inertia / static_cast<double>(learned) / static_cast<double>(columns));
  const auto told = sequences_of(segments.first(learned), std::span(modes.cluster).first(learned));
  const ModeChain chain = estimate_chain(told, count, {.history = 1, .back_off = true});
  const bool judged_apart = learned < table.rows();
  const std::size_t first = judged_apart ? learned : 0;
  const auto judged = sequences_of(segments.subspan(first), std::span(modes.cluster).subspan(first));
  double square = 0;
  for (std::size_t row = first; row < table.rows(); ++row) {
    for (std::size_t k = 0; k < columns; ++k) {
      const double away = table.values[row * columns + k] - modes.found.middles[modes.cluster[row] * columns + k];
      square += away * away;
    }
  }
  const auto rows = static_cast<double>(table.rows() - first);
  const double spread = -0.5 * (square / rows / variance + static_cast<double>(columns) * std::log(variance));
  const double walk = log_likelihood(chain, judged);
  return spread + (std::isnan(walk) ? 0 : walk);
}

Result<Sorted> sorted_best(const FeatureTable& table, std::size_t learned, std::span<const Segment> segments,
                           const ChainOptions& options) {
  if (options.modes > 0) return sorted(table, learned, options.modes, options);
  Result<Sorted> best = sorted(table, learned, 1, options);
  if (!best) return best;
  double highest = -std::numeric_limits<double>::infinity();
  const int most = std::min(kMostAutoModes, static_cast<int>(learned));
  for (int modes = 2; modes <= most; ++modes) {
    auto tried = sorted(table, learned, modes, options);
    if (!tried) return tried;
    const double likelihood = feature_likelihood(table, learned, *tried, segments, modes);
    if (likelihood <= highest) continue;
    highest = likelihood;
    best = std::move(tried);
  }
  return best;
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

std::string words_of(const FeatureChoice& choice) {
  std::string words;
  const auto add = [&](bool on, const char* word) {
    if (on) words += (words.empty() ? "" : ",") + std::string(word);
  };
  add(choice.velocity, "velocity");
  add(choice.length, "length");
  add(choice.direction, "direction");
  add(choice.spin, "spin");
  add(choice.tilt, "tilt");
  add(choice.duration, "duration");
  return words;
}

std::string words_of(const EventSpec& event) {
  const char* kind = event.kind == EventKind::kZero ? "zero:" : event.kind == EventKind::kMinimum ? "min:" : "max:";
  return kind + event.signal;
}

Training training_of(std::span<const Recording> recordings, const ChainOptions& options, const ChainSummary& summary) {
  Training made;
  for (const Recording& recording : recordings) {
    const std::string name = std::filesystem::path(recording.source).filename().string();
    if (std::find(made.sources.begin(), made.sources.end(), name) == made.sources.end()) made.sources.push_back(name);
  }
  made.motion = MotionTraining{words_of(options.segmentation.event), options.segmentation.least_seconds,
                               options.segmentation.debounce, options.smooth_rows};
  made.recipe = {{"features", words_of(options.features)},
                 {"frame", options.features.heading_free ? "heading" : "world"},
                 {"modes", options.modes > 0 ? std::to_string(options.modes) : "auto"},
                 {"history", options.history > 0 ? std::to_string(options.history) : "auto"},
                 {"realise", std::string(word_of(options.realisation))}};
  made.figures = {{"segments", static_cast<double>(summary.segments)},
                  {"silhouette", summary.silhouette},
                  {"mean_segment_seconds", summary.mean_segment_seconds}};
  if (std::isfinite(summary.log_likelihood)) made.figures.push_back({"log_likelihood", summary.log_likelihood});
  const bool enough = summary.segments >= kLeastSegments;
  made.usable = {
      enough, enough
                  ? std::to_string(summary.segments) + " segments in " + std::to_string(summary.modes) + " modes"
                  : "only " + std::to_string(summary.segments) + " segments, expected at least 30: record for longer"};
  return made;
}

// Segments in their modes, and how those follow each other.
struct Walked {
  const Motion& motion;
  std::span<const Segment> segments;
  std::span<const std::uint16_t> cluster;
  int modes;
  const ModeChain& chain;
};

// A chain as it is played, and where its segments are from.
struct Realised {
  ChainModel dynamics;
  std::vector<std::uint64_t> origin;
};

std::vector<double> first_order(const ModeChain& chain, int modes) {
  ChainModel model;
  model.modes = modes;
  model.contexts = chain.contexts;
  return model.transitions();
}

Realised stored_chain(const Walked& walked, const ChainOptions& options) {
  SegmentStoreOptions storing = options.store;
  storing.heading_free = options.features.heading_free;
  storing.seed = options.seed;
  storing.blend.share = options.blend_share;
  const auto store = store_segments(walked.motion, walked.segments, walked.cluster, walked.modes, storing);
  Realised out;
  ChainModel& dynamics = out.dynamics;
  dynamics.motion = walked.motion.has_orientation ? ChainMotion::kPose : ChainMotion::kPosition;
  dynamics.heading_free = options.features.heading_free;
  dynamics.modes = walked.modes;
  dynamics.segments = store.segments;
  dynamics.initial = walked.chain.initial;
  dynamics.contexts = walked.chain.contexts;
  dynamics.blend.share = options.blend_share;
  for (std::size_t source : store.source) out.origin.push_back(source + walked.segments[source].piece);
  return out;
}

Result<Realised> chain_of_systems(const Walked& walked, const ChainOptions& options) {
  const bool linear = options.realisation == Realisation::kLinear;
  auto systems = fit_mode_systems(walked.motion, walked.segments, walked.cluster, walked.modes,
                                  {.degree = linear ? 1 : 2, .noisy = linear});
  if (!systems) return systems.error();
  ChainOptions few = options;
  few.store.most_bytes = 1;  // one for each mode, with which lives begin
  few.store.breadth = 0;
  Realised out = stored_chain(walked, few);
  out.dynamics.systems = std::move(*systems);
  return out;
}

Result<Realised> realised_chain(const Walked& walked, const ChainOptions& options) {
  if (options.realisation == Realisation::kLinear || options.realisation == Realisation::kOde) {
    return chain_of_systems(walked, options);
  }
  Realised out;
  if (options.realisation == Realisation::kChain) {
    const auto parts =
        mode_parts(walked.motion, walked.segments, walked.cluster, walked.modes, options.features, options.seed);
    if (!parts) return parts.error();
    const auto told = sequences_of(parts->segments, parts->cluster);
    // Twice as many kinds: tables of what joins what are as large with half of the followers.
    const int history = options.history > 0 ? options.history : kMostPartHistory;
    const ModeChain chain = estimate_chain(told, parts->modes, {.history = history, .back_off = options.history == 0},
                                           weights_of(walked.motion, parts->segments));
    ChainOptions fewer = options;
    fewer.store.breadth = (options.store.breadth + 1) / 2;
    out = stored_chain({walked.motion, parts->segments, parts->cluster, parts->modes, chain}, fewer);
  } else {
    out = stored_chain(walked, options);
  }
  if (options.realisation == Realisation::kSpline) realise_as_splines(out.dynamics);
  out.dynamics.drift = drift_of(out.dynamics, walked.motion.rate_hz);
  return out;
}

}  // namespace

std::vector<Recording> single_episodes(std::span<const Recording> recordings) {
  std::vector<Recording> single;
  for (const Recording& recording : recordings) {
    for (const Episode& episode : episodes(recording)) single.push_back(slice(recording, episode.begin, episode.end));
  }
  return single;
}

Result<ChainFit> learn_chain(std::span<const Recording> recordings, const ChainOptions& options) {
  if (auto ok = check_options(options); !ok) return ok.error();
  auto data = cut(recordings, options);
  if (!data) return data.error();
  const std::span<const Segment> segments = data->segmentation.segments;
  auto table = segment_features(data->motion, segments, options.features);
  if (!table) return table.error();

  const std::size_t pieces = data->motion.pieces.size();
  auto told_pieces = static_cast<std::size_t>(std::ceil(static_cast<double>(pieces) * (1 - options.holdout)));
  if (learned_segments(*data, told_pieces) == 0) told_pieces = pieces;
  const std::size_t learned = learned_segments(*data, told_pieces);
  const auto modes = sorted_best(*table, learned, segments, options);
  if (!modes) return modes.error();

  ChainFit fit;
  ChainSummary& summary = fit.summary;
  summary.modes = static_cast<int>(modes->found.sizes.size());
  const auto told = sequences_of(segments.first(learned), std::span(modes->cluster).first(learned));
  auto judged = sequences_of(segments.subspan(learned), std::span(modes->cluster).subspan(learned));
  if (judged.empty()) judged = told;
  const ModeChainOptions order = order_of(told, summary.modes, options.history);
  const ModeChain chain = estimate_chain(told, summary.modes, order, weights_of(data->motion, segments.first(learned)));
  const Walked walked{data->motion, segments.first(learned), std::span(modes->cluster).first(learned), summary.modes,
                      chain};
  auto realised = realised_chain(walked, options);
  if (!realised) return realised.error();
  ChainModel& dynamics = realised->dynamics;

  summary.segments = learned;
  summary.kinds = dynamics.modes;
  summary.stored = dynamics.segments.size();
  summary.stretches_learned = told_pieces;
  summary.stretches_held_out = pieces - told_pieces;
  summary.mode_sizes = modes->found.sizes;
  summary.history = dynamics.history();
  summary.initial = chain.initial;
  summary.transitions = first_order(chain, summary.modes);
  summary.counts = chain.counts;
  for (const Segment& one : segments.first(learned)) summary.mean_segment_seconds += one.end - one.begin;
  summary.mean_segment_seconds /= static_cast<double>(learned) * data->motion.rate_hz;
  summary.silhouette =
      silhouette(std::span(table->values).first(learned * table->features), table->features, modes->found);
  take_likelihoods(told, judged, summary.modes, chain, summary);
  summary.warnings = data->motion.warnings;
  summary.warnings.insert(summary.warnings.end(), data->segmentation.warnings.begin(),
                          data->segmentation.warnings.end());

  fit.origin = std::move(realised->origin);
  for (std::size_t k = 0; k < pieces; ++k) {
    const MotionPiece& piece = data->motion.pieces[k];
    auto part = slice(recordings[piece.recording], piece.first_row, piece.first_row + piece.rows());
    (k < told_pieces ? fit.learned : fit.held_out).push_back(std::move(part));
  }
  fit.model.name = options.name;
  fit.model.rate_hz = data->motion.rate_hz;
  fit.model.outputs = outputs_of(data->motion);
  fit.model.dynamics = std::move(dynamics);
  if (data->motion.has_orientation) {
    fit.model.view = PoseView{options.half_width, options.half_length};
  } else {
    fit.model.view = PositionView{options.half_width};
  }
  fit.model.training = training_of(recordings, options, summary);
  if (auto ok = check(fit.model); !ok) return ok.error();
  return fit;
}

}  // namespace wisp
