#pragma once
// Input of a scene: user events as plain values, from SDL or from a script; wind from keys and from the pointer; sound.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/capture/media/sound.hpp"
#include "wisp/draw/image.hpp"
#include "wisp/sound/wind_level.hpp"

namespace wisp::window {

enum class Key {
  kLeft,
  kRight,
  kUp,
  kDown,
  kSpace,
  kEnter,
  kTab,
  kPlus,
  kMinus,
  kC,
  kG,
  kH,
  kM,
  kN,
  kQ,
  kR,
  kF11,
  kNone,  ///< any other
};

/// Returns the key that scripts call `name` ("left", "space", "c", "f11", …); kNone for an unknown name.
Key key_named(std::string_view name);

/// A key went down or up. Repeats by holding it down are not events.
struct KeyTurned {
  Key key = Key::kNone;
  bool down = true;
};

/// The pointer moved. Positions are shares of the picture's width and height, from its top left.
struct PointerMoved {
  Point at{};
};

/// The pointer's button, or a finger, went down or up. The position is as in PointerMoved.
struct PointerTurned {
  Point at{};
  bool down = true;
};

/// The pointer left the picture, or the finger that moved it was lifted. Its next position is no motion.
struct PointerLeft {};

struct FileDropped {
  std::string path;
};

/// The microphone was lost: unplugged, or taken by the system.
struct MicrophoneLost {};

struct Closed {};

using Event = std::variant<KeyTurned, PointerMoved, PointerTurned, PointerLeft, FileDropped, MicrophoneLost, Closed>;

/// Returns the exponential approach from `from` to `to` after `seconds`, with time constant `within`.
inline float towards(float from, float to, float seconds, float within) {
  return to + (from - to) * std::exp(-seconds / within);
}

/// Wind from keys: arrows blow while held, a puff is strong and short. Positive blows to the right; 1: a strong gust.
class KeyWind {
 public:
  /// Sets the direction of the held arrows: −1 left, 0 none or both, 1 right.
  void hold(int direction) { direction_ = direction; }

  /// Starts a strong blow of `strength`, from the left unless the left arrow is held.
  void puff(float strength) {
    puff_peak_ = direction_ < 0 ? -strength : strength;
    puff_age_ = 0;
  }

  void advance(float seconds) {
    constexpr float kArrowWind = 0.75F, kArrowSeconds = 0.18F, kRise = 0.10F, kHold = 0.55F, kFall = 0.25F;
    held_ = towards(held_, kArrowWind * static_cast<float>(direction_), seconds, kArrowSeconds);
    puff_age_ += seconds;
    const float rise = std::clamp(puff_age_ / kRise, 0.0F, 1.0F);
    puff_ = puff_peak_ * std::min(rise, std::clamp((kRise + kHold + kFall - puff_age_) / kFall, 0.0F, 1.0F));
  }

  float wind() const { return held_ + puff_; }

  /// Stops all wind at once.
  void calm() { *this = {}; }

 private:
  int direction_ = 0;
  float held_ = 0;
  float puff_ = 0;
  float puff_peak_ = 0;
  float puff_age_ = 10;
};

/// The wind behind a moving pointer: the pointer's own speed, decaying at rest. Lengths are in the scene's unit.
class PointerWake {
 public:
  void move(Point at) {
    if (last_) moved_ = {moved_.x + at.x - last_->x, moved_.y + at.y - last_->y};
    last_ = at;
    at_ = at;
  }

  /// Ends the pointer's motion; its wake decays.
  void leave() { last_.reset(); }

  /// Advances the wake, which follows the pointer at once and decays slowly.
  void advance(float seconds) {
    if (seconds <= 0) return;
    const auto drag = [&](float speed, float pulled) {
      const float resting = towards(speed, 0, seconds, 0.16F);
      return std::abs(pulled) > std::abs(resting) ? towards(speed, pulled, seconds, 0.03F) : resting;
    };
    speed_ = {drag(speed_.x, moved_.x / seconds), drag(speed_.y, moved_.y / seconds)};
    moved_ = {};
  }

  Point at() const { return at_; }

  /// Returns the speed in lengths per second.
  Point speed() const { return speed_; }

 private:
  std::optional<Point> last_;
  Point at_{};
  Point moved_{};
  Point speed_{};
};

enum class EarState {
  kOff,  ///< not switched on, or switched off again
  kListening,
  kMissing,  ///< there is no microphone, or it was lost
};

/// Wind frames per second: twice a screen's, so that the newest wind is at most half a screen frame old.
inline constexpr double kWindRate = 120;

/// Estimates the wind in a stream of sound.
class Ear {
 public:
  /// Starts listening. Errors: those of WindLevel::create().
  Result<void> open(const SoundFormat& format) {
    auto level = WindLevel::create(format, {.frame_rate_hz = kWindRate});
    if (!level) return level.error();
    level_.emplace(std::move(*level));
    return {};
  }

  /// Stops listening; the wind is then 0.
  void close(EarState state = EarState::kOff) {
    level_.reset();
    closed_ = state;
  }

  /// Takes interleaved samples. Ignored while closed.
  void hear(std::span<const float> samples) {
    if (!level_) return;
    std::array<WindFrame, 64> frames;
    while (!samples.empty()) {
      const WindFed fed = level_->feed(samples, frames);
      if (fed.samples == 0 && fed.frames == 0) return;
      samples = samples.subspan(fed.samples);
    }
  }

  /// Returns the current wind, 1 a strong gust; 0 unless listening.
  float wind() const { return level_ ? level_->latest().wind : 0.0F; }

  EarState state() const { return level_ ? EarState::kListening : closed_; }

 private:
  std::optional<WindLevel> level_;
  EarState closed_ = EarState::kOff;
};

/// A sound file in place of a microphone: its samples arrive in real time, then a second of silence that ends its wind.
class SoundFile {
 public:
  /// Reads a file. Errors: those of stream_sound(), or a file without sound.
  static Result<SoundFile> open(const std::string& path) {
    SoundFile file;
    const auto sound = stream_sound(path, [&](const SoundInfo& info, std::span<const float> samples) {
      file.format_ = {.rate_hz = info.rate_hz, .channels = info.channels};
      file.samples_.insert(file.samples_.end(), samples.begin(), samples.end());
      return true;
    });
    if (!sound) return sound.error();
    if (file.samples_.empty()) return Error{path + ": holds no samples; expected the sound of blowing"};
    file.samples_.resize(file.samples_.size() + static_cast<std::size_t>(file.format_.rate_hz * file.format_.channels));
    return file;
  }

  const SoundFormat& format() const { return format_; }

  /// Returns the samples up to that time since the start, in complete blocks of `block` samples per channel, as from a
  /// microphone. The span is valid until the next call.
  std::span<const float> until(double seconds, int block) {
    const auto channels = static_cast<std::size_t>(format_.channels);
    const auto blocks = static_cast<std::size_t>(std::max(0.0, seconds * format_.rate_hz / block + 1e-9));
    const std::size_t end = std::min(samples_.size(), blocks * static_cast<std::size_t>(block) * channels);
    if (end <= taken_) return {};
    const std::span<const float> fresh(samples_.data() + taken_, end - taken_);
    taken_ = end;
    return fresh;
  }

 private:
  SoundFormat format_;
  std::vector<float> samples_;
  std::size_t taken_ = 0;  // samples of all channels
};

}  // namespace wisp::window
