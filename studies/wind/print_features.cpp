// What likeness is fitted on: the features of every hop of every known sound, as CSV for tools/fit_blowing.py.

#include "sound/wind_kernel.hpp"
#include "studies/wind/blowing_sounds.hpp"
#include "studies/wind/verify_wind.hpp"

namespace wisp::verify {
namespace {

void print(const KnownSound& one, int blowing, double rms, double lows) {
  WindOptions options;
  wind::Kernel<float> kernel(wind::design({kSoundRate, 1}, options));
  sounds::Samples sound = sounds::room(0.5, kSoundRate, 1e-4);
  const sounds::Samples given = without_lows(at_rms(one.samples, rms), lows);
  sounds::add(sound, given, 0.5, kSoundRate);
  int hop = 0;
  for (const float x : sound) {
    if (!kernel.push(&x)) continue;
    const auto& f = kernel.features();
    if (++hop > 50 && f.loudness_db > -75)
      std::printf("%s,%s,%d,%.3f,%.0f,%d,%.2f,%.2f,%.3f,%.3f,%.3f,%.2f,%.2f,%.3f,%.4f,%.2f,%.4f\n", one.kind.c_str(),
                  one.from.c_str(), blowing, rms, lows, hop, f.low_db, f.high_db, f.voicing, f.tone, f.peaked,
                  f.voice_db, f.newest_db, f.flutter_db, f.clipped, f.loudness_db, kernel.likeness());
  }
}

}  // namespace

void print_features() {
  std::printf(
      "kind,from,blowing,rms,lows,hop,low,high,voicing,tone,peaked,voice,newest,flutter,clipped,loudness,likeness\n");
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const double low = 500 + 100 * static_cast<double>(seed % 7);
    const double high = 2200 + 300 * static_cast<double>(seed % 5);
    print({"hushed", "made " + std::to_string(seed), banded(made_blow(seed), low, high)}, 1, 0.2, 0);
  }
  // Brighter than most wind: falling by 6 dB an octave.
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    KnownSound one{"bright", "made " + std::to_string(seed), made_blow(seed + 30)};
    const double share = 1 - std::exp(-2 * std::numbers::pi * (300 + 50 * static_cast<double>(seed % 9)) / kSoundRate);
    double low = 0;
    for (float& x : one.samples) x = static_cast<float>(low += share * (static_cast<double>(x) - low));
    print(one, 1, 0.2, 0);
  }
  for (KnownSound one : blows()) {
    one.kind = "hushed";
    one.samples = banded(one.samples, 800, 3200);
    print(one, 1, 0.2, 0);
  }
  for (const double lows : {0.0, 80.0, 120.0, 200.0}) {
    for (const KnownSound& one : breaths()) print(one, 1, 0.03, lows);
    for (KnownSound one : blows()) {
      print(one, 1, 0.5, lows);
      print(one, 1, 1.5, lows);                                                                // the capsule overloads
      sounds::add(one.samples, sounds::steady_blowing(1, kSoundRate, 0.3, 7), 0, kSoundRate);  // a fan 10 dB below
      print(one, 1, 0.03, lows);
    }
    for (const KnownSound& one : puffs()) print(one, 1, 0.4, lows);
    for (const KnownSound& one : winds()) print(one, 1, 0.1, lows);
    for (const KnownSound& one : recorded_puffs()) {
      print(one, 1, 0.1, lows);
      print(one, 1, 0.7, lows);
    }
    for (const KnownSound& one : other_sounds()) {
      print(one, 0, 0.1, lows);
      print(one, 0, 0.5, lows);
    }
    for (const KnownSound& one : steady_sounds()) print(one, 0, 0.1, lows);
  }
}

}  // namespace wisp::verify
