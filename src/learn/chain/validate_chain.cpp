// A chain against recordings that it has not seen: falls, or gusts and their calm twins.

#include <algorithm>
#include <cmath>
#include <string>

#include "learn/chain/chain_fidelity.hpp"
#include "learn/chain/chain_recordings.hpp"
#include "learn/chain/chain_report.hpp"
#include "learn/chain/fall_tracks.hpp"
#include "learn/chain/gusts/gust_report.hpp"
#include "learn/chain/learn_chain.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace chain {
namespace {

// How the model's motion was cut when it was learned.
Result<ChainFidelityOptions> judging_of(const Model& model, std::uint64_t seed) {
  if (!model.training.motion) return Error{model.name + ": does not say how its motion was cut; learn it again"};
  const MotionTraining& motion = *model.training.motion;
  auto event = parse_event(motion.event);
  if (!event) return event.error();
  return ChainFidelityOptions{.segmentation = {std::move(*event), motion.min_seconds, motion.debounce},
                              .smooth_rows = motion.smooth_rows,
                              .seed = seed};
}

ReportSection counts_of(std::size_t rows) {
  return {"", {{"rows", rows, "rows", ""}, {"channels", ReportList{}, "", ""}}};
}

ReportVerdict likeness_of(const Judged& by) {
  if (by.judged.empty()) {
    return {false, "the recorded falls are too few or too short to judge by: record more, of two seconds or longer"};
  }
  if (by.unjudged.empty()) return {true, "its falls are like the recorded ones"};
  return {true, "its falls are like the recorded ones " + by.judged + "; these are too few or too short to judge " +
                    by.unjudged};
}

Result<Report> validate_falls(const Model& model, std::span<const Recording> falls, std::uint64_t seed,
                              const Progress& progress) {
  const auto options = judging_of(model, seed);
  if (!options) return options.error();
  const auto fidelity = chain_fidelity(model, falls, *options);
  if (!fidelity) return fidelity.error();
  if (!go_on(progress, "playing falls", 0.5)) return Error{std::string(kStopped)};
  auto tracks = fall_tracks(model, falls, *options);
  if (!tracks) return tracks.error();
  Report report;
  if (fidelity->windows == 0) {
    report.warnings.push_back(falls.front().source + ": its stretches are shorter than " +
                              number_text(fidelity->window_seconds, 3) +
                              " s, expected longer ones: how like the falls are was not measured");
  }
  const auto fault = fault_of(*fidelity);
  report.verdict = fault ? ReportVerdict{false, *fault} : likeness_of(judged_by(*fidelity));
  std::size_t rows = 0;
  for (const Recording& fall : falls) rows += fall.rows();
  report.sections = {counts_of(rows), fidelity_section(*fidelity, std::holds_alternative<PoseView>(model.view)),
                     std::move(*tracks)};
  return report;
}

Result<Report> validate_gusts(const Model& model, const Recording& windy, const Recording& calm, std::uint64_t seed) {
  const auto play = play_gusts(model, windy, calm, {.seed = seed});
  if (!play) return play.error();
  Report report;
  report.sections = {counts_of(windy.rows()), gusts_section(play->figures)};
  report.sections.front().entries.push_back({"fidelity", {}, "", ""});  // clones are no falls of their own
  for (std::size_t k = 0; k < play->scenes.size(); ++k) {
    report.sections.push_back(scene_section(play->scenes[k], k));
  }
  return report;
}

}  // namespace
}  // namespace chain

Result<Report> validate_chain(const Model& model, std::span<const Recording> recordings, std::uint64_t seed,
                              const Progress& progress) {
  if (recordings.empty()) return Error{"there are no recordings to judge a chain on"};
  if (!std::holds_alternative<ChainModel>(model.dynamics)) return Error{model.name + ": is not a segment chain"};
  if (!go_on(progress, "judging falls", 0)) return Error{std::string(kStopped)};
  const auto unpaired = std::find_if(recordings.begin(), recordings.end(),
                                     [](const Recording& one) { return !find_attribute(one, "pair"); });
  if (unpaired != recordings.end() && std::any_of(recordings.begin(), recordings.end(), [](const Recording& one) {
        return find_attribute(one, "pair").has_value();
      })) {
    return Error{unpaired->source + ": is not one of a pair (it has no attribute pair), expected no pair beside it"};
  }
  const auto data = chain::sorted_recordings(recordings);
  if (!data) return data.error();
  if (data->paired.empty()) return chain::validate_falls(model, data->falls, seed, progress);
  return chain::validate_gusts(model, data->paired[0], data->paired[1], seed);
}

}  // namespace wisp
