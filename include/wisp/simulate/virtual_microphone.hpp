#pragma once
// A microphone at the candle: wind as it sounds when it blows on a capsule, hiss, and now and then a sound that is not
// wind.
//
// Source: R. Raspet, G. Webster et al. on wind noise as stagnation pressure, and its account in Acoustics Today (2021):
// pressure goes with the square of the wind, its spectrum is flat below a corner and falls steeply above.

#include <cstdint>
#include <memory>
#include <span>

#include "wisp/base/result.hpp"

namespace wisp {

/// The microphone.
struct VirtualMicrophoneOptions {
  double rate_hz = 44100;  ///< samples a second, 4000 … 192000
  double exponent = 2;     ///< amplitude ∝ wind^exponent, 0.5 … 4: 2 is stagnation pressure, a real chain outdoors
                           ///< was nearer to 1.5
  double level = 0.12;     ///< root mean square of the sound of 1 m/s, full scale 1, 1e-6 … 1; gusts go beyond 1 m/s
  double corner_hz = 300;  ///< the spectrum is flat below and falls with 12 dB an octave above, 20 … 5000
  double hiss = 4e-4;      ///< root mean square of the background, white, 0 … 0.1
  double hum = 0;          ///< amplitude of a 50 Hz hum, 0 … 0.1
  double other_sounds = 0.05;  ///< sounds that are not wind, a second on average, 0 … 10: half voice, half knocks
  double other_level = 0.05;   ///< their typical root mean square, 0 … 1
  std::uint64_t seed = 1;
};

/// Makes sound from wind, block by block. The same wind and seed give the same samples however the blocks are cut.
class VirtualMicrophone {
 public:
  /// Errors: an option outside its range.
  static Result<VirtualMicrophone> create(const VirtualMicrophoneOptions& options = {});

  VirtualMicrophone(VirtualMicrophone&&) noexcept;
  VirtualMicrophone& operator=(VirtualMicrophone&&) noexcept;
  ~VirtualMicrophone();

  /// The next sound.size() samples, mono, within ±1 (what is louder is clipped, as a recorder does). `wind` holds the
  /// wind in m/s at each of them; its sign does not matter.
  ///
  /// Precondition: wind.size() == sound.size().
  void hear(std::span<const float> wind, std::span<float> sound);

  /// Whether a voice or a knock sounded in the last block.
  bool other_sound() const;

 private:
  struct Parts;
  explicit VirtualMicrophone(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace wisp
