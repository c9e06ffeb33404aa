// Breath on a microphone, four gusts with gaps: are they found, live and with the whole recording known?

#include "capture/support/whole_sound.hpp"
#include "studies/wind/verify_wind.hpp"
#include "wisp/sound/wind_level.hpp"
#include "wisp/sound/wind_track.hpp"

namespace wisp::verify {
namespace {

struct Stretch {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Runs of marked frames; holes of at most `hole` are closed, runs shorter than `least` dropped.
std::vector<Stretch> stretches(const std::vector<bool>& marks, std::size_t hole, std::size_t least) {
  std::vector<Stretch> found;
  for (std::size_t k = 0; k < marks.size(); ++k) {
    if (!marks[k]) continue;
    if (!found.empty() && k - found.back().end <= hole) {
      found.back().end = k + 1;
    } else {
      found.push_back({k, k + 1});
    }
  }
  std::erase_if(found, [&](const Stretch& s) { return s.end - s.begin < least; });
  return found;
}

template <class Holds>
std::vector<bool> marks(const std::vector<WindFrame>& frames, Holds holds) {
  std::vector<bool> out;
  for (const WindFrame& frame : frames) out.push_back(holds(frame));
  return out;
}

template <class Holds>
double share(const std::vector<WindFrame>& frames, const std::vector<Stretch>& where, Holds holds) {
  double all = 0;
  double held = 0;
  for (const Stretch& s : where) {
    for (std::size_t k = s.begin; k < s.end && k < frames.size(); ++k) {
      all += 1;
      held += holds(frames[k]) ? 1 : 0;
    }
  }
  return all > 0 ? held / all : 0;
}

void judge(const char* how, const std::vector<WindFrame>& frames, Bounds& bounds) {
  // What a person would mark by the plain level: gusts above −46 dB, gaps below −80 dB.
  const auto gusts = stretches(marks(frames, [](const WindFrame& f) { return f.rms > 5e-3F; }), 12, 30);
  const auto gaps = stretches(marks(frames, [](const WindFrame& f) { return f.rms < 1e-4F; }), 0, 30);
  const auto heard = stretches(marks(frames, [](const WindFrame& f) { return f.wind > 0.3F; }), 12, 30);
  std::printf("  %-9s", how);
  for (const Stretch& s : heard)
    std::printf("  %.2f–%.2f s", static_cast<double>(s.begin) / 60, static_cast<double>(s.end) / 60);
  std::printf("\n");
  const std::string name = std::string(how) + ": ";
  bounds.at_most(name + "gusts heard beside the " + std::to_string(gusts.size()) + " that there are",
                 std::abs(static_cast<double>(heard.size()) - static_cast<double>(gusts.size())), 0);
  bounds.at_least(name + "share of gust frames with wind",
                  share(frames, gusts, [](const WindFrame& f) { return f.wind > 0.1F; }), 0.95);
  bounds.at_least(name + "share of gap frames without wind",
                  share(frames, gaps, [](const WindFrame& f) { return f.wind < 0.02F; }), 0.99);
}

}  // namespace

void gusts(Bounds& bounds) {
  std::printf("\n== Gusts and gaps of real breath\n");
  const auto sound = support::read_sound(data_folder() / "sound" / "breath_normal.wav");
  if (!sound) {
    std::printf("  skipped: %s\n", sound.error().message.c_str());
    return;
  }
  const SoundFormat format{(*sound)->info.rate_hz, (*sound)->info.channels};
  auto level = WindLevel::create(format);
  auto track = wind_from_sound((*sound)->samples, format);
  if (!level || !track) std::abort();
  std::vector<WindFrame> live(track->frames.size() + 1);
  live.resize(level->feed(std::span<const float>((*sound)->samples), live).frames);
  judge("live", live, bounds);
  judge("recording", track->frames, bounds);
}

}  // namespace wisp::verify
