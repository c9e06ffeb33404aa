// Whoever blows hard puts the candle out, at once and first thing; whoever breathes, talks or plays music does not.
//
// Every recording of breath is replayed behind a quiet room, or after a first sound that comes at once, and what the
// estimator makes of them blows on the candle that the page ships.

#include <map>

#include "studies/value_or_abort.hpp"
#include "studies/wind/blowing_sounds.hpp"
#include "studies/wind/verify_wind.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/extinction_facet.hpp"
#include "wisp/sound/wind_level.hpp"

namespace wisp::verify {
namespace {

using sounds::Samples;

constexpr double kFrames = 60;
constexpr double kRoom = 3;  ///< seconds of a quiet room before anything else is heard

/// The candle that the page ships.
class Candle {
 public:
  Candle() : bank_(shipped()), id_(bank_.spawn()) {}

  /// Takes a frame's wind; returns whether the candle has just gone out. It is lit again at once.
  bool step(float wind) {
    bank_.set_common_inputs({&wind, 1});
    bank_.step();
    if (bank_.extinction()->state_of(id_)->lit) return false;
    bank_.extinction()->relight(id_);
    return true;
  }

 private:
  static Bank shipped() {
    static const Model model =
        value_or_abort(read_model(std::filesystem::path(WISP_SOURCE_DIR) / "apps/web/public/models/flame-4.wisp"));
    return value_or_abort(Bank::create(model));
  }

  Bank bank_;
  InstanceId id_;
};

struct Heard {
  std::vector<double> out;  ///< seconds after the room
  double wind = 0;          ///< share of frames with wind
  double most = 0;
  float rise = 0;  ///< of the room by the end, dB
};

/// Plays `room` seconds of a quiet room, then the sound; `steady` is there from the start and goes on.
Heard play(const Samples& sound, const Samples& steady = {}, double room = kRoom) {
  auto level = WindLevel::create({kSoundRate, 1}, {.frame_rate_hz = kFrames});
  if (!level) std::abort();
  const double seconds = room + static_cast<double>(sound.size()) / kSoundRate + 0.5;
  Samples all = sounds::room(seconds, kSoundRate, 3e-4);
  sounds::add(all, sound, room, kSoundRate);
  for (std::size_t i = 0; i < all.size() && !steady.empty(); ++i) all[i] += steady[i % steady.size()];
  std::vector<WindFrame> frames(static_cast<std::size_t>(seconds * kFrames) + 1);
  frames.resize(level->feed(std::span<const float>(all), frames).frames);
  Heard heard;
  Candle candle;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const double wind = static_cast<double>(frames[k].wind);
    if (candle.step(frames[k].wind)) heard.out.push_back(static_cast<double>(k + 1) / kFrames - room);
    heard.wind += wind > 0.1 ? 1 : 0;
    heard.most = std::max(heard.most, wind);
  }
  heard.rise = level->room_rise_db();
  heard.wind /= static_cast<double>(frames.size());
  return heard;
}

bool went_out(const Heard& heard, double from, double to) {
  return std::any_of(heard.out.begin(), heard.out.end(), [&](double t) { return t >= from && t <= to; });
}

/// Shares of trials by what was tried.
class Table {
 public:
  void count(const std::string& row, bool out, const Heard& heard) {
    Row& r = rows_[row];
    r.tried += 1;
    r.out += out ? 1 : 0;
    r.wind += heard.wind;
    r.most = std::max(r.most, heard.most);
    all_.tried += 1;
    all_.out += out ? 1 : 0;
  }

  double share() const { return all_.tried > 0 ? all_.out / all_.tried : 0; }

  void print(const char* title) const {
    std::printf("\n== %s\n  %-28s  trials  out     wind in  strongest\n", title, "");
    for (const auto& [name, row] : rows_)
      std::printf("  %-28s  %5.0f   %5.1f %%  %5.1f %%  %.2f\n", name.c_str(), row.tried, 100 * row.out / row.tried,
                  100 * row.wind / row.tried, row.most);
  }

