#include "studies/wind/blowing_sounds.hpp"

#include "capture/support/whole_sound.hpp"
#include "studies/wind/verify_wind.hpp"

namespace wisp::verify {
namespace {

using sounds::Samples;

constexpr double kTurn = 2 * std::numbers::pi;

std::size_t at(double seconds) { return sounds::count(seconds, kSoundRate); }

/// RMS of every 10 ms.
std::vector<double> envelope(const Samples& sound) {
  std::vector<double> levels;
  const std::size_t n = at(0.01);
  for (std::size_t i = 0; i + n <= sound.size(); i += n) levels.push_back(sounds::rms_of({sound.data() + i, n}));
  return levels;
}

std::vector<KnownSound> files(const char* folder, const std::string& start, const std::string& kind) {
  std::vector<KnownSound> all;
  const std::filesystem::path path = data_folder() / "sound" / folder;
  if (!std::filesystem::is_directory(path)) return all;
  std::vector<std::filesystem::path> names;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(start) && name.ends_with(".wav")) names.push_back(entry.path());
  }
  std::sort(names.begin(), names.end());
  for (const auto& name : names) {
    const auto sound = support::read_sound(name);
    if (!sound || !*sound || (*sound)->info.channels != 1) continue;
    all.push_back({kind, name.stem().string(), resampled((*sound)->samples, (*sound)->info.rate_hz, kSoundRate)});
  }
  return all;
}

void append(std::vector<KnownSound>& to, std::vector<KnownSound> more) {
  for (KnownSound& one : more) to.push_back(std::move(one));
}

/// A puff of lips at the microphone, as loud before the capsule's limit as `drive`.
Samples puff(std::uint64_t seed, double drive) {
  sounds::Chance chance(seed);
  const double seconds = 0.2 + 0.4 * chance.uniform();
  Samples out(at(seconds), 0.0F);
  sounds::Resonance low(60 + 90 * chance.uniform(), 0.6, kSoundRate);
  sounds::Resonance middle(300 + 700 * chance.uniform(), 0.6, kSoundRate);
  sounds::Resonance swing(12, 0.7, kSoundRate);
  const double turbulence = 0.1 + 0.5 * chance.uniform();
  const double hiss = 0.02 + 0.1 * chance.uniform();
  const double rise = 0.02 + 0.06 * chance.uniform();
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double t = static_cast<double>(i) / kSoundRate;
    const double ends = std::min(1.0, t / rise) * std::min(1.0, (seconds - t) / 0.1);
    const double gusty = std::max(0.3, 1 + 12 * swing.next(chance.normal()));
    const double noise =
        12 * low.next(chance.normal()) + turbulence * 4 * middle.next(chance.normal()) + hiss * chance.normal();
    out[i] = static_cast<float>(ends * gusty * noise);
  }
  sounds::scale_to(out, drive);
  for (float& x : out) x = std::clamp(x, -1.0F, 1.0F);  // the capsule overloads
  return out;
}

Samples kick_drum() {
  Samples out(at(0.35));
  double phase = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double t = static_cast<double>(i) / kSoundRate;
    phase += kTurn * (48 + 120 * std::exp(-t / 0.03)) / kSoundRate;
    out[i] = static_cast<float>(std::exp(-t / 0.12) * std::sin(phase));
  }
  return out;
}

Samples hat(std::uint64_t seed) {
  sounds::Chance chance(seed);
  Samples out(at(0.06));
  double before = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double now = chance.normal();
    out[i] = static_cast<float>(0.12 * std::exp(-static_cast<double>(i) / kSoundRate / 0.02) * (now - before));
    before = now;
  }
  return out;
}

/// Chords and a bass with a kick drum on every beat and a hi-hat between.
Samples music(std::uint64_t seed, double beat, double drum) {
  Samples out = sounds::chords(10, kSoundRate, 0.25);
  const double roots[] = {55, 49, 65.4, 41.2};
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double t = static_cast<double>(i) / kSoundRate;
    const double f = roots[(static_cast<std::size_t>(t / (4 * beat)) + seed) % 4];
    double bass = 0;
    for (int h = 1; h <= 6; ++h) bass += std::sin(kTurn * f * h * t) / h;
    out[i] += static_cast<float>(0.2 * bass);
  }
  for (double t = 0; t < 9.5; t += beat) {
    Samples kick = kick_drum();
    for (float& x : kick) x *= static_cast<float>(drum);
    sounds::add(out, kick, t, kSoundRate);
    sounds::add(out, hat(seed), t + beat / 2, kSoundRate);
  }
  return out;
}

