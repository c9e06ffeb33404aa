#pragma once
// A microphone at the candle: sound of wind on its capsule, hiss, and occasional sounds other than wind.
//
// Source: R. Raspet, G. Webster et al. on wind noise as stagnation pressure, and its account in Acoustics Today (2021):
// pressure is proportional to the square of the wind, its spectrum is flat below a corner and falls steeply above.

#include <memory>
#include <span>

#include "wisp/base/result.hpp"
#include "wisp/simulate/candle_clip.hpp"

namespace wisp {

/// Makes sound from wind, block by block. Equal wind and seed give equal samples for any division into blocks.
class VirtualMicrophone {
 public:
  /// Errors: an option outside its range.
  static Result<VirtualMicrophone> create(const VirtualMicrophoneOptions& options = {});

  VirtualMicrophone(VirtualMicrophone&&) noexcept;
  VirtualMicrophone& operator=(VirtualMicrophone&&) noexcept;
  ~VirtualMicrophone();

  /// Makes the next sound.size() samples, mono, clipped to ±1, as by a recorder. `wind` holds the wind in m/s at each
  /// of them; its sign does not matter.
  ///
  /// Precondition: wind.size() == sound.size().
  void hear(std::span<const float> wind, std::span<float> sound);

 private:
  struct Parts;
  explicit VirtualMicrophone(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace wisp