 private:
  struct Row {
    double tried = 0;
    double out = 0;
    double wind = 0;
    double most = 0;
  };
  std::map<std::string, Row> rows_;
  Row all_;
};

/// Two soft breaths as the recording has them, then what is asked.
Samples after_soft(const Samples& soft, const Samples& hard) {
  Samples all = soft;
  sounds::add(all, soft, 2, kSoundRate);
  sounds::add(all, hard, 4, kSoundRate);
  return all;
}

Samples three(const Samples& one) {
  Samples all = one;
  sounds::add(all, one, 2, kSoundRate);
  sounds::add(all, one, 4, kSoundRate);
  return all;
}

void scale_loudest_second(Samples& sound, double rms) {
  const std::size_t n = std::min(sound.size(), static_cast<std::size_t>(kSoundRate));
  double loudest = 0;
  for (std::size_t i = 0; i + n <= sound.size(); i += n / 20 + 1)
    loudest = std::max(loudest, sounds::rms_of({sound.data() + i, n}));
  for (float& x : sound) x = static_cast<float>(static_cast<double>(x) * rms / loudest);
}

void hard_blows(Bounds& bounds) {
  constexpr double kSoon = 0.7;
  Table table;
  std::map<std::string, Table> sums;
  const auto count = [&](const std::string& how, const KnownSound& blow, const Heard& heard, double at) {
    const bool out = went_out(heard, at, at + kSoon);
    table.count(blow.from, out, heard);
    sums[how].count(how, out, heard);
  };
  for (const KnownSound& blow : blows()) {
    const Samples soft = at_rms(blow.samples, 0.01);
    for (const double rms : {0.1, 0.2, 0.35, 0.6}) {
      const Samples hard = at_rms(blow.samples, rms);
      const Heard in_a_row = play(three(hard));
      count("first", blow, in_a_row, 0);
      count("second", blow, in_a_row, 2);
      count("third", blow, in_a_row, 4);
      count("after soft breaths", blow, play(after_soft(soft, hard)), 4);
    }
    count("0.05 after soft breaths", blow, play(after_soft(soft, at_rms(blow.samples, 0.05))), 4);
  }
  table.print("Hard blows, by recording");
  std::printf("\n");
  for (const auto& [how, sum] : sums) bounds.at_least("hard blows put it out in 0.7 s: " + how, sum.share(), 0.95);
}

void puffs_at_the_microphone(Bounds& bounds) {
  Table made;
  Table found;
  for (const KnownSound& puff : puffs()) {
    for (const double rms : {0.2, 0.4}) {
      const Heard heard = play(at_rms(puff.samples, rms));
      made.count("made, " + std::to_string(rms).substr(0, 4), went_out(heard, 0, 1), heard);
    }
  }
  for (const KnownSound& puff : recorded_puffs()) {
    for (const double rms : {0.1, 0.3}) {
      const Heard heard = play(at_rms(puff.samples, rms));
      found.count(puff.from + ", " + std::to_string(rms).substr(0, 4), went_out(heard, 0, 1), heard);
    }
  }
  made.print("Puffs at the microphone");
  found.print("Puffs from web pages (no bound)");
  std::printf("\n");
  bounds.at_least("puffs made here put it out", made.share(), 0.9);
}

/// Whole recordings, and each of their gusts three times; the loudest second has the level that is told.
void natural_breath(Bounds& bounds) {
  Table table;
  for (const double rms : {0.005, 0.01, 0.02, 0.03}) {
    for (KnownSound& breath : breaths()) {
      scale_loudest_second(breath.samples, rms);
      const Heard heard = play(breath.samples);
      table.count(breath.from, !heard.out.empty(), heard);
    }
    for (const KnownSound& blow : blows()) {
      const Heard heard = play(three(at_rms(blow.samples, rms)));
      table.count("gusts of " + blow.from, !heard.out.empty(), heard);
    }
  }
  table.print("Natural breathing");
  std::printf("\n");
  bounds.at_most("natural breathing puts it out", table.share(), 0.02);
}

/// The loudest stretch of that length, RMS 1, with soft ends.
Samples loudest(const Samples& sound, double seconds) {
  const std::size_t n = std::min(sound.size(), static_cast<std::size_t>(seconds * kSoundRate));
  std::size_t best = 0;
  for (std::size_t i = 0; i + n <= sound.size(); i += static_cast<std::size_t>(kSoundRate) / 8)
    if (sounds::rms_of({sound.data() + i, n}) > sounds::rms_of({sound.data() + best, n})) best = i;
  const auto begin = sound.begin() + static_cast<std::ptrdiff_t>(best);
  Samples cut(begin, begin + static_cast<std::ptrdiff_t>(n));
  sounds::scale_to(cut, 1);
  const std::size_t ends = std::min(n / 2, static_cast<std::size_t>(0.02 * kSoundRate));
  for (std::size_t i = 0; i < ends; ++i) {
    const float fade = static_cast<float>(i) / static_cast<float>(ends);
    cut[i] *= fade;
    cut[n - 1 - i] *= fade;
  }
  return cut;
}

/// What somebody may do as soon as the microphone is open: short and long puffs, words, sneezes; a clock.
std::vector<KnownSound> first_sounds() {
  std::vector<KnownSound> all;
  for (const KnownSound& blow : blows()) {
    all.push_back({"puff of 0.3 s", blow.from, loudest(blow.samples, 0.3)});
    all.push_back({"blow of 1 s", blow.from, blow.samples});
  }
  for (const KnownSound& breath : breaths())
    all.push_back({"breath of 2.8 s", breath.from, loudest(breath.samples, 2.8)});
  for (const KnownSound& puff : puffs()) all.push_back({"made puff", puff.from, puff.samples});
  for (const KnownSound& one : other_sounds())
    if (one.kind == "speech" || one.kind == "sneeze" || one.kind == "clock")
      all.push_back({one.kind, one.from, loudest(one.samples, 2)});
  return all;
}

/// Whoever presses Blow and blows, talks or sneezes at once: the hard blows that follow, 3, 6 and 9 s after it.
void eager(Bounds& bounds) {
  const std::vector<KnownSound> hard = blows();
  Table by_sound;
  Table by_start;
  std::size_t turn = 0;
  for (const KnownSound& first : first_sounds()) {
    for (const double rms : {0.03, 0.1, 0.3}) {
      for (const double start : {0.0, 0.3, 1.0, 2.5, 4.0}) {
        const double rest = static_cast<double>(first.samples.size()) / kSoundRate + 3;
        Samples sound = at_rms(first.samples, rms);
        for (int k = 0; k < 3; ++k, ++turn) {
          const Samples blow = at_rms(hard[turn % hard.size()].samples, turn % 2 == 0 ? 0.1 : 0.3);
          sounds::add(sound, blow, rest + 3 * k, kSoundRate);
        }
        const Heard heard = play(sound, {}, start);
        for (int k = 0; k < 3; ++k) {
          const bool out = went_out(heard, rest + 3 * k, rest + 3 * k + 0.7);
          by_sound.count(first.kind, out, heard);
          by_start.count("after " + std::to_string(start).substr(0, 3) + " s", out, heard);
        }
      }
    }
  }
  by_sound.print("Hard blows after a first sound that comes at once");
  by_start.print("The same, by when that begins");
  std::printf("\n");
  bounds.at_least("hard blows after a first sound put it out in 0.7 s", by_sound.share(), 0.95);
}

/// The sound again and again, for so long.
Samples goes_on(const Samples& sound, double seconds) {
  Samples all(static_cast<std::size_t>(seconds * kSoundRate));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = sound[i % sound.size()];
  return all;
}

/// A blow of which a microphone passes a band alone, behind a quiet room or over a fan that runs from the start.
void without_rumble(Bounds& bounds) {
  struct Band {
    const char* name;
    double low_hz, high_hz;
  };
  Table all;
  for (const Band band :
       {Band{"0.8 to 3.2 kHz", 800, 3200}, {"0.6 to 2.5 kHz", 600, 2500}, {"1.0 to 3.5 kHz", 1000, 3500}}) {
    Table table;
    std::vector<KnownSound> given = blows();
    for (std::uint64_t seed = 1; seed <= 8; ++seed) given.push_back({"blow", "made of noise", made_blow(seed + 100)});
    for (const KnownSound& blow : given) {
      const Samples passed = banded(blow.samples, band.low_hz, band.high_hz);
      for (const double rms : {0.05, 0.1, 0.2, 0.35}) {
        const Heard heard = play(three(at_rms(passed, rms)));
        for (const double at : {0.0, 2.0, 4.0}) {
          const bool out = went_out(heard, at, at + 1);
          table.count(blow.from + ", " + std::to_string(rms).substr(0, 4), out, heard);
          all.count(band.name, out, heard);
        }
      }
    }
    table.print(band.name);
  }
  all.print("Blows at a microphone without rumble");
  bounds.at_least("blows without rumble put it out in 1 s", all.share(), 0.9);
  Table fan;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    for (const double rms : {0.1, 0.3}) {
      const Samples blow = at_rms(banded(made_blow(seed + 100), 100, 300), rms);
      for (const double room : {0.0, 0.01, 0.03, 0.1}) {
        const Heard heard =
            play(three(blow), room > 0 ? at_rms(sounds::steady_blowing(10, kSoundRate, 0.1, seed), room) : Samples());
        for (const double at : {0.0, 2.0, 4.0})
          fan.count("fan " + std::to_string(room).substr(0, 4) + ", blow " + std::to_string(rms).substr(0, 4),
                    went_out(heard, at, at + 1), heard);
      }
    }
  }
  fan.print("Blows of 100 to 300 Hz over a fan");
}

