#include "learn/chain/chain_fit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "learn/chain/motion/segmentation.hpp"
#include "learn/chain/segments/modes.hpp"
#include "wisp/model/chain.hpp"
#include "wisp/model/file.hpp"

namespace wisp::chain {
namespace {

// ---- Expected displacement of a walk, used for steering ----

constexpr int kRounds = 40;          // horizon in segments, longer than a heading persists
constexpr int kSettlingRounds = 60;  // iterations until visit shares are stationary
constexpr std::size_t kAnyOf = 8;    // maximum successors considered in a mode whose segments are equally probable
constexpr double kMaxStored = 32767;
constexpr double kMinSpread = 1e-9;
constexpr double kMinLead = 1e-6;  // metres: smaller leads are rounding errors

using Complex = std::complex<double>;

struct Way {       // a displacement in metres
  Complex ground;  // x + iy
  double height = 0;
};

struct Next {
  std::size_t segment;
  double probability;
  Complex turn;  // unit complex number: rotation about z that joins the segment
};

class Walk {
 public:
  Walk(const ChainModel& chain, double rate_hz) : chain_(chain), first_(segment_rows(chain.segments)) {
    const auto transitions = chain.transitions();
    for (std::size_t s = 0; s < size(); ++s) {
      seconds_.push_back(chain.segments.steps[s] / rate_hz);
      ways_.push_back(way(s));
      next_.push_back(successors(s, transitions));
    }
  }

  std::size_t size() const { return chain_.segments.size(); }
  double seconds(std::size_t s) const { return seconds_[s]; }
  const Way& stored_way(std::size_t s) const { return ways_[s]; }
  std::span<const Next> next(std::size_t s) const { return next_[s]; }

  // Stationary share of visits of each segment.
  std::vector<double> visits() const {
    std::vector<double> share(size(), 1.0 / static_cast<double>(size()));
    for (int round = 0; round < kSettlingRounds; ++round) {
      std::vector<double> after(size());
      for (std::size_t s = 0; s < size(); ++s) {
        for (const Next& next : next_[s]) after[next.segment] += share[s] * next.probability;
      }
      share = std::move(after);
    }
    return share;
  }

 private:
  const std::int16_t* row(std::size_t s, bool end) const {
    const std::size_t at = end ? first_[s + 1] - 1 : first_[s];
    return chain_.segments.rows.data() + at * static_cast<std::size_t>(channel_count(chain_.motion));
  }

  Way way(std::size_t s) const {
    const std::int16_t* end = row(s, true);
    const double scale = chain_.segments.row_scale[0];
    return {{scale * end[0], scale * end[1]}, scale * end[2]};
  }

  Complex turn(std::size_t from, std::size_t to) const {
    if (!chain_.heading_free) return 1;
    if (chain_.motion == ChainMotion::kPosition) {
      const std::int16_t *a = &chain_.segments.rates[from * 6 + 3], *b = &chain_.segments.rates[to * 6];
      const Complex along = Complex(a[0], a[1]) * std::conj(Complex(b[0], b[1]));
      return std::abs(along) > 0 ? along / std::abs(along) : 1;
    }
    const std::int16_t *p = row(from, true) + 3, *q = row(to, false) + 3;
    const Complex half(1.0 * p[0] * q[0] + 1.0 * p[1] * q[1] + 1.0 * p[2] * q[2] + 1.0 * p[3] * q[3],
                       1.0 * p[3] * q[0] - 1.0 * p[0] * q[3] + 1.0 * p[2] * q[1] - 1.0 * p[1] * q[2]);
    return std::abs(half) > 0 ? half * half / std::norm(half) : 1;
  }

