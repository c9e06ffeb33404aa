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
#include "wisp/simulate/candle_clip.hpp"

namespace wisp {

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

 private:
  struct Parts;
  explicit VirtualMicrophone(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace wisp