void others(Bounds& bounds) {
  Table short_ones;
  for (const KnownSound& one : other_sounds()) {
    for (const double rms : {0.02, 0.05, 0.1}) {
      const Heard heard = play(at_rms(one.samples, rms));
      short_ones.count(one.kind, !heard.out.empty(), heard);
      const Heard at_once = play(at_rms(one.samples, rms), {}, 0.2);
      short_ones.count(one.kind, !at_once.out.empty(), at_once);
    }
  }
  short_ones.print("Other sounds");
  Table steady;
  Table later;
  Table told;
  for (const KnownSound& one : steady_sounds()) {
    for (const double rms : {0.02, 0.05, 0.1}) {
      const Samples sound = at_rms(one.samples, rms);
      const Heard heard = play(Samples(at_rms(one.samples, rms).size(), 0.0F), sound);
      steady.count(one.kind, !heard.out.empty(), heard);
      const Heard begins = play(goes_on(sound, 12));
      later.count(one.kind, !begins.out.empty(), begins);
      told.count(one.kind, begins.rise >= 6, begins);
    }
  }
  steady.print("Steady sounds that were there from the start");
  later.print("The same, that begin later (no bound)");
  told.print("Of those it is told within 12 s that the room has become louder (column out)");
  std::printf("\n");
  bounds.at_most("other sounds put it out", short_ones.share(), 0.01);
  bounds.at_most("steady sounds that were there put it out", steady.share(), 0.01);
  bounds.at_least("those that begin later are told of within 12 s", told.share(), 0.8);
}

}  // namespace

void blowing(Bounds& bounds) {
  if (blows().empty()) {
    std::printf("\n== Blowing\n  skipped: no recordings of breath in %s\n", (data_folder() / "sound").string().c_str());
    return;
  }
  hard_blows(bounds);
  eager(bounds);
  puffs_at_the_microphone(bounds);
  natural_breath(bounds);
  others(bounds);
  without_rumble(bounds);
}

}  // namespace wisp::verify