Samples keys(std::uint64_t seed) {
  Samples out(at(10), 0.0F);
  sounds::Chance chance(seed);
  for (double t = 0.2; t < 9.5; t += 0.08 + 0.25 * chance.uniform()) {
    Samples key(at(0.05));
    const double thump = 90 + 120 * chance.uniform();
    for (std::size_t i = 0; i < key.size(); ++i) {
      const double s = static_cast<double>(i) / kSoundRate;
      key[i] = static_cast<float>(chance.normal() * std::exp(-s / 0.004) +
                                  0.7 * std::exp(-s / 0.012) * std::sin(kTurn * thump * s));
    }
    sounds::add(out, key, t, kSoundRate);
  }
  return out;
}

Samples clicks(std::uint64_t seed) {
  Samples out(at(10), 0.0F);
  sounds::Chance chance(seed + 20);
  for (double t = 0.2; t < 9.5; t += 0.08 + 0.25 * chance.uniform()) {
    Samples click(at(0.03));
    for (std::size_t i = 0; i < click.size(); ++i)
      click[i] = static_cast<float>(chance.normal() * std::exp(-static_cast<double>(i) / kSoundRate / 0.005));
    sounds::add(out, click, t, kSoundRate);
  }
  return out;
}

/// White noise that comes and goes: a tap, a spray.
Samples hiss(std::uint64_t seed) {
  Samples out(at(10), 0.0F);
  for (double t = 1; t < 9; t += 2)
    sounds::add(out, sounds::room(0.3 * static_cast<double>(seed), kSoundRate, 0.1, seed + 30), t, kSoundRate);
  return out;
}

/// A hand on the microphone's body: rumble and bumps, mostly below 150 Hz.
Samples handling(std::uint64_t seed) {
  Samples out(at(10), 0.0F);
  sounds::Chance chance(seed);
  sounds::Resonance rumble(70, 0.9, kSoundRate);
  sounds::Resonance swing(3, 0.7, kSoundRate);
  for (float& x : out) {
    const double grip = std::max(0.0, 40 * swing.next(chance.normal()) - 0.2);
    x = static_cast<float>(grip * 20 * rumble.next(chance.normal()));
  }
  sounds::scale_to(out, 0.1);
  sounds::add(out, sounds::knocks(10, kSoundRate, 0.2, seed), 0, kSoundRate);
  return out;
}

/// Cars that pass: noise below 300 Hz or so that swells and fades over seconds.
Samples traffic(std::uint64_t seed) {
  return sounds::blowing(
      20, kSoundRate, 0.1,
      [seed](double t) {
        const double away = (t - 7 - static_cast<double>(seed % 3)) / 2.5;
        return std::exp(-away * away / 4);
      },
      seed);
}

Samples singing(double pitch_hz) {
  Samples out(at(10), 0.0F);
  double phase = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double t = static_cast<double>(i) / kSoundRate;
    phase += kTurn * pitch_hz * (1 + 0.01 * std::sin(kTurn * 5 * t)) / kSoundRate;
    if (std::fmod(t, 2) < 1.5)
      out[i] = static_cast<float>(std::sin(phase) + 0.4 * std::sin(2 * phase) + 0.2 * std::sin(3 * phase));
  }
  return out;
}

std::vector<KnownSound> speech() {
  std::vector<KnownSound> all;
  if (std::system("espeak-ng --version >/dev/null 2>&1") != 0) return all;
  const auto file = std::filesystem::temp_directory_path() / "wisp-verify-blowing-voice.wav";
  for (const char* voice : {"en-us", "en-us+f2", "en-gb+m4", "de+m2", "fr+f3", "en-us+klatt2", "en-us+croak", "it+m3",
                            "en-gb+whisper", "it+whisper"}) {
    const std::string command = std::string("espeak-ng -v ") + voice + " -w '" + file.string() +
                                "' 'Papa bought a big blue balloon for Bobby, but the puppy popped it. Who has seen "
                                "the wind? Pfeffer, bitte. One, two, three, four, five.'";
    if (std::system(command.c_str()) != 0) continue;
    const auto sound = support::read_sound(file);
    if (sound && *sound)
      all.push_back({"speech", voice, resampled((*sound)->samples, (*sound)->info.rate_hz, kSoundRate)});
  }
  std::filesystem::remove(file);
  return all;
}

