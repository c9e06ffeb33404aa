#pragma once
// `wisp play`: the player in a window, or without a display for tests and pictures.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "player.hpp"

namespace wisp::window {

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
  int frames = 0;          ///< number of frames, of 1/60 s without a display; 0, for a window only: until it is closed
  bool microphone = true;  ///< open it at the window's start
  const volatile int* interrupted = nullptr;  ///< once its value is not 0, the play ends after the current frame
};

struct PlayReport {
  PlayerFigures figures{};
  std::vector<KeptPicture> pictures{};
  std::vector<std::string> said{};  ///< notices of a missing or lost microphone
  int drawn = 0;                    ///< number of frames
  double draw_ms = 0;               ///< processor time per frame for step and picture, mean
  double worst_draw_ms = 0;         ///< largest such time, except in the first ten frames
  std::string renderer{};           ///< renderer of the window; empty without one
  std::string state{};              ///< state at the end

  void add_frame(double milliseconds) {
    draw_ms += (milliseconds - draw_ms) / ++drawn;
    if (drawn > 10) worst_draw_ms = std::max(worst_draw_ms, milliseconds);
  }
};

/// Frames per second of scripts and of play without a display. Equal seeds give equal pictures on machines of one kind.
inline constexpr int kFrameRate = 60;

/// Samples per microphone block: 11 ms at 48 kHz.
inline constexpr int kSoundBlock = 512;

/// A script's request to save the current frame as NAME.png in the folder for pictures.
struct PictureTaken {
  std::string name;
};

struct TimedEvent {
  double seconds = 0;  ///< since the start
  std::variant<Event, PictureTaken> what;
};

/// Reads a script, which lists a person's actions at the window, with times, for tests and demonstrations;
/// docs/reference/window.md describes the file. Returns its events in the order of their times.
/// Errors: the file cannot be read; a line that is not `SECONDS WORD …`, named with its number and what was expected.
Result<std::vector<TimedEvent>> read_script(const std::filesystem::path& path);

/// Returns the time of a frame since the start, in whole nanoseconds without drift. Frames count from 1.
inline std::chrono::nanoseconds time_of_frame(int frame) {
  return std::chrono::nanoseconds(std::chrono::seconds(frame)) / kFrameRate;
}

/// Timed input to a player from files: a script's events, a sound file.
class Course {
 public:
  /// Opens the options' files and the player's ear. Errors: an invalid file, a folder for pictures that cannot be made.
  static Result<Course> open(const PlayOptions& options, Player& player);

  /// Delivers everything up to `seconds` since the start: events to `deliver`, sound to the player.
  void bring(double seconds, Player& player, const std::function<void(const Event&)>& deliver);

  /// Returns the names of the pictures that the last call of bring() requested.
  const std::vector<std::string>& wanted() const { return wanted_; }

  /// Returns whether the script requests any pictures.
  bool takes_pictures() const;

  bool scripted() const { return scripted_; }

 private:
  std::vector<TimedEvent> events_;
  std::size_t next_ = 0;
  std::vector<std::string> wanted_;
  bool scripted_ = false;
  std::optional<SoundFile> sound_;
};

/// Returns the name of a frame's picture without its ending: frame-00001, or more digits from frame 100,000 on.
inline std::string picture_name(int frame) {
  return "frame-" + (frame < 100'000 ? std::to_string(100'000 + frame).substr(1) : std::to_string(frame));
}

/// Returns this thread's processor time in milliseconds.
double thread_milliseconds();

/// Runs without a display, at most `frames` frames of 1/60 s. Writes into `pictures` every frame (frame-00001.png, …),
/// or, if the script takes pictures, only those. Files appear completely or not at all. Errors: an invalid model,
/// sound, script or folder; a picture cannot be written.
Result<PlayReport> play_without_display(const PlayOptions& options);

/// Returns whether this build has a window.
bool has_window();

/// Runs in a window until it is closed or the script ends it. With a script, time advances in frames of 1/60 s and
/// pictures are read back from the window. Errors: as play_without_display(); no display; no window in this build.
Result<PlayReport> play_in_window(const PlayOptions& options);

}  // namespace wisp::window
