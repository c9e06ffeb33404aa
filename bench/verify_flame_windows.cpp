// What a classifier is given: windows of recorded and synthesized outlines as an eye has them.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "verify_flame.hpp"
#include "wisp/learn/fidelity_energy.hpp"
#include "wisp/learn/outline.hpp"
#include "wisp/learn/outline_shape.hpp"
#include "wisp/learn/outline_synthesis.hpp"
#include "wisp/learn/outline_units.hpp"
#include "wisp/learn/validation.hpp"

namespace wisp::verify {
namespace {

constexpr std::size_t kSeenPoints = 8;
constexpr double kWindowSeconds = 0.5;
constexpr std::size_t kMostWindows = 500;
constexpr std::uint64_t kLearnSeeds[] = {1, 5, 7};
constexpr std::uint64_t kUnseenSeeds[] = {2, 3, 6};
constexpr std::uint64_t kOtherChance = 100;

template <class T>
T value_or_abort(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "%s\n", result.error().message.c_str());
    std::abort();
  }
  return *std::move(result);
}

/// A recording of control points as points at equal lengths along the curve.
Recording as_seen(const Recording& recording, const std::vector<double>& knots) {
  const OutlineLayout layout = value_or_abort(outline_layout(recording));
  const OutlineCurve curve(knots);
  Recording out{.source = recording.source, .rate_hz = recording.rate_hz};
  for (const std::string& name : outline_outputs(kSeenPoints)) out.channels.push_back({name, "", Role::kOutput, {}});
  std::vector<double> control(layout.outputs.size());
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    for (std::size_t k = 0; k < control.size(); ++k) control[k] = recording.channels[layout.outputs[k]].samples[row];
    const bool whole = std::none_of(control.begin(), control.end(), [](double x) { return std::isnan(x); });
    const auto points =
        at_equal_lengths(curve.polyline(whole ? control : std::vector(control.size(), 0.0)), kSeenPoints);
    for (std::size_t k = 0; k < 2 * kSeenPoints; ++k) {
      out.channels[k].samples.push_back(whole ? points[k / 2][k % 2] : std::nan(""));
    }
  }
  return out;
}

void write_side(std::ofstream& out, const char* side, std::size_t clip, const Recording& seen) {
  const auto stretches = value_or_abort(stretches_of(seen, outline_outputs(kSeenPoints)));
  const auto rows = static_cast<std::size_t>(std::lround(kWindowSeconds * seen.rate_hz));
  const std::size_t hop = std::max<std::size_t>(1, total_rows(stretches) / kMostWindows);
  const FeatureWindows windows = thinned(motion_windows(stretches, rows, hop), kMostWindows);
  for (std::size_t k = 0; k < windows.size(); ++k) {
    out << side << ',' << clip << ',' << windows.blocks[k];
    for (double value : windows.window(k)) out << ',' << value;
    out << '\n';
  }
}

/// In the model's units and knots.
Recording in_units(const Recording& unseen, const OutlineFit& fit) {
  const auto layout = value_or_abort(outline_layout(unseen));
  const double unit = value_or_abort(validate_outline(fit.model, unseen, {.fidelity = false})).pixels_per_unit;
  return to_model_units(unseen, layout, unit);
}

Recording played_along(const OutlineFit& fit, const Recording& unseen, std::uint64_t seed) {
  Recording driving = unseen;
  for (double& value : driving.channels[*find_channel(driving, "wind")].samples) {
    value /= fit.summary.inputs.front().scale;
  }
  return value_or_abort(synthesize(fit.model, {.seed = seed, .input = &driving})).recording;
}

/// Means over clips of how like the recording the model is.
void print_fidelity(const OutlineFit& fit, const std::vector<Recording>& clips) {
  double energy = 0, floor = 0, spectral = 0, speed = 0;
  const double share = 1.0 / static_cast<double>(clips.size());
  for (const Recording& clip : clips) {
    const auto found = value_or_abort(validate_outline(fit.model, clip));
    if (!found.fidelity) continue;
    energy += share * found.fidelity->energy_distance.value;
    floor += share * found.fidelity->energy_distance.floor;
    spectral += share * found.fidelity->log_spectral_distance.value;
    speed += share * found.fidelity->wasserstein_speed.value;
  }
  std::printf("               energy distance %.4f (floor %.4f), log-spectral %.1f dB, speeds %.2f sd\n", energy, floor,
              spectral, speed);
}

/// The longest stretch that a play along a learned clip's own wind repeats of that clip: the most tempting case.
double longest_copy(const OutlineFit& fit, const std::vector<Recording>& learned) {
  double seconds = 0;
  for (const Recording& clip : learned) {
    const auto found = value_or_abort(validate_outline(fit.model, clip));
    if (found.fidelity) seconds = std::max(seconds, found.fidelity->verbatim_seconds);
  }
  return seconds;
}

struct Way {
  const char* name;
  OutlineOptions options;
};

}  // namespace

LikenessClips make_likeness_clips() {
  LikenessClips clips;
  const auto heard = [](double seconds, std::uint64_t wind, std::uint64_t chance) {
    return driven_by_sound(make_flame_clip({seconds, wind, chance}), WindMeasure::kSpeed);
  };
  for (std::uint64_t seed : kLearnSeeds) clips.learn.push_back(heard(40, seed, seed));
  for (std::uint64_t seed : kUnseenSeeds) {
    clips.seen.push_back(heard(20, seed, seed));
    clips.again.push_back(heard(20, seed, seed + kOtherChance));
  }
  return clips;
}

void write_likeness_windows(const LikenessClips& clips, const std::filesystem::path& file) {
  const Way ways[] = {
      {"matched", {.noise = OutlineNoise::kMatched, .growing_noise = false}},
      {"growing", {.noise = OutlineNoise::kMatched}},
      {"drawn", {}},
  };
  std::ofstream out(file);
  bool recorded = false;
  for (const Way& way : ways) {
    const auto fit = value_or_abort(learn_outline(clips.learn, way.options));
    const auto& knots = std::get<OutlineView>(fit.model.view).knots;
    for (std::size_t clip = 0; clip < clips.seen.size(); ++clip) {
      if (!recorded) {
        write_side(out, "recorded", clip, as_seen(in_units(clips.seen[clip], fit), knots));
        write_side(out, "again", clip, as_seen(in_units(clips.again[clip], fit), knots));
      }
      write_side(out, way.name, clip, as_seen(played_along(fit, clips.seen[clip], clip + 1), knots));
    }
    recorded = true;
    const Cost& cost = fit.summary.cost;
    const auto number = [](std::int64_t count) { return static_cast<long long>(count); };
    std::printf("  %-12s %lld multiply-adds, %lld operations a frame: dynamics %lld, noise %lld + %lld, view %lld\n",
                way.name, number(cost.multiply_adds_per_frame), number(cost.operations_per_frame),
                number(cost.dynamics_operations), number(cost.noise_operations), number(cost.random_operations),
                number(cost.view_operations));
    print_fidelity(fit, clips.seen);
    std::printf("               longest verbatim run along a learned clip's own wind: %.2f s\n",
                longest_copy(fit, clips.learn));
  }
  std::printf("wrote %s\n", file.string().c_str());
}

}  // namespace wisp::verify
