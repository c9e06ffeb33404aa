// Wisp's learned flame beside three other ways of learning one, on the same clips.
//
//   wisp_verify_baselines DIR      the corpus is in DIR, or is made there (flame_corpus.hpp); figures and windows for a
//                                  classifier go to DIR/baselines (flame_judge.hpp), studies/fidelity/fidelity.py makes
//                                  the table of them

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "learn/outline/outline_fit.hpp"
#include "learn/outline/outline_units.hpp"
#include "studies/baselines/dynamic_texture.hpp"
#include "studies/baselines/emulator.hpp"
#include "studies/baselines/frames.hpp"
#include "studies/baselines/video_texture.hpp"
#include "studies/flame/flame_corpus.hpp"
#include "studies/flame/flame_judge.hpp"
#include "studies/value_or_abort.hpp"

namespace wisp::verify {
namespace {

using namespace wisp::baselines;

constexpr double kWarmUpSeconds = 10;

// Chosen, as the other settings of video textures were, by learning from two training clips and playing along the
// third.
constexpr double kSteering = 1000;

// As `run/` makes them: a quarter of a Philox block (47 operations), and a quadratic of the word's segment.
constexpr std::int64_t kWordOperations = 12;
constexpr std::int64_t kNormalOperations = kWordOperations + 10;

/// What baselines are told about the flame beyond the frames.
struct Setting {
  std::vector<std::string> outputs;
  std::int64_t view = 0;  ///< operations of looking at control points
};

std::vector<Frames> frames_in(const std::vector<Recording>& clips, const FlameUnits& units, const Setting& setting) {
  std::vector<Recording> scaled;
  for (const Recording& clip : clips) scaled.push_back(units(clip));
  return value_or_abort(frames_of(scaled, setting.outputs, "wind"));
}

/// Plays with a player of its own each time.
template <class Player, class Learned>
FlamePlayer player(const std::string& name, std::shared_ptr<const Learned> learned, const Setting& setting) {
  FlamePlayer out{.name = name};
  out.play = [learned, outputs = setting.outputs](const Recording& along, bool chance, std::uint64_t seed) {
    Player one(*learned, seed, chance);
    const auto warm_up = static_cast<std::size_t>(kWarmUpSeconds * along.rate_hz);
    return play_along([&](double wind) { return one.step(wind); }, along.channels[*find_channel(along, "wind")].samples,
                      warm_up, outputs, along.rate_hz);
  };
  return out;
}

FlamePlayer video_texture(const std::vector<Frames>& frames, double steering, const Setting& setting) {
  const auto learned = std::make_shared<const VideoTexture>(learn_video_texture(frames, {.steering = steering}));
  auto out = player<VideoTexturePlayer>(steering > 0 ? "video texture steered" : "video texture", learned, setting);
  out.hears_wind = steering > 0;
  out.bytes = learned->bytes();
  const auto frame_count = static_cast<double>(learned->frames.rows());
  const double jumps = static_cast<double>(learned->jump_count()) / frame_count;
  // A random word; a jump's probability is looked up and subtracted, or worked out of wind and cost (six operations).
  out.operations = setting.view + kWordOperations + static_cast<std::int64_t>(jumps * (steering > 0 ? 6 : 1));
  std::printf("video texture: %.0f frames, %.1f jumps a frame\n", frame_count, jumps);
  return out;
}

FlamePlayer dynamic_texture(const std::vector<Frames>& frames, bool driven, const Setting& setting) {
  const auto learned = std::make_shared<const DynamicTexture>(learn_dynamic_texture(frames, {.driven = driven}));
  auto out = player<DynamicTexturePlayer>(driven ? "dynamic texture driven" : "dynamic texture", learned, setting);
  out.hears_wind = driven;
  out.bytes = learned->bytes();
  out.operations = setting.view + learned->operations() + learned->states() * kNormalOperations;
  std::printf("dynamic texture: %d states, farthest pole %.4f\n", static_cast<int>(learned->states()),
              learned->found_radius);
  return out;
}

/// Share of steps in which it leaves what it is held to, along its own training wind.
double diverging_share(const Emulator& net, const std::vector<Frames>& frames) {
  double share = 0;
  for (const Frames& each : frames) {
    EmulatorPlayer one(net, 1, true);
    for (double wind : each.wind) (void)one.step(wind);
    share += one.held_share() / static_cast<double>(frames.size());
  }
  return share;
}

FlamePlayer emulator(const std::vector<Frames>& frames, double jitter, const Setting& setting) {
  const auto learned = std::make_shared<const Emulator>(learn_emulator(frames, {.jitter = jitter}));
  auto out = player<EmulatorPlayer>(jitter > 0 ? "neural emulator jittered" : "neural emulator", learned, setting);
  out.bytes = learned->bytes();
  out.operations = setting.view + learned->operations() + learned->mean.size() * kNormalOperations;
  std::printf(
      "neural emulator, jitter %.2f: %d epochs, mean square error %.3f learned, %.3f held out (1: no change foreseen); "
      "held at its range in %.4f of steps along what it learned from\n",
      jitter, learned->epochs, learned->learned_error, learned->held_out_error, diverging_share(*learned, frames));
  return out;
}

std::vector<FlamePlayer> players_of(const std::vector<Recording>& clips, const FlameUnits& units) {
  const Model wisp = value_or_abort(fit_outline(clips)).model;
  const Setting setting{outline_outputs(units.knots.size() - 4), view_operations(wisp)};
  const auto frames = frames_in(clips, units, setting);
  return {player_of("Wisp", wisp),
          video_texture(frames, 0, setting),
          video_texture(frames, kSteering, setting),
          dynamic_texture(frames, false, setting),
          dynamic_texture(frames, true, setting),
          emulator(frames, 0, setting),
          emulator(frames, 0.05, setting)};
}

void run(const std::filesystem::path& folder) {
  FlameCorpus corpus(folder);
  const auto gusts = corpus.gusts();
  const FlameUnits units = flame_units(gusts);
  const auto players = players_of(gusts, units);
  judge_players(corpus.unseen_gusts(), units, players, folder / "baselines");
  judge_players(corpus.unseen_calm(), units, players, folder / "baselines");
}

}  // namespace
}  // namespace wisp::verify

int main(int count, char** arguments) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  if (count != 2) {
    std::fprintf(stderr, "usage: wisp_verify_baselines DIR\n");
    return 2;
  }
  wisp::verify::run(arguments[1]);
  return 0;
}
