#include "studies/flame/flame_judge.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "learn/fidelity/fidelity.hpp"
#include "learn/flame/blow_outs.hpp"
#include "learn/outline/outline_figures.hpp"
#include "learn/outline/outline_inputs.hpp"
#include "learn/outline/outline_shape.hpp"
#include "learn/outline/outline_synthesis.hpp"
#include "learn/outline/outline_units.hpp"
#include "studies/flame/flame_fidelity.hpp"
#include "studies/value_or_abort.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/cost.hpp"

namespace wisp::verify {
namespace {

std::vector<std::string> output_names(const FlameUnits& units) { return outline_outputs(units.knots.size() - 4); }

/// Outputs go missing where the recording has none: what is not seen there is not judged.
Recording hidden_as(Recording played, const Recording& recorded, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    auto& samples = played.channels[*find_channel(played, name)].samples;
    const auto& seen = recorded.channels[*find_channel(recorded, name)].samples;
    for (std::size_t row = 0; row < samples.size(); ++row) {
      if (std::isnan(seen[row])) samples[row] = std::nan("");
    }
  }
  return played;
}

std::vector<double> control_points(const Recording& clip, const std::vector<std::string>& names, std::size_t row) {
  std::vector<double> out;
  for (const std::string& name : names) out.push_back(clip.channels[*find_channel(clip, name)].samples[row]);
  return out;
}

double tip_fit(const Recording& recorded, const Recording& played, const FlameUnits& units) {
  const auto names = output_names(units);
  const OutlineCurve curve(units.knots);
  std::vector<double> measured, found;
  for (std::size_t row = 0; row < recorded.rows(); ++row) {
    const auto seen = control_points(recorded, names, row);
    if (std::isnan(seen.front())) continue;
    measured.push_back(tip_of(curve.polyline(seen))[0]);
    found.push_back(tip_of(curve.polyline(control_points(played, names, row)))[0]);
  }
  return fit_percent(measured, found);
}

Fidelity compared(const std::vector<Recording>& recorded, const std::vector<Recording>& played,
                  const FlameUnits& units) {
  return value_or_abort(fidelity(recorded, played, {.channels = output_names(units)}));
}

/// Where the figures of one wind go.
class Sheet {
 public:
  Sheet(const std::filesystem::path& folder, const FlameUnits& units)
      : units_(units), figures_(open(folder, "figures.csv")), windows_(open(folder, "windows.csv")) {}

  void windows(const std::string& side, const std::vector<Recording>& clips) {
    for (std::size_t clip = 0; clip < clips.size(); ++clip) {
      write_windows(windows_, side, clip, as_seen(clips[clip], units_.knots));
    }
  }

  void line(const std::string& name, const std::array<double, 3>& fidelity, const std::string& rest) {
    char text[256];
    std::snprintf(text, sizeof text, "%s,%.4f,%.2f,%.3f,%s", name.c_str(), fidelity[0], fidelity[1], fidelity[2],
                  rest.c_str());
    figures_ << text << '\n' << std::flush;
    std::printf("  %s\n", text);
  }

 private:
  static std::ofstream open(const std::filesystem::path& folder, const char* name) {
    std::filesystem::create_directories(folder);
    return std::ofstream(folder / name);
  }

