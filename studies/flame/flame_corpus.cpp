#include "studies/flame/flame_corpus.hpp"

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "learn/flame/blow_outs.hpp"
#include "learn/outline/outline_units.hpp"
#include "record/loudness.hpp"
#include "studies/value_or_abort.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::verify {
namespace {

constexpr std::uint64_t kOtherChance = 100;

void write(const std::filesystem::path& file, const Recording& recording) {
  if (const auto written = write_csv(file, recording); !written) {
    std::fprintf(stderr, "%s\n", written.error().message.c_str());
    std::abort();
  }
}

std::vector<Recording> burning(const std::vector<Recording>& clips) {
  std::vector<Recording> out;
  for (const Recording& clip : clips) {
    out.push_back(without_blow_outs(clip, value_or_abort(find_blow_outs(clip, "wind"))));
  }
  return out;
}

std::vector<Recording> joined(std::vector<Recording> clips, const std::vector<Recording>& more) {
  clips.insert(clips.end(), more.begin(), more.end());
  return clips;
}

}  // namespace

FlameCorpus::FlameCorpus(std::filesystem::path folder, FlameSeeds seeds)
    : folder_(std::move(folder)), offset_(static_cast<std::uint64_t>(seeds)) {
  std::filesystem::create_directories(folder_);
  (void)gusts();  // the first of them has the knots
}

Recording FlameCorpus::get(const std::string& name, FlameClipChoice choice) {
  const auto file = folder_ / (name + ".csv");
  if (!std::filesystem::exists(file)) {
    choice.knots = knots_;
    const FlameClip clip = make_flame_clip(choice);
    write(file, driven_by_sound(clip, WindMeasure::kSpeed));
    std::printf("  %s: %.0f s of film in %.0f s of one processor\n", name.c_str(), choice.seconds,
                clip.processor_seconds);
  }
  // Read back even if just made, so that the first run and the next have the same numbers.
  Recording clip = value_or_abort(read_csv(file));
  if (knots_.empty()) {
    knots_ = value_or_abort(outline_layout(clip)).knots;
    one_rms_ = value_or_abort(one_rms(clip, "wind")).value();
  }
  return value_or_abort(heard_at(std::move(clip), "wind", one_rms_));
}

std::vector<Recording> FlameCorpus::get(const Takes& takes, bool again) {
  std::vector<Recording> out;
  for (std::uint64_t number : takes.seeds) {
    const std::uint64_t seed = number + offset_;
    FlameClipChoice choice = takes.choice;
    choice.wind_seed = seed;
    choice.chance_seed = again ? seed + kOtherChance : seed;
    out.push_back(get(takes.name + "-" + std::to_string(seed) + (again ? "-again" : ""), choice));
  }
  return out;
}

UnseenFlames FlameCorpus::unseen(const Takes& takes) { return {takes.name, get(takes, false), get(takes, true)}; }

std::vector<Recording> FlameCorpus::gusts() { return get({"learn", {11, 12, 13}, {.seconds = 40}}, false); }

std::vector<Recording> FlameCorpus::gusts_and_calm() {
  return joined(gusts(), get({"learn-calm", {17}, {.seconds = 40, .wind = FlameWind::kCalm}}, false));
}

std::vector<Recording> FlameCorpus::calm() {
  return get({"learn-calm", {17, 18, 19, 20}, {.seconds = 40, .wind = FlameWind::kCalm}}, false);
}

std::vector<Recording> FlameCorpus::gusts_and_puffs() {
  const Takes puffs{"learn-puffs", {14, 15, 16}, {.seconds = 40, .wind = FlameWind::kPuffs}};
  return joined(gusts(), burning(get(puffs, false)));
}

UnseenFlames FlameCorpus::unseen_gusts() { return unseen({"gusts", {21, 22, 23}, {.seconds = 20}}); }

UnseenFlames FlameCorpus::unseen_calm() {
  return unseen({"calm", {31, 32, 33}, {.seconds = 20, .wind = FlameWind::kCalm}});
}

UnseenFlames FlameCorpus::unseen_blow_outs() {
  return unseen({"blow-out", {41, 42, 44}, {.seconds = 20, .wind = FlameWind::kPuffs}});
}

UnseenFlames FlameCorpus::unseen_between_blow_outs() {
  const UnseenFlames dying = unseen_blow_outs();
  return {"between blow-outs", burning(dying.clips), burning(dying.again)};
}

}  // namespace wisp::verify