// A Butterworth filter of two poles: `sign` −1 keeps what is above the frequency, 1 what is below.
Samples filtered(const Samples& sound, double frequency_hz, double sign) {
  const double w = kTurn * frequency_hz / kSoundRate;
  const double alpha = std::sin(w) / std::numbers::sqrt2;
  const double gain = (1 - sign * std::cos(w)) / 2 / (1 + alpha);
  const double a1 = -2 * std::cos(w) / (1 + alpha);
  const double a2 = (1 - alpha) / (1 + alpha);
  double d1 = 0;
  double d2 = 0;
  Samples out;
  out.reserve(sound.size());
  for (const float x : sound) {
    const double now = static_cast<double>(x) - a1 * d1 - a2 * d2;
    out.push_back(static_cast<float>(gain * (now + sign * 2 * d1 + d2)));
    d2 = d1;
    d1 = now;
  }
  return out;
}

Samples without_highs(const Samples& sound, double frequency_hz) { return filtered(sound, frequency_hz, 1); }

}  // namespace

Samples without_lows(const Samples& sound, double frequency_hz) {
  return frequency_hz <= 0 ? sound : filtered(sound, frequency_hz, -1);
}

Samples banded(const Samples& sound, double low_hz, double high_hz) {
  const Samples risen = without_lows(without_lows(sound, low_hz), low_hz);
  return without_highs(without_highs(risen, high_hz), high_hz);
}

Samples made_blow(std::uint64_t seed) {
  sounds::Chance chance(seed + 70);
  Samples out(at(0.7 + 0.6 * chance.uniform()));
  sounds::Resonance swing(8, 0.7, kSoundRate);
  const double rise = 0.03 + 0.12 * chance.uniform();
  const double seconds = static_cast<double>(out.size()) / kSoundRate;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double t = static_cast<double>(i) / kSoundRate;
    const double ends = std::min(1.0, t / rise) * std::min(1.0, (seconds - t) / 0.15);
    out[i] = static_cast<float>(ends * std::max(0.3, 1 + 8 * swing.next(chance.normal())) * chance.normal());
  }
  return out;
}

Samples at_rms(Samples sound, double rms) {
  std::vector<double> levels = envelope(sound);
  std::sort(levels.begin(), levels.end());
  const double loud = levels.empty() ? 0 : levels[levels.size() * 95 / 100];
  double power = 0;
  double n = 0;
  for (const double level : levels) {
    if (level < 0.1 * loud) continue;
    power += level * level;
    n += 1;
  }
  const double scale = power > 0 ? rms / std::sqrt(power / n) : 0;
  for (float& x : sound) x = std::clamp(static_cast<float>(static_cast<double>(x) * scale), -1.0F, 1.0F);
  return sound;
}

std::vector<KnownSound> breaths() {
  std::vector<KnownSound> all = files("breath", "", "breath");
  append(all, files("", "breath_normal", "breath"));
  std::erase_if(all, [](const KnownSound& one) { return one.from.starts_with("breath_inhale"); });
  return all;
}