  const FlameUnits& units_;
  std::ofstream figures_;
  std::ofstream windows_;
};

std::vector<Recording> in_units(const std::vector<Recording>& clips, const FlameUnits& units) {
  std::vector<Recording> out;
  for (const Recording& clip : clips) out.push_back(units(clip));
  return out;
}

void judge(const FlamePlayer& player, const std::vector<Recording>& recorded, const FlameUnits& units, Sheet& sheet) {
  const auto names = output_names(units);
  std::vector<Recording> played;
  double tip = 0;
  for (std::size_t clip = 0; clip < recorded.size(); ++clip) {
    played.push_back(hidden_as(player.play(recorded[clip], true, clip + 1), recorded[clip], names));
    if (player.hears_wind) tip += tip_fit(recorded[clip], player.play(recorded[clip], false, clip + 1), units);
  }
  const Fidelity found = compared(recorded, played, units);
  char rest[96];
  char fit[16] = "none";
  if (player.hears_wind) std::snprintf(fit, sizeof fit, "%.1f", tip / static_cast<double>(recorded.size()));
  std::snprintf(rest, sizeof rest, "%s,%lld,%zu", fit, static_cast<long long>(player.operations), player.bytes);
  sheet.line(player.name, {found.energy_distance.value, found.log_spectral_distance.value, found.tails.value}, rest);
  sheet.windows(player.name, played);
}

void judge_bounds(const std::vector<Recording>& recorded, const std::vector<Recording>& again, const FlameUnits& units,
                  Sheet& sheet) {
  const Fidelity found = compared(recorded, again, units);
  sheet.line("floor", {found.energy_distance.value, found.log_spectral_distance.value, found.tails.value}, ",,");
  sheet.line("ceiling", {found.energy_distance.ceiling, found.log_spectral_distance.ceiling, found.tails.ceiling},
             ",,");
  sheet.windows("recorded", recorded);
  sheet.windows("again", again);
}

/// A flame in decay or re-ignition is no measure of how high a flame is.
Recording burning_part(const Recording& clip, std::span<const OutlineInput> inputs) {
  if (inputs.empty()) return clip;
  return without_blow_outs(clip, value_or_abort(find_blow_outs(clip, inputs.front().name)));
}

}  // namespace

Recording FlameUnits::operator()(const Recording& clip) const {
  const auto layout = value_or_abort(outline_layout(clip));
  const std::span<const OutlineInput> inputs(wind ? &*wind : nullptr, wind ? 1 : 0);
  const Recording burning = burning_part(clip, inputs);
  const double unit = resting_height_pixels(burning, layout, inputs);
  if (!(unit > 0)) {
    std::fprintf(stderr, "%s: has no outline\n", clip.source.c_str());
    std::abort();
  }
  Recording out = to_model_units(clip, layout, unit);
  for (const OutlineInput& input : inputs) {
    for (double& value : out.channels[*find_channel(out, input.name)].samples) value /= input.scale;
  }
  return out;
}

FlameUnits flame_units(std::span<const Recording> clips) {
  FlameUnits out{value_or_abort(outline_layout(clips.front())).knots, {}};
  if (find_channel(clips.front(), "wind")) out.wind = value_or_abort(scaled_input(clips, "wind"));
  return out;
}

std::int64_t view_operations(const Model& model) { return value_or_abort(count_operations(model)).view_operations; }

FlamePlayer player_of(const std::string& name, const Model& model) {
  FlamePlayer out{.name = name};
  out.play = [model](const Recording& along, bool chance, std::uint64_t seed) {
    return value_or_abort(
               synthesize(model, {.rows = along.rows(), .noise = chance ? 1.0F : 0.0F, .seed = seed, .input = &along}))
        .recording;
  };
  out.hears_wind = !model.inputs.empty();
  out.operations = value_or_abort(count_operations(model)).operations_per_frame;
  out.bytes = value_or_abort(model_bytes(model)).size();
  return out;
}

void judge_players(const UnseenFlames& unseen, const FlameUnits& units, std::span<const FlamePlayer> players,
                   const std::filesystem::path& folder) {
  std::printf("\n%s: %zu clips; energy distance, log-spectral dB, speeds sd, tip's fit %%, operations, bytes\n",
              unseen.wind.c_str(), unseen.clips.size());
  const auto recorded = in_units(unseen.clips, units);
  Sheet sheet(folder / unseen.wind, units);
  judge_bounds(recorded, in_units(unseen.again, units), units, sheet);
  for (const FlamePlayer& player : players) judge(player, recorded, units, sheet);
}

}  // namespace wisp::verify
