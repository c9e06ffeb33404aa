#include "reports/validate_chain.hpp"

#include <algorithm>
#include <filesystem>

#include "films/leaf_film.hpp"
#include "flags/motion_flags.hpp"
#include "flags/recordings.hpp"
#include "reports/chain_figures.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::cli {
namespace {

// Falls of the model, an episode each.
Result<Recording> played(const Model& model, std::size_t falls, std::size_t rows, std::uint64_t seed) {
  auto bank = Bank::create(model, {.capacity = static_cast<int>(falls), .seed = seed});
  if (!bank) return bank.error();
  Recording all;
  all.source = "synthesized";
  all.rate_hz = model.rate_hz;
  for (const Output& output : model.outputs) {
    all.channels.push_back({output.name, output.unit, Role::kOutput, std::vector<double>(falls * rows)});
  }
  for (std::size_t fall = 0; fall < falls; ++fall) {
    bank->spawn();
    all.episode_ids.insert(all.episode_ids.end(), rows, static_cast<std::int64_t>(fall));
  }
  std::vector<float> outputs(falls * model.outputs.size());
  for (std::size_t row = 0; row < rows; ++row) {
    if (row > 0) bank->step();
    bank->outputs(outputs);
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      all.channels[k % model.outputs.size()].samples[k / model.outputs.size() * rows + row] = outputs[k];
    }
  }
  return all;
}

// Recorded falls on the left, the model's on the right.
Result<void> film(const Model& model, const Recording& real, const Arguments& arguments, Terminal& terminal) {
  const auto* pose = std::get_if<PoseView>(&model.view);
  if (!pose) return Error{"--film is for poses; this model has positions only"};
  LeafFilmOptions options;
  if (pose->half_width > 0 && pose->half_length > 0) {
    options.style.length = static_cast<float>(2 * pose->half_width);
    options.style.width = static_cast<float>(2 * pose->half_length);
  }
  const auto all = episodes(real);
  std::size_t rows = 0;
  for (const Episode& episode : all) rows = std::max(rows, episode.size());
  const auto made = played(model, std::min(all.size(), static_cast<std::size_t>(options.max_leaves)), rows,
                           static_cast<std::uint64_t>(arguments.integer("seed")));
  if (!made) return made.error();
  const LeafPanel panels[] = {{&real, "recorded"}, {&*made, "synthesized"}};
  if (auto ok = write_leaf_films(arguments.text("film"), panels, options, terminal); !ok) return ok;
  terminal.say("wrote " + arguments.text("film"));
  return {};
}

Result<void> check_flags(const Arguments& arguments) {
  for (const char* flag : {"overlay", "film-strip", "clip"}) {
    if (arguments.has(flag)) {
      return Error{"--" + std::string(flag) + " is for outlines; this model is a segment chain (--film films falls)"};
    }
  }
  return arguments.has("film") ? check_film_name(arguments.text("film")) : Result<void>();
}

// The recording, and its twin that differs only in its wind: the second that was given, or REC.calm.csv beside REC.csv.
Result<std::vector<Recording>> read_recordings(const Arguments& arguments, double rate_hz) {
  const auto& paths = arguments.positionals();
  auto whole = read_table(paths[1], arguments, motion_table(arguments, rate_hz));
  if (!whole) return whole.error();
  auto recording = in_range(std::move(*whole), arguments, "range");
  if (!recording) return recording.error();
  std::vector<Recording> all;
  all.push_back(std::move(*recording));
  std::string twin = paths.size() > 2 ? paths[2] : "";
  if (find_attribute(all.front(), "pair") && twin.empty()) {
    twin = std::filesystem::path(paths[1]).replace_extension(".calm.csv").string();
    if (!std::filesystem::exists(twin)) {
      return Error{all.front().source + ": is one of a pair, and there is no " + twin +
                   ", expected its twin as a third argument"};
    }
  }
  if (twin.empty()) return all;
  auto other = read_table(twin, arguments, motion_table(arguments, rate_hz));
  if (!other) return other.error();
  all.push_back(std::move(*other));
  return all;
}

}  // namespace

Result<void> validate_chain(const Model& model, const Arguments& arguments, Terminal& terminal) {
  if (auto ok = check_flags(arguments); !ok) return ok;
  const auto recordings = read_recordings(arguments, model.rate_hz);
  if (!recordings) return recordings.error();
  const ValidationOptions options{.seed = static_cast<std::uint64_t>(arguments.integer("seed"))};
  const auto report = validate(model, *recordings, options, terminal.progress());
  if (!report) return report.error();
  terminal.show(*report);
  if (arguments.has("film")) {
    if (auto ok = film(model, recordings->front(), arguments, terminal); !ok) return ok;
  }
  if (!arguments.has("figures")) return {};
  if (auto ok = write_chain_figures(arguments.text("figures"), *report); !ok) return ok;
  terminal.say("wrote figures to " + arguments.text("figures"));
  return {};
}

}  // namespace wisp::cli