  std::vector<Next> successors(std::size_t s, const std::vector<double>& transitions) const {
    const ChainSegments& segments = chain_.segments;
    const auto modes = static_cast<std::size_t>(chain_.modes), breadth = static_cast<std::size_t>(segments.breadth);
    const auto chance = std::span(transitions).subspan(segments.mode[s] * modes, modes);
    std::vector<Next> out;
    for (std::size_t mode = 0; mode < modes; ++mode) {
      const double probability = chance[mode];
      if (probability == 0) continue;
      std::vector<std::size_t> those;
      if (breadth > 0) {
        const auto best = segments.follow.begin() + static_cast<long>((s * modes + mode) * breadth);
        those.assign(best, best + static_cast<long>(breadth));
      } else {
        const auto [low, high] = std::equal_range(segments.mode.begin(), segments.mode.end(), mode);
        const auto members = static_cast<std::size_t>(high - low), count = std::min(members, kAnyOf);
        for (std::size_t k = 0; k < count; ++k) {
          those.push_back(static_cast<std::size_t>(low - segments.mode.begin()) + (s + k * members / count) % members);
        }
      }
      for (std::size_t to : those) {
        out.push_back({to, probability / static_cast<double>(those.size()), turn(s, to)});
      }
    }
    return out;
  }

