#pragma once
// Input that reaches a player as time passes, from files: a script's events, a sound file. A script says what a
// person would do at the window, with times, for tests and demonstrations; docs/reference/window.md describes the file.

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "window.hpp"

namespace wisp::window {

/// Saves the frame as NAME.png in the folder for pictures.
struct PictureTaken {
  std::string name;
};

struct TimedEvent {
  double seconds = 0;  ///< since the start
  std::variant<Event, PictureTaken> what;
};

/// Reads a script. Returns its events in the order of their times.
/// Errors: the file cannot be read; a line that is not `SECONDS WORD …`, named with its number and what was expected.
Result<std::vector<TimedEvent>> read_script(const std::filesystem::path& path);

/// Returns the time of a frame since the start, in whole nanoseconds without drift. Frames count from 1.
inline std::chrono::nanoseconds time_of_frame(int frame) {
  return std::chrono::nanoseconds(std::chrono::seconds(frame)) / kFrameRate;
}

class Course {
 public:
  /// Opens what the options name, and the player's ear for the sound.
  /// Errors: a file is bad, the folder for pictures cannot be made.
  static Result<Course> open(const PlayOptions& options, Player& player);

  /// Passes on everything up to `seconds` since the start: events to `deliver`, sound to the player.
  void bring(double seconds, Player& player, const std::function<void(const Event&)>& deliver);

  /// Names of the pictures that the last call of bring() requested.
  const std::vector<std::string>& wanted() const { return wanted_; }

  /// Whether the script asks for pictures at all.
  bool takes_pictures() const;

  bool scripted() const { return scripted_; }

 private:
  std::vector<TimedEvent> events_;
  std::size_t next_ = 0;
  std::vector<std::string> wanted_;
  bool scripted_ = false;
  std::optional<SoundFile> sound_;
};

/// Milliseconds of the processor that this thread has used.
double thread_milliseconds();

}  // namespace wisp::window
