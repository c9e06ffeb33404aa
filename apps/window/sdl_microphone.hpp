#pragma once
// A microphone, by SDL2.

#define SDL_MAIN_HANDLED
#include <SDL.h>

#include "ear.hpp"

namespace wisp::window {

class Microphone {
 public:
  Microphone() = default;
  ~Microphone() { close(); }
  Microphone(const Microphone&) = delete;
  Microphone& operator=(const Microphone&) = delete;

  /// Opens the system's default microphone and the ear for it. An ear that knew this room goes on with what it knew.
  /// Errors: there is none, or it may not be used.
  Result<void> open(Ear& ear);

  void close();

  bool is_open() const { return device_ != 0; }
  bool is(SDL_AudioDeviceID device) const { return device_ != 0 && device_ == device; }
  SDL_AudioDeviceID device() const { return device_; }

  /// Passes on what came since the last call.
  void pass_on(Ear& ear);

  /// Drops what came since the last call.
  void forget();

 private:
  SDL_AudioDeviceID device_ = 0;
  int channels_ = 1;
  std::vector<float> block_;
};

}  // namespace wisp::window
