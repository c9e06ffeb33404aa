#pragma once
// `wisp play`: the player in a window, or without any display for tests and pictures.

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "player.hpp"

namespace wisp::window {

/// A saved picture.
struct KeptPicture {
  std::string name;
  int frame = 0;      ///< counted from 1
  std::string state;  ///< Player::state()
};

struct PlayOptions {
  PlayerOptions player{};
  std::optional<std::string> sound{};               ///< a sound file in place of the microphone
  std::optional<std::filesystem::path> script{};    ///< events with times
  std::optional<std::filesystem::path> pictures{};  ///< folder for pictures
  int frames = 0;          ///< without a display: how many of 1/60 s; in a window: 0, until it is closed
  bool microphone = true;  ///< a window opens it at its start
  const volatile int* interrupted = nullptr;  ///< not 0: end after the frame
};

/// The result of a run.
struct PlayReport {
  PlayerFigures figures{};
  std::vector<KeptPicture> pictures{};
  std::vector<std::string> said{};  ///< notices: no microphone, no vertical sync
  int drawn = 0;                    ///< frames
  double draw_ms = 0;               ///< of the processor, mean of a frame's step and picture
  double worst_draw_ms = 0;         ///< but for the first ten frames
  std::string renderer{};           ///< of the window; empty without one
  std::string state{};              ///< at the end

  /// Takes in the cost of a frame.
  void add_frame(double milliseconds) {
    draw_ms += (milliseconds - draw_ms) / ++drawn;
    if (drawn > 10) worst_draw_ms = std::max(worst_draw_ms, milliseconds);
  }
};

/// Frames a second of scripts and of pictures without a display: the same bytes for the same seed on every machine of
/// one kind.
inline constexpr int kFrameRate = 60;

/// Samples of a microphone's block: 11 ms at 48 kHz.
inline constexpr int kSoundBlock = 512;

/// Runs without a display, `frames` frames of 1/60 s. Writes every frame into `pictures` (frame-00001.png, …), or,
/// where the script takes pictures, those. Files appear whole or not at all.
/// Errors: a model, sound, script or folder is bad; a picture cannot be written.
Result<PlayReport> play_without_display(const PlayOptions& options);

/// Whether this build has a window.
bool has_window();

/// Runs in a window until it is closed, or until the script says so. With a script, time goes in frames of 1/60 s and
/// pictures are read back from the window.
/// Errors: as play_without_display(); no display; no window in this build.
Result<PlayReport> play_in_window(const PlayOptions& options);

}  // namespace wisp::window
