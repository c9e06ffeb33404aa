// The wind that is heard at the simulated candle, beside the true one: six clips of gusts with voices and knocks in
// them, as `wisp simulate candle` makes them, but without the flame.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "simulate/candle/wind_signal.hpp"
#include "studies/verify_bounds.hpp"
#include "wisp/sound/wind_level.hpp"
#include "wisp/sound/wind_track.hpp"

namespace wisp::verify {
namespace {

constexpr double kRate = 44100;
constexpr double kFrames = 60;
constexpr double kSeconds = 40;
// Live, what sounds from the first moment is the room until it pauses, so that nobody has to be still: the rig's first
// gust. The wind after it is printed beside the bounded one.
constexpr std::size_t kFirstFrames = 300;

struct Clip {
  std::vector<float> sound;
  std::vector<double> truth;  ///< in each frame's middle
};

Clip clip(std::uint64_t seed, double other_sounds) {
  WindSignalOptions wind;
  wind.seed = seed;
  VirtualMicrophoneOptions heard;
  heard.seed = seed;
  heard.other_sounds = other_sounds;
  const auto signal = WindSignal::generate(wind, kSeconds);
  auto microphone = VirtualMicrophone::create(heard);
  if (!signal || !microphone) std::abort();
  Clip made;
  std::vector<float> speeds(static_cast<std::size_t>(kSeconds * kRate));
  for (std::size_t i = 0; i < speeds.size(); ++i)
    speeds[i] = static_cast<float>(signal->at(static_cast<double>(i) / kRate));
  made.sound.resize(speeds.size());
  microphone->hear(speeds, made.sound);
  for (int k = 1; k <= static_cast<int>(kSeconds * kFrames); ++k) made.truth.push_back(signal->at((k - 0.5) / kFrames));
  return made;
}

double correlation(const std::vector<WindFrame>& frames, const std::vector<double>& truth,
                   float WindFrame::*measure = &WindFrame::wind, std::size_t first = 0) {
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  const std::size_t n = std::min(frames.size(), truth.size());
  for (std::size_t k = first; k < n; ++k) {
    const double a = static_cast<double>(frames[k].*measure);
    const double b = std::abs(truth[k]);
    sa += a, sb += b, saa += a * a, sbb += b * b, sab += a * b;
  }
  const double count = static_cast<double>(n - first);
  return (sab - sa * sb / count) / std::sqrt((saa - sa * sa / count) * (sbb - sb * sb / count));
}

void clips(const char* what, std::uint64_t first_seed, double other_sounds, double mean_bound, double worst_bound,
           double live_bound, Bounds& bounds) {
  std::printf(
      "\n== %s: correlation with the true wind\n  seed  recorded  live   after 5 s  speed of all sound after "
      "5 s\n",
      what);
  double sum = 0, worst = 1, live_sum = 0, later_sum = 0, most_sum = 0;
  for (std::uint64_t seed = first_seed; seed < first_seed + 6; ++seed) {
    const Clip made = clip(seed, other_sounds);
    const auto track = wind_from_sound(made.sound, {kRate, 1}, {.frame_rate_hz = kFrames});
    auto level = WindLevel::create({kRate, 1}, {.frame_rate_hz = kFrames});
    if (!track || !level) std::abort();
    std::vector<WindFrame> live(made.truth.size() + 1);
    live.resize(level->feed(std::span<const float>(made.sound), live).frames);
    const double recorded = correlation(track->frames, made.truth);
    const double played = correlation(live, made.truth);
    const double later = correlation(live, made.truth, &WindFrame::wind, kFirstFrames);
    const double most = correlation(live, made.truth, &WindFrame::speed, kFirstFrames);
    std::printf("  %4d  %.3f     %.3f  %.3f      %.3f\n", static_cast<int>(seed), recorded, played, later, most);
    sum += recorded / 6;
    live_sum += played / 6;
    later_sum += later / 6;
    most_sum += most / 6;
    worst = std::min(worst, recorded);
  }
  bounds.at_least(std::string(what) + ", recorded: mean", sum, mean_bound);
  bounds.at_least(std::string(what) + ", recorded: worst", worst, worst_bound);
  bounds.at_least(std::string(what) + ", live: mean", live_sum, live_bound);
  std::printf("          after 5 s %.3f, speed of all sound %.3f\n", later_sum, most_sum);
}

void rig(Bounds& bounds) {
  clips("clips as the rig makes them", 1, VirtualMicrophoneOptions{}.other_sounds, 0.985, 0.975, 0.94, bounds);
  clips("fresh clips", 101, VirtualMicrophoneOptions{}.other_sounds, 0.985, 0.975, 0.94, bounds);
  clips("clips with another sound every three seconds", 201, 0.33, 0.97, 0.95, 0.75, bounds);
}

}  // namespace
}  // namespace wisp::verify

int main(int count, char** names) {
  using namespace wisp::verify;
  const Check checks[] = {{"rig", rig}};
  return run_checks(checks, {names + 1, static_cast<std::size_t>(count - 1)});
}