std::vector<KnownSound> blows() {
  std::vector<KnownSound> all;
  for (const KnownSound& breath : breaths()) {
    const std::vector<double> levels = envelope(breath.samples);
    const std::size_t second = 100;
    std::vector<double> power(levels.size() + 1, 0.0);
    for (std::size_t i = 0; i < levels.size(); ++i) power[i + 1] = power[i] + levels[i] * levels[i];
    std::vector<bool> taken(levels.size(), false);
    double first = 0;
    for (int k = 0; k < 4 && levels.size() > second; ++k) {
      std::size_t best = levels.size();
      double most = 0;
      for (std::size_t i = 0; i + second <= levels.size(); ++i) {
        if (taken[i] || taken[i + second - 1]) continue;
        if (power[i + second] - power[i] > most) best = i;
        most = std::max(most, power[i + second] - power[i]);
      }
      if (best == levels.size() || most < 0.03 * first) break;  // what is 15 dB softer is no hard blow
      first = std::max(first, most);
      const double half = 0.5 * std::sqrt(most / static_cast<double>(second));
      const auto from = levels.begin() + static_cast<std::ptrdiff_t>(best);
      const auto sounding =
          std::count_if(from, from + static_cast<std::ptrdiff_t>(second), [=](double x) { return x > half; });
      std::fill(taken.begin() + static_cast<std::ptrdiff_t>(best),
                taken.begin() + static_cast<std::ptrdiff_t>(best + second), true);
      if (sounding < 50) continue;  // the beginning or the end of a louder one
      Samples cut(breath.samples.begin() + static_cast<std::ptrdiff_t>(best * at(0.01)),
                  breath.samples.begin() + static_cast<std::ptrdiff_t>((best + second) * at(0.01)));
      for (std::size_t i = 0; i < at(0.02); ++i) {
        const float fade = static_cast<float>(i) / static_cast<float>(at(0.02));
        cut[i] *= fade;
        cut[cut.size() - 1 - i] *= fade;
      }
      sounds::scale_to(cut, 1);
      all.push_back({"blow", breath.from, std::move(cut)});
    }
  }
  return all;
}

std::vector<KnownSound> puffs() {
  std::vector<KnownSound> all;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const double drive = 0.15 * static_cast<double>(1 + seed % 8);
    const double lows = 50.0 * static_cast<double>(seed % 5);
    all.push_back({"puff", "made " + std::to_string(seed), without_lows(puff(seed, drive), lows)});
  }
  return all;
}

std::vector<KnownSound> winds() {
  std::vector<KnownSound> all;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const double rate = static_cast<double>(seed);
    const auto swing = [=](double t) { return 0.6 + 0.4 * std::sin(kTurn * rate * t); };
    all.push_back({"wind", "made " + std::to_string(seed), sounds::blowing(4, kSoundRate, 0.1, swing, seed)});
  }
  return all;
}

std::vector<KnownSound> recorded_puffs() {
  std::vector<KnownSound> all = files("blow", "blow_mamez", "puff");
  for (KnownSound& one : files("blow", "blow_marsha", "puff")) {
    one.samples = {one.samples.begin() + static_cast<std::ptrdiff_t>(at(8.58 - 0.2)), one.samples.end()};
    all.push_back(one);
  }
  return all;
}

std::vector<KnownSound> other_sounds() {
  std::vector<KnownSound> all = speech();
  append(all, files("blow", "voice_blow", "speech"));
  for (const auto& [name, kind] : {std::pair{"esc10_sneeze", "sneeze"},
                                   {"esc10_clocktick", "clock"},
                                   {"esc10_firecrackle", "crackle"},
                                   {"esc10_babycry", "crying"}})
    append(all, files("other", name, kind));
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const double s = static_cast<double>(seed);
    const std::string name = "made " + std::to_string(seed);
    all.push_back({"music", name, music(seed, 0.35 + 0.07 * s, 0.3 * s)});
    all.push_back({"keyboard", name, keys(seed)});
    all.push_back({"clicks", name, clicks(seed)});
    all.push_back({"hiss", name, hiss(seed)});
    all.push_back({"handling", name, handling(seed)});
    all.push_back({"singing", name, singing(80 * s)});
    all.push_back({"knocks", name, sounds::knocks(10, kSoundRate, 0.4, seed)});
  }
  return all;
}

std::vector<KnownSound> steady_sounds() {
  std::vector<KnownSound> all;
  for (const char* kind : {"rain", "seawaves", "helicopter", "chainsaw"})
    append(all, files("other", std::string("esc10_") + kind, kind));
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const std::string name = "made " + std::to_string(seed);
    all.push_back({"traffic", name, traffic(seed)});
    all.push_back({"fan", name, sounds::steady_blowing(10, kSoundRate, 0.1, seed)});
  }
  return all;
}

}  // namespace wisp::verify
