// Blowing or talking: real breath, speech from espeak-ng in many voices, and sounds that are neither, at several rates
// and after high-passes and noise as microphones have them.

#include <functional>
#include <random>

#include "capture/support/whole_sound.hpp"
#include "sound/wind_sounds.hpp"
#include "studies/wind/verify_wind.hpp"
#include "wisp/sound/wind_level.hpp"
#include "wisp/sound/wind_track.hpp"

namespace wisp::verify {
namespace {

using Samples = std::vector<float>;

constexpr double kRates[] = {16000, 44100, 48000};

struct Voice {
  const char* name;
  const char* text;
};

constexpr const char* kEnglish =
    "The candle on the table leans when somebody walks past, and it takes a moment until it stands upright again. "
    "Please put the peppers and five thin fish in the basket. Who has seen the wind?";
constexpr const char* kCounting =
    "Testing, one, two, three, four, five, six, seven, eight, nine, ten. Blow gently, then stop; I shall count while "
    "you "
    "breathe. Papa bought a big blue balloon for Bobby, but the puppy popped it. Yes! No? Hello there.";
constexpr const char* kGerman =
    "Die Kerze auf dem Tisch neigt sich, wenn jemand vorbeigeht, und braucht einen Augenblick, bis sie wieder aufrecht "
    "steht. Pfeffer und frische Fische, bitte.";
constexpr const char* kFrench =
    "La bougie sur la table penche quand on passe, et il lui faut un moment pour se redresser. Cinq petits poissons "
    "frais.";
constexpr const char* kSpanish =
    "La vela sobre la mesa se inclina cuando alguien pasa, y tarda un momento en ponerse derecha.";
constexpr const char* kItalian =
    "La candela sul tavolo si piega quando qualcuno passa, e le serve un momento per raddrizzarsi.";

constexpr Voice kVoices[] = {
    {"en-us", kEnglish},     {"en-us+f2", kEnglish},  {"en-us+m3", kEnglish},     {"en-us+f4", kEnglish},
    {"en-gb+m1", kEnglish},  {"en-gb+f1", kEnglish},  {"en-gb+m7", kEnglish},     {"en-us+klatt2", kEnglish},
    {"en-us+m5", kEnglish},  {"en-us+f3", kCounting}, {"en-us+m2", kCounting},    {"en-gb+f5", kCounting},
    {"en-gb+m4", kCounting}, {"en-us+m6", kCounting}, {"en-us+croak", kCounting}, {"en-us+klatt4", kCounting},
    {"de", kGerman},         {"de+f2", kGerman},      {"de+m2", kGerman},         {"fr", kFrench},
    {"fr+f3", kFrench},      {"es", kSpanish},        {"es+f4", kSpanish},        {"it+m3", kItalian},
};

/// A second-order Butterworth high-pass, as a microphone's chain has one.
Samples high_passed(const Samples& sound, double rate_hz, double frequency_hz) {
  const double w = 2 * std::numbers::pi * frequency_hz / rate_hz;
  const double alpha = std::sin(w) / std::numbers::sqrt2;
  const double a0 = 1 + alpha;
  const double b = (1 + std::cos(w)) / 2 / a0;
  double x1 = 0;
  double x2 = 0;
  double y1 = 0;
  double y2 = 0;
  Samples out;
  for (const float sample : sound) {
    const double x = static_cast<double>(sample);
    const double y = b * (x - 2 * x1 + x2) + 2 * std::cos(w) / a0 * y1 - (1 - alpha) / a0 * y2;
    x2 = x1;
    x1 = x;
    y2 = y1;
    y1 = y;
    out.push_back(static_cast<float>(y));
  }
  return out;
}

/// White noise 40 dB below the sound's RMS while it sounds.
Samples with_noise(Samples sound, double rate_hz) {
  double power = 0;
  double count = 0;
  for (const float x : sound) {
    if (std::abs(x) < 1e-4F) continue;
    power += static_cast<double>(x * x);
    count += 1;
  }
  const double seconds = static_cast<double>(sound.size()) / rate_hz;
  Samples noise = sounds::room(seconds + 0.1, rate_hz, 0.01 * std::sqrt(power / std::max(count, 1.0)));
  for (std::size_t i = 0; i < sound.size(); ++i) sound[i] += noise[i];
  return sound;
}

struct Chain {
  const char* name;
  std::function<Samples(const Samples&, double)> pass;
};

const std::vector<Chain>& chains() {
  static const std::vector<Chain> all{
      {"plain", [](const Samples& x, double) { return x; }},
      {"high-pass 120", [](const Samples& x, double rate) { return high_passed(x, rate, 120); }},
      {"noise -40 dB", [](const Samples& x, double rate) { return with_noise(x, rate); }},
  };
  return all;
}

std::vector<WindFrame> live_frames(const Samples& sound, double rate_hz) {
  auto level = WindLevel::create({rate_hz, 1});
  if (!level) std::abort();
  std::vector<WindFrame> frames(static_cast<std::size_t>(static_cast<double>(sound.size()) / rate_hz * 60) + 2);
  frames.resize(level->feed(std::span<const float>(sound), frames).frames);
  return frames;
}

/// Share of frames that hold among those that count.
template <class Counts, class Holds>
double share(const std::vector<WindFrame>& frames, Counts counts, Holds holds) {
  double all = 0;
  double held = 0;
  for (const WindFrame& frame : frames) {
    if (!counts(frame)) continue;
    all += 1;
    held += holds(frame) ? 1 : 0;
  }
  return all > 0 ? held / all : 1;
}

const auto kAny = [](const WindFrame&) { return true; };
const auto kNotBlowing = [](const WindFrame& frame) { return frame.confidence < 0.2F; };

/// Spoken by espeak-ng; empty where it is not installed.
std::vector<support::Sound> spoken() {
  std::vector<support::Sound> all;
  if (std::system("espeak-ng --version >/dev/null 2>&1") != 0) return all;
  const auto file = std::filesystem::temp_directory_path() / "wisp-verify-wind-voice.wav";
  for (const Voice& voice : kVoices) {
    const std::string command =
        std::string("espeak-ng -v ") + voice.name + " -w '" + file.string() + "' \"" + voice.text + "\"";
    if (std::system(command.c_str()) != 0) continue;
    auto sound = support::read_sound(file);
    if (sound && *sound) all.push_back(std::move(**sound));
  }
  std::filesystem::remove(file);
  return all;
}

void speech(Bounds& bounds) {
  std::printf("\n== Speech (espeak-ng): share of frames of 1/60 s with confidence below 0.2\n");
  const std::vector<support::Sound> voices = spoken();
  if (voices.empty()) {
    std::printf("  skipped: espeak-ng is not installed\n");
    return;
  }
  double seconds = 0;
  for (const support::Sound& voice : voices) seconds += static_cast<double>(voice.samples.size()) / voice.info.rate_hz;
  std::printf("  %zu voices, %.0f s\n  rate    chain           all     sounding  worst voice  above 0.5\n",
              voices.size(), seconds);
  double worst = 1;
  for (const double rate : kRates) {
    for (const Chain& chain : chains()) {
      std::vector<WindFrame> all;
      double worst_voice = 1;
      for (const support::Sound& voice : voices) {
        const auto frames = live_frames(chain.pass(resampled(voice.samples, voice.info.rate_hz, rate), rate), rate);
        worst_voice = std::min(worst_voice, share(frames, kAny, kNotBlowing));
        all.insert(all.end(), frames.begin(), frames.end());
      }
      // Sounding: 15 dB above the estimator's own background.
      const auto sounds = [](const WindFrame& f) { return f.rms > 5.6F * std::max(f.background, 3e-5F); };
      const double sounding = share(all, sounds, kNotBlowing);
      worst = std::min({worst, sounding, worst_voice});
      std::printf("  %5.0f   %-14s  %.4f  %.4f    %.4f       %.4f\n", rate, chain.name, share(all, kAny, kNotBlowing),
                  sounding, worst_voice, share(all, kAny, [](const WindFrame& f) { return f.confidence > 0.5F; }));
    }
  }
  bounds.at_least("speech below 0.2: worst rate, chain and voice", worst, 0.95);
}

void breath(Bounds& bounds) {
  std::printf("\n== Breath: share of frames with confidence above 0.8, from 15 dB above the floor\n");
  const auto sound = support::read_sound(data_folder() / "sound" / "breath_normal.wav");
  if (!sound) {
    std::printf("  skipped: %s\n", sound.error().message.c_str());
    return;
  }
  std::printf("  rate    chain           live    live after 1.1 s  recording known\n");
  double worst = 1;
  for (const double rate : kRates) {
    const Samples original = resampled((*sound)->samples, (*sound)->info.rate_hz, rate);
    for (const Chain& chain : chains()) {
      const Samples heard = chain.pass(original, rate);
      const auto track = wind_from_sound(heard, {rate, 1});
      if (!track) std::abort();
      // The floor is that of the whole recording for both, although the live estimator cannot know it in the first
      // gust.
      const float floor = std::max(track->calibration.background_rms, 3e-5F);  // −90 dB: the file is gated in its gaps
      const auto loud = [&](const WindFrame& f) { return f.rms > 5.6F * floor; };
      const auto sure = [](const WindFrame& f) { return f.confidence > 0.8F; };
      auto frames = live_frames(heard, rate);
      const double live = share(frames, loud, sure), known = share(track->frames, loud, sure);
      // The recording begins in a breath, which is the room until it pauses: nobody has to be still before.
      frames.erase(frames.begin(), frames.begin() + 66);
      const double later = share(frames, loud, sure);
      worst = std::min({worst, live, known});
      std::printf("  %5.0f   %-14s  %.3f   %.3f             %.3f\n", rate, chain.name, live, later, known);
    }
  }
  bounds.at_least("breath above 0.8: worst rate and chain", worst, 0.85);
}

Samples humming(double rate_hz, double pitch_hz) {
  Samples out(sounds::count(12, rate_hz), 0.0F);
  double phase = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double t = static_cast<double>(i) / rate_hz;
    phase += 2 * std::numbers::pi * pitch_hz * (1 + 0.01 * std::sin(2 * std::numbers::pi * 5 * t)) / rate_hz;
    const bool on = std::fmod(t, 2) < 1.5;
    if (on)
      out[i] = static_cast<float>(0.1 * (std::sin(phase) + 0.2 * std::sin(2 * phase) + 0.05 * std::sin(3 * phase)));
  }
  return out;
}

Samples key_clicks(double rate_hz) {
  Samples out(sounds::count(12, rate_hz), 0.0F);
  sounds::Chance chance(9);
  for (double at = 0.2; at < 11.5; at += 0.08 + 0.25 * chance.uniform()) {
    for (std::size_t i = 0; i < sounds::count(0.03, rate_hz); ++i) {
      const double t = static_cast<double>(i) / rate_hz;
      out[sounds::count(at, rate_hz) + i] += static_cast<float>(0.05 * chance.normal() * std::exp(-t / 0.005));
    }
  }
  return out;
}

/// No bounds: what fools it, for docs/studies/wind.md.
void others() {
  std::printf("\n== Neither (made here, in a quiet room, 44.1 kHz): share below 0.2, above 0.5, mean wind\n");
  const double rate = 44100;
  const auto room = [&](Samples sound) {
    sounds::add(sound, sounds::room(12, rate, 3e-4), 0, rate);
    return sound;
  };
  Samples fan = sounds::room(3, rate, 0);
  sounds::add(fan, sounds::steady_blowing(40, rate, 0.01), 3, rate);
  const struct {
    const char* name;
    Samples sound;
  } all[] = {{"knocks", room(sounds::knocks(12, rate, 0.4))},
             {"key clicks", room(key_clicks(rate))},
             {"bass chords", room(sounds::chords(12, rate, 0.05))},
             {"humming, 90 Hz", room(humming(rate, 90))},
             {"humming, 140 Hz", room(humming(rate, 140))},
             {"humming, 220 Hz", room(humming(rate, 220))},
             {"hiss switched on", room(sounds::room(12, rate, 0.01, 5))},
             {"fan, first 40 s", room(fan)}};
  for (const auto& one : all) {
    const auto frames = live_frames(one.sound, rate);
    double wind = 0;
    for (const WindFrame& frame : frames) wind += static_cast<double>(frame.wind);
    std::printf("  %-18s %.3f  %.3f  %.3f\n", one.name, share(frames, kAny, kNotBlowing),
                share(frames, kAny, [](const WindFrame& f) { return f.confidence > 0.5F; }),
                wind / static_cast<double>(frames.size()));
  }
}

}  // namespace

void confidence(Bounds& bounds) {
  breath(bounds);
  speech(bounds);
  others();
}

}  // namespace wisp::verify
