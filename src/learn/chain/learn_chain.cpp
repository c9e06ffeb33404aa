// Learns and judges a chain from recordings: sorting, fit, fidelity, gusts, verdict.

#include <cmath>
#include <cstdint>
#include <set>
#include <string>

#include "base/hash.hpp"
#include "learn/chain/chain_fidelity.hpp"
#include "learn/chain/chain_fit.hpp"
#include "learn/chain/gusts/gust_play.hpp"
#include "learn/chain/learn_chain.hpp"
#include "record/number_text.hpp"
#include "record/verdict.hpp"
#include "wisp/model/file.hpp"

namespace wisp {
namespace chain {
namespace {

constexpr double kMaxSpeed = 100;                 // m/s: a faster mean speed suggests positions in millimetres
constexpr std::size_t kVerbatimSegments = 20000;  // length of the play that is searched for copied stretches

// Sets the recipe's half axes, if it has none, to half of the full axes in the recording's attribute.
Result<void> take_size(const Recording& first, ChainRecipe& recipe) {
  if (recipe.half_width > 0 || recipe.half_length > 0) return {};
  const auto size = numbers_attribute(first, "leaf_length_width_density");
  if (!size) return size.error();
  if (!*size || (*size)->size() < 2) return {};
  recipe.half_width = (**size)[0] / 2;
  recipe.half_length = (**size)[1] / 2;
  if (recipe.half_width > 0 && recipe.half_length > 0) return {};
  return Error{first.source + ": \"# leaf_length_width_density\" begins with " + number_text((**size)[0], 3) + " " +
               number_text((**size)[1], 3) + ", expected a length and a width above 0, in metres"};
}

// Adds the first recording's name to a learning error that does not begin with a recording's name.
Error about(std::span<const Recording> recordings, const Error& error) {
  if (error.message == kStopped) return error;
  for (const Recording& recording : recordings) {
    if (error.message.starts_with(recording.source)) return error;
  }
  return {recordings.front().source + ": " + error.message};
}

// Hash of all samples of an episode. Two different episodes collide with a probability below 1e-19.
std::uint64_t hash_of(const Recording& recording, const Episode& episode) {
  std::uint64_t hash = hash_bytes({});
  for (const Channel& channel : recording.channels) {
    hash = hash_bytes(std::as_bytes(std::span(channel.samples).subspan(episode.begin, episode.size())), hash);
  }
  return hash;
}

// Reports episodes that repeat another row by row. If all episodes are equal, declares the model unusable.
void take_repeats(std::span<const Recording> falls, Fit& fit) {
  std::size_t count = 0;
  std::set<std::uint64_t> different;
  for (const Recording& recording : falls) {
    for (const Episode& episode : episodes(recording)) {
      ++count;
      different.insert(hash_of(recording, episode));
    }
  }
  const std::size_t repeated = count - different.size();
  if (repeated == 0) return;
  fit.report.sections.front().entries.push_back({"repeated_episodes", repeated, "episodes that repeat another", ""});
  fit.report.warnings.push_back(falls.front().source + ": " + std::to_string(repeated) + " of " +
                                std::to_string(count) +
                                " episodes repeat another row by row, expected each once: fidelity to what was held "
                                "out says little");
  if (different.size() > 1) return;
  fit.model.training.usable = {false,
                               "all " + std::to_string(count) + " episodes are the same: record falls that differ"};
}

// Mean speed of all rows, metres a second.
double mean_speed(std::span<const Recording> recordings) {
  const auto motion = motion_of(recordings);
  if (!motion) return 0;
  double sum = 0, rows = 0;
  for (const MotionPiece& piece : motion->pieces) {
    for (const Triple& v : piece.velocity) sum += std::hypot(v[0], v[1], v[2]);
    rows += static_cast<double>(piece.rows());
  }
  return sum / rows;
}

void judge_speed(std::span<const Recording> falls, Usable& usable) {
  const double speed = mean_speed(falls);
  if (!usable.verdict || speed <= kMaxSpeed) return;
  usable = {false, falls.front().source + " moves at " + number_text(speed, 3) +
                       " m/s on average: give positions in metres, not in millimetres"};
}

// Judges the fidelity to the held-out stretches or, without any, to the training stretches.
void judge(const ChainFit& found, const ChainRecipe& recipe, Fit& fit) {
  const ChainFidelityOptions judging{
      .segmentation = segmentation_of(recipe), .smooth_rows = recipe.smooth_rows, .seed = recipe.seed};
  const auto fidelity = chain_fidelity(fit.model, found.held_out.empty() ? found.learned : found.held_out, judging);
  if (!fidelity) {
    fit.report.warnings.push_back("fidelity was not measured: " + fidelity.error().message);
    fit.report.add("").entries.push_back({"fidelity", {}, "", ""});
    return;
  }
  const double verbatim = longest_verbatim_seconds(fit.model, found.origin, kVerbatimSegments, recipe.seed);
  const bool has_orientation = std::holds_alternative<PoseView>(fit.model.view);
  fit.report.sections.push_back(fidelity_section(*fidelity, has_orientation));
  fit.report.sections.back().entries.push_back(
      {"fidelity.verbatim_seconds", verbatim, "longest stretch copied from one recording", "s"});
  add_figures(*fidelity, fit.model.training);
  fit.model.training.figures.push_back({"verbatim_seconds", verbatim});
  Usable& usable = fit.model.training.usable;
  if (!usable.verdict) return;
  if (const auto reason = fault_of(*fidelity)) {
    usable = {false, *reason};
  } else if (const Judged by = judged_by(*fidelity); !by.unjudged.empty()) {
    usable.reason += "; how they play was not judged " + by.unjudged + ": too few falls were held out, or too short";
  }
}

// Learns the response to gusts from a windy recording and a calm one that differs only in its wind.
Result<void> take_gusts(std::span<const Recording> paired, std::uint64_t seed, Fit& fit) {
  if (paired.empty()) return {};
  const auto pairs = gust_pairs(paired[0], paired[1]);
  if (!pairs) return pairs.error();
  const std::size_t told = pairs->gusts() * 3 / 5;  // number of gusts to learn from; the model is judged on the others
  auto gusts = learn_gusts(*pairs, told);
  if (!gusts) return gusts.error();
  std::get<ChainModel>(fit.model.dynamics).gust = gusts->response;
  fit.model.inputs = std::move(gusts->inputs);
  Training& training = fit.model.training;
  training.inputs.assign(fit.model.inputs.size(), {});  // not scaled: m/s
  for (const Recording& one : paired) training.sources.push_back(one.source);
  if (const auto sound = check(fit.model); !sound) {
    return Error{pairs->source + ": " + sound.error().message + " from more gusts than its " + std::to_string(told)};
  }
  const auto play = play_gusts(fit.model, *pairs, told, seed);
  if (!play) return play.error();
  fit.report.sections.push_back(gusts_section(play->figures));
  fit.report.sections.back().entries.push_back({"gusts.learned", told, "gusts learned from", ""});
  training.figures.push_back({"gust_fit_percent", play->figures.fit_percent});
  training.figures.push_back({"gust_direction_degrees", play->figures.direction.median});
  return {};
}

}  // namespace
}  // namespace chain

Result<Fit> learn_chain(std::span<const Recording> recordings, const ChainRecipe& recipe, const Progress& progress) {
  if (recordings.empty()) return Error{"there are no recordings to learn a chain from"};
  const auto data = chain::sorted_recordings(recordings);
  if (!data) return data.error();
  if (data->falls.empty()) {
    return Error{data->paired.front().source + ": is one of a pair, which only tells what wind does; expected " +
                 "recordings of calm falls beside it"};
  }
  ChainRecipe sized = recipe;
  if (auto ok = chain::take_size(data->falls.front(), sized); !ok) return ok.error();
  auto found = chain::fit_chain(data->falls, sized, progress);
  if (!found) return chain::about(data->falls, found.error());
  Fit fit{std::move(found->model), {}};
  fit.report.warnings = found->summary.warnings;
  fit.report.sections.push_back(chain::segments_section(found->summary));
  fit.report.sections.front().entries.push_back({"seed", static_cast<std::int64_t>(recipe.seed), "", ""});
  chain::take_repeats(data->falls, fit);
  chain::judge_speed(data->falls, fit.model.training.usable);
  if (!go_on(progress, "judging falls", 0)) return Error{std::string(kStopped)};
  chain::judge(*found, sized, fit);
  if (!go_on(progress, "learning gusts", 0)) return Error{std::string(kStopped)};
  if (auto ok = chain::take_gusts(data->paired, recipe.seed, fit); !ok) return ok.error();
  Usable& usable = fit.model.training.usable;
  if (const auto why = refused_by_capture(data->falls)) usable = {false, *why};
  fit.report.verdict = {usable.verdict, usable.reason};
  return fit;
}

}  // namespace wisp
