#include "reports/validate_chain.hpp"

#include <algorithm>
#include <cmath>

#include "films/leaf_film.hpp"
#include "flags/recordings.hpp"
#include "reports/chain_figures.hpp"
#include "reports/chain_json.hpp"
#include "reports/chain_recordings.hpp"
#include "reports/validate_gusts.hpp"
#include "wisp/learn/chain_fidelity.hpp"

namespace wisp::cli {
namespace {

// How the model's motion was cut when it was learned.
Result<SegmentationOptions> segmentation_of(const Model& model) {
  SegmentationOptions options;
  if (!model.training.motion) return Error{model.name + ": does not say how its motion was cut; learn it again"};
  auto event = parse_event(model.training.motion->event);
  if (!event) return event.error();
  options.event = std::move(*event);
  options.least_seconds = model.training.motion->min_seconds;
  options.debounce = model.training.motion->debounce;
  return options;
}

int smooth_rows_of(const Model& model) { return model.training.motion ? model.training.motion->smooth_rows : 0; }

// Falls of the model one after another in one recording, an episode each.
Recording together(const std::vector<Recording>& falls) {
  Recording all = falls.front();
  all.episode_ids.assign(all.rows(), 0);
  for (std::size_t k = 1; k < falls.size(); ++k) {
    for (std::size_t channel = 0; channel < all.channels.size(); ++channel) {
      const auto& more = falls[k].channels[channel].samples;
      all.channels[channel].samples.insert(all.channels[channel].samples.end(), more.begin(), more.end());
    }
    all.episode_ids.resize(all.rows(), static_cast<std::int64_t>(k));
  }
  return all;
}

// Recorded falls on the left, the model's on the right.
Result<void> film(const Model& model, const Recording& real, const Arguments& arguments, Terminal& terminal) {
  if (!arguments.has("film")) return {};
  const auto* pose = std::get_if<PoseView>(&model.view);
  if (!pose) return Error{"--film is for poses; this model has positions only"};
  LeafFilmOptions options;
  if (pose->half_width > 0 && pose->half_length > 0) {
    options.style.length = static_cast<float>(2 * pose->half_width);
    options.style.width = static_cast<float>(2 * pose->half_length);
  }
  const auto all = episodes(real);
  const auto count = std::min(all.size(), static_cast<std::size_t>(options.most_leaves));
  std::size_t rows = 0;
  for (const Episode& episode : all) rows = std::max(rows, episode.size());
  const auto falls =
      synthesize_falls(model, static_cast<int>(count), rows, static_cast<std::uint64_t>(arguments.integer("seed")));
  if (!falls) return falls.error();
  const Recording made = together(*falls);
  const LeafPanel panels[] = {{&real, "recorded"}, {&made, "synthesized"}};
  if (auto ok = write_leaf_films(arguments.text("film"), panels, options, terminal); !ok) return ok;
  terminal.say("wrote " + arguments.text("film"));
  return {};
}

}  // namespace

Result<void> validate_chain(const Model& model, const Arguments& arguments, Terminal& terminal) {
  for (const char* flag : {"overlay", "film-strip", "clip"}) {
    if (arguments.has(flag)) {
      return Error{"--" + std::string(flag) + " is for outlines; this model is a segment chain (--film films falls)"};
    }
  }
  auto whole = read_table(arguments.positionals()[1], arguments);
  if (!whole) return whole.error();
  auto recording = in_range(std::move(*whole), arguments, "range");
  if (!recording) return recording.error();
  if (arguments.has("film")) {
    if (auto ok = check_film_name(arguments.text("film")); !ok) return ok;
  }
  if (find_attribute(*recording, "pair")) return validate_gusts(model, std::move(*recording), arguments, terminal);
  if (arguments.positionals().size() > 2) {
    return Error{recording->source + ": is not one of a pair (it has no attribute pair), expected no twin beside it"};
  }
  if (auto ok = check_motion(*recording); !ok) return ok;
  auto segmentation = segmentation_of(model);
  if (!segmentation) return segmentation.error();
  const ChainFidelityOptions options{.segmentation = std::move(*segmentation),
                                     .smooth_rows = smooth_rows_of(model),
                                     .seed = static_cast<std::uint64_t>(arguments.integer("seed"))};
  const std::vector<Recording> real = {std::move(*recording)};
  const auto fidelity = chain_fidelity(model, real, options);
  if (!fidelity) return fidelity.error();
  if (std::isnan(fidelity->energy_distance.value)) {
    terminal.warn(real.front().source + ": its stretches are shorter than " + shown(fidelity->window_seconds) +
                  " s, expected longer ones: how like the falls are was not measured");
  }
  terminal.result()["rows"] = real.front().rows();
  terminal.result()["channels"] = Json::array();
  terminal.result()["fidelity"] = fidelity_json(*fidelity);
  terminal.result()["join_defect"] = join_defect_json(fidelity->join_defect);
  say_fidelity(*fidelity, terminal);
  if (auto ok = film(model, real.front(), arguments, terminal); !ok) return ok;
  if (!arguments.has("figures")) return {};
  if (auto ok = write_chain_figures(arguments.text("figures"), model, real, options); !ok) return ok;
  terminal.say("wrote figures to " + arguments.text("figures"));
  return {};
}

}  // namespace wisp::cli
