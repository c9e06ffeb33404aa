#include "sdl_microphone.hpp"

#include <algorithm>

#include "silence.hpp"
#include "window.hpp"

namespace wisp::window {
namespace {

// What waits longer than this is old: the window slept.
constexpr Uint32 kMaxWaitingBytes = 4 * 48000 / 2;

}  // namespace

Result<void> Microphone::open(Ear& ear) {
  close();
  const Silence silence;
  const char* otherwise = "; arrows, space and the pointer blow too";
  if (SDL_InitSubSystem(SDL_INIT_AUDIO) != 0) return Error{std::string("no microphone: ") + SDL_GetError() + otherwise};
  SDL_AudioSpec wanted{}, got{};
  wanted.freq = 48000;
  wanted.format = AUDIO_F32SYS;
  wanted.channels = 1;
  wanted.samples = kSoundBlock;
  device_ = SDL_OpenAudioDevice(nullptr, 1, &wanted, &got, SDL_AUDIO_ALLOW_FREQUENCY_CHANGE);
  if (device_ == 0) return Error{std::string("no microphone: ") + SDL_GetError() + otherwise};
  channels_ = std::max<int>(1, got.channels);
  if (auto ok = ear.open({.rate_hz = static_cast<double>(got.freq), .channels = channels_}); !ok) {
    close();
    return Error{"no microphone: " + ok.error().message + otherwise};
  }
  SDL_PauseAudioDevice(device_, 0);
  return {};
}

void Microphone::close() {
  if (device_ != 0) SDL_CloseAudioDevice(device_);
  device_ = 0;
}

void Microphone::pass_on(Ear& ear) {
  if (device_ == 0) return;
  block_.resize(static_cast<std::size_t>(kSoundBlock) * channels_);
  if (SDL_GetQueuedAudioSize(device_) > kMaxWaitingBytes) SDL_ClearQueuedAudio(device_);
  for (;;) {
    const Uint32 bytes = SDL_DequeueAudio(device_, block_.data(), static_cast<Uint32>(4 * block_.size()));
    const std::size_t samples = bytes / 4 / channels_ * channels_;
    if (samples == 0) return;
    ear.hear(std::span(block_).first(samples));
  }
}

void Microphone::forget() {
  if (device_ != 0) SDL_ClearQueuedAudio(device_);
}

}  // namespace wisp::window
