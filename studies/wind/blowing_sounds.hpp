#pragma once
// Sounds for the checks of blowing: recordings of breath and puffs, puffs made here, and what is neither. All at one
// rate, mono.

#include <string>
#include <vector>

#include "sound/wind_sounds.hpp"

namespace wisp::verify {

constexpr double kSoundRate = 48000;

/// A sound, of what kind it is, and from what recording: what is held out is held out with all that was cut from it.
struct KnownSound {
  std::string kind;  ///< breath, puff, speech, music, traffic, rain, ...
  std::string from;
  sounds::Samples samples;
};

/// Recordings of breathing out, whole.
std::vector<KnownSound> breaths();

/// Seconds of hard blowing cut from the breaths, RMS 1: the loudest second of each gust.
std::vector<KnownSound> blows();

/// Puffs by lips at the microphone, made here: low-frequency bursts with broadband turbulence, which overload it.
std::vector<KnownSound> puffs();

/// Gusts on a capsule that stands in the wind, made here.
std::vector<KnownSound> winds();

/// Recorded puffs, cut out.
std::vector<KnownSound> recorded_puffs();

/// What comes and goes and is no blowing: speech, music, keys, handling, and those recordings that are short sounds.
std::vector<KnownSound> other_sounds();

/// What goes on and on: rain, sea, engines, fan, traffic.
std::vector<KnownSound> steady_sounds();

/// The sound without what is below a frequency (second order); 0: as it is.
sounds::Samples without_lows(const sounds::Samples& sound, double frequency_hz);

/// What a microphone passes of it that has this band alone (fourth order at either end).
sounds::Samples banded(const sounds::Samples& sound, double low_hz, double high_hz);

/// Noise with the course of a hard blow.
sounds::Samples made_blow(std::uint64_t seed);

/// Scales so that the seconds in which it sounds (above a tenth of its 95th percentile) have this RMS; within ±1.
sounds::Samples at_rms(sounds::Samples sound, double rms);

}  // namespace wisp::verify