  const ChainModel& chain_;
  std::vector<std::uint32_t> first_;
  std::vector<double> seconds_;
  std::vector<Way> ways_;
  std::vector<std::vector<Next>> next_;
};

// Returns each segment's lead: the expected displacement after it minus drift × time. `memory`: seconds to half of it.
std::vector<Way> leads_of(const Walk& walk, const Way& drift, const std::vector<double>& visits, double& memory) {
  std::vector<Way> lead(walk.size());
  std::vector<double> size;  // root mean square over ground after each iteration
  double mean_seconds = 0;
  for (std::size_t s = 0; s < walk.size(); ++s) mean_seconds += visits[s] * walk.seconds(s);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Way> after(walk.size());
    double square = 0;
    for (std::size_t s = 0; s < walk.size(); ++s) {
      for (const Next& next : walk.next(s)) {
        const Way &way = walk.stored_way(next.segment), &beyond = lead[next.segment];
        const double seconds = walk.seconds(next.segment);
        after[s].ground += next.probability * (next.turn * (way.ground + beyond.ground) - drift.ground * seconds);
        after[s].height += next.probability * (way.height + beyond.height - drift.height * seconds);
      }
      square += visits[s] * std::norm(after[s].ground);
    }
    // Heights are determined up to a constant: their mean is set to 0.
    double mean = 0;
    for (std::size_t s = 0; s < walk.size(); ++s) mean += visits[s] * after[s].height;
    for (Way& one : after) one.height -= mean;
    lead = std::move(after);
    size.push_back(std::sqrt(square));
  }
  const auto grown = std::find_if(size.begin(), size.end(), [&](double x) { return x >= 0.5 * size.back(); });
  memory = mean_seconds * static_cast<double>(1 + grown - size.begin());
  return lead;
}

ChainDrift drift_of(const ChainModel& chain, double rate_hz) {
  const Walk walk(chain, rate_hz);
  const auto visits = walk.visits();
  Way way;
  double seconds = 0;
  for (std::size_t s = 0; s < walk.size(); ++s) {
    if (!chain.heading_free) way.ground += visits[s] * walk.stored_way(s).ground;
    way.height += visits[s] * walk.stored_way(s).height;
    seconds += visits[s] * walk.seconds(s);
  }
  const Way drift{way.ground / seconds, way.height / seconds};
  ChainDrift out;
  out.drift = {drift.ground.real(), drift.ground.imag(), drift.height};
  const auto lead = leads_of(walk, drift, visits, out.memory_seconds);
  double most = 0, ground = 0, height = 0;
  for (std::size_t s = 0; s < walk.size(); ++s) {
    for (double x : {lead[s].ground.real(), lead[s].ground.imag(), lead[s].height}) most = std::max(most, std::abs(x));
    for (const Next& next : walk.next(s)) {
      const Way &step = walk.stored_way(next.segment), &beyond = lead[next.segment];
      const double own = walk.seconds(next.segment), weight = visits[s] * next.probability;
      ground += weight * std::norm(next.turn * (step.ground + beyond.ground) - drift.ground * own - lead[s].ground);
      const double up = step.height + beyond.height - drift.height * own - lead[s].height;
      height += weight * up * up;
    }
  }
  out.spread_ground = std::max(ground / 2 / seconds, kMinSpread);
  out.spread_height = std::max(height / seconds, kMinSpread);
  out.lead_scale = std::max(most, kMinLead) / kMaxStored;
  for (const Way& one : lead) {
    for (double x : {one.ground.real(), one.ground.imag(), one.height}) {
      out.lead.push_back(static_cast<std::int16_t>(std::lround(x / out.lead_scale)));
    }
  }
  return out;
}

constexpr int kModesWithoutOrientation = 6;
constexpr std::size_t kMinSegments = 30;  // with fewer, transition counts are not reliable

struct Cut {
  Motion motion;
  Segmentation segmentation;
  std::size_t learned_pieces = 0;    // number of pieces learned from, the first ones; the others are held out
  std::size_t learned_segments = 0;  // number of segments in those pieces

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
  for (const Segment& one : segmentation->segments) {
    if (static_cast<std::size_t>(one.steps) <= kMaxSegmentSteps) continue;
    return Error{recordings[motion->pieces[one.piece].recording].source + ": has " + std::to_string(one.steps) +
                 " rows between two events of " + recipe.event.signal + ", expected at most " +
                 std::to_string(kMaxSegmentSteps) + ": choose another event, or resample to a lower rate"};
  }
  Cut out{std::move(*motion), std::move(*segmentation)};
  const std::size_t pieces = out.motion.pieces.size();
  out.learned_pieces = static_cast<std::size_t>(std::ceil(static_cast<double>(pieces) * (1 - recipe.holdout)));
  if (segments_of(out.segments(), out.learned_pieces) == 0) out.learned_pieces = pieces;
  out.learned_segments = segments_of(out.segments(), out.learned_pieces);
  return out;
}

// Ranges of the outputs. Positions start at the origin, except for a bounded height.
std::vector<Output> outputs_of(const Motion& motion, bool bounded_height) {
  std::vector<Output> outputs;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool bounded = bounded_height && axis == 2;
    const double start = bounded ? motion.pieces.front().position.front()[axis] : 0;
    Output output{std::string("pos.") + "xyz"[axis], "m", start, start};
    for (const MotionPiece& piece : motion.pieces) {
      const double origin = bounded ? 0 : piece.position.front()[axis];
      for (const Triple& at : piece.position) {
        output.lowest = std::min(output.lowest, at[axis] - origin);
        output.highest = std::max(output.highest, at[axis] - origin);
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
    const auto found = std::find(made.sources.begin(), made.sources.end(), recording.source);
    if (found == made.sources.end()) made.sources.push_back(recording.source);
  }
  made.motion = MotionTraining{word_of(recipe.event), recipe.min_seconds, recipe.debounce, recipe.smooth_rows};
  made.recipe = {{"frame", recipe.heading_free ? "heading" : "world"},
                 {"modes", recipe.modes > 0 ? std::to_string(recipe.modes) : "auto"},
                 {"history", std::to_string(recipe.history)},
                 {"realisation", std::string(word_of(recipe.realisation))}};
  made.figures = {{"segments", static_cast<double>(summary.segments)},
                  {"mean_segment_seconds", summary.mean_segment_seconds}};
  if (std::isfinite(summary.silhouette)) made.figures.push_back({"silhouette", summary.silhouette});
  if (std::isfinite(summary.log_likelihood)) made.figures.push_back({"log_likelihood", summary.log_likelihood});
  const bool enough = summary.segments >= kMinSegments;
  made.usable = {enough, enough ? std::to_string(summary.segments) + " segments" +
                                      (summary.modes > 1 ? " in " + std::to_string(summary.modes) + " modes" : "")
                                : "only " + std::to_string(summary.segments) +
                                      " segments, expected at least 30: record for longer"};
  return made;
}

Error too_few_segments(const Recording& first, const Cut& data, const ChainRecipe& recipe) {
  return {first.source + ": has " + std::to_string(data.segments().size()) +
          " segments in all, expected at least as many as modes, " + std::to_string(recipe.modes) + ", among the " +
          std::to_string(data.learned_segments) +
          " that are learned from: record for longer, hold out less, or ask for fewer modes"};
}

// Sorts segments into modes. By default, one mode if orientation is known: joins select the successors. Otherwise
// several, since the best-joining successors are too often short segments, while modes preserve the mean duration.
Result<Modes> modes_of(const Cut& data, const ChainRecipe& recipe) {
  const std::span segments = data.segments();
  if (recipe.modes == 0 && data.motion.has_orientation) {
    return Modes{1, std::vector<std::uint16_t>(segments.size()), {data.learned_segments}, 0};
  }
  const FeatureTable features = segment_features(data.motion, segments, recipe.heading_free);
  const int modes =
      recipe.modes > 0 ? recipe.modes : std::min(kModesWithoutOrientation, static_cast<int>(data.learned_segments));
  return sorted_into_modes(features, data.learned_segments, modes, recipe.seed);
}

// Transition probabilities of modes, and the segments that realise them.
struct FittedWalk {
  ModeChain chain;
  double log_likelihood = 0;  // of the held-out stretches or, without any, of the learned ones
  ChainModel dynamics;
  std::vector<std::uint64_t> origin;  // as in ChainFit
};

ModeChain chain_of(const Cut& data, const Modes& modes, const ChainRecipe& recipe, double& likelihood) {
  const std::size_t learned = data.learned_segments;
  const std::span of(modes.of);
  const auto told = by_stretch(data.segments().first(learned), of.first(learned));
  const auto judged = by_stretch(data.segments().subspan(learned), of.subspan(learned));
  ModeChain chain = counted_chain(told, modes.count, recipe.history);
  likelihood = log_likelihood(chain, judged.empty() ? told : judged);
  return chain;
}

ChainModel stored_chain(const SortedSegments& from, ModeChain chain, const ChainRecipe& recipe,
                        std::vector<std::uint64_t>& origin) {
  const bool bounded_height = height_is_bounded(from.motion, from.segments);
  auto store = store_segments(from, {.heading_free = recipe.heading_free,
                                     .max_bytes = recipe.max_bytes,
                                     .bounded_height = bounded_height,
                                     .breadth = from.motion.has_orientation || bounded_height ? recipe.best_of : 0});
  ChainModel dynamics;
  dynamics.motion = from.motion.has_orientation ? ChainMotion::kPose : ChainMotion::kPosition;
  dynamics.heading_free = recipe.heading_free;
  dynamics.modes = from.modes;
  dynamics.segments = std::move(store.segments);
  dynamics.initial = std::move(chain.initial);
  dynamics.history = chain.history;
  dynamics.probabilities = std::move(chain.probabilities);
  dynamics.blend_steps = static_cast<int>(std::lround(recipe.blend * from.motion.rate_hz));
  dynamics.drift = drift_of(dynamics, from.motion.rate_hz);
  origin.clear();
  for (std::size_t source : store.source) origin.push_back(source + from.segments[source].piece);
  return dynamics;
}

Result<RealisedSegments> realised(const SortedSegments& from, const ChainRecipe& recipe) {
  if (recipe.realisation == Realisation::kSpline) return spline_segments(from, recipe.heading_free);
  if (recipe.realisation == Realisation::kChain) return half_segments(from, recipe.heading_free, recipe.seed);
  return system_segments(from, recipe.realisation == Realisation::kOde ? 2 : 1, recipe.seed);
}

Result<FittedWalk> walk_of(const Cut& data, const Modes& modes, const ChainRecipe& recipe) {
  FittedWalk walk;
  walk.chain = chain_of(data, modes, recipe, walk.log_likelihood);
  const std::size_t learned = data.learned_segments;
  const SortedSegments recorded{data.motion, data.segments().first(learned), std::span(modes.of).first(learned),
                                modes.count};
  if (recipe.realisation == Realisation::kSegments) {
    walk.dynamics = stored_chain(recorded, walk.chain, recipe, walk.origin);
    return walk;
  }
  const auto made = realised(recorded, recipe);
  if (!made) return made.error();
  const bool kinds = recipe.realisation == Realisation::kChain;
  const ModeChain chain =
      kinds ? counted_chain(by_stretch<std::uint16_t>(made->segments, made->mode), made->modes, recipe.history)
            : walk.chain;
  walk.dynamics = stored_chain({made->motion, made->segments, made->mode, made->modes}, chain, recipe, walk.origin);
  return walk;
}

ChainSummary summary_of(const Cut& data, const Modes& modes, const FittedWalk& walk) {
  const std::size_t learned = data.learned_segments;
  ChainSummary summary;
  summary.segments = learned;
  summary.stored = walk.dynamics.segments.size();
  summary.stretches_learned = data.learned_pieces;
  summary.stretches_held_out = data.motion.pieces.size() - data.learned_pieces;
  summary.modes = modes.count;
  summary.mode_sizes = modes.sizes;
  summary.history = walk.chain.history;
  summary.initial = walk.chain.initial;
  const auto count = static_cast<std::size_t>(modes.count);
  summary.transitions.assign(walk.chain.probabilities.begin(),
                             walk.chain.probabilities.begin() + static_cast<long>(count * count));
  for (const Segment& one : data.segments().first(learned)) summary.mean_segment_seconds += one.end - one.begin;
  summary.mean_segment_seconds /= static_cast<double>(learned) * data.motion.rate_hz;
  summary.silhouette = modes.silhouette;
  summary.log_likelihood = walk.log_likelihood;
  summary.warnings = data.motion.warnings;
  const auto& more = data.segmentation.warnings;
  summary.warnings.insert(summary.warnings.end(), more.begin(), more.end());
  return summary;
}

Model model_of(const Motion& motion, ChainModel dynamics, const ChainRecipe& recipe) {
  Model model;
  model.name = recipe.name;
  model.rate_hz = motion.rate_hz;
  model.outputs = outputs_of(motion, !dynamics.segments.height.empty());
  model.dynamics = std::move(dynamics);
  if (motion.has_orientation) {
    model.view = PoseView{recipe.half_width, recipe.half_length};
  } else {
    model.view = PositionView{recipe.half_width};
  }
  return model;
}

}  // namespace

Result<ChainFit> fit_chain(std::span<const Recording> recordings, const ChainRecipe& recipe, const Progress& progress) {
  if (auto ok = check_fields(recipe); !ok) return ok.error();
  if (!go_on(progress, "cutting motion", 0)) return Error{std::string(kStopped)};
  const auto data = cut(recordings, recipe);
  if (!data) return data.error();
  if (!go_on(progress, "sorting segments", 0)) return Error{std::string(kStopped)};
  const std::size_t learned = data->learned_segments;
  if (learned < static_cast<std::size_t>(recipe.modes)) return too_few_segments(recordings.front(), *data, recipe);
  const auto modes = modes_of(*data, recipe);
  if (!modes) return modes.error();
  if (!go_on(progress, "joining segments", 0)) return Error{std::string(kStopped)};
  auto walk = walk_of(*data, *modes, recipe);
  if (!walk) return walk.error();

  ChainFit fit;
  fit.summary = summary_of(*data, *modes, *walk);
  fit.origin = std::move(walk->origin);
  for (std::size_t k = 0; k < data->motion.pieces.size(); ++k) {
    const MotionPiece& piece = data->motion.pieces[k];
    auto part = slice(recordings[piece.recording], piece.first_row, piece.first_row + piece.rows());
    (k < data->learned_pieces ? fit.learned : fit.held_out).push_back(std::move(part));
  }
  fit.model = model_of(data->motion, std::move(walk->dynamics), recipe);
  fit.model.training = training_of(recordings, recipe, fit.summary);
  if (auto ok = check(fit.model); !ok) return ok.error();
  return fit;
}

}  // namespace wisp::chain
