#pragma once
// Timed input to a player from files: a script's events, a sound file. A script lists a person's actions at the window,
// with times, for tests and demonstrations; docs/reference/window.md describes the file.

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
  /// Opens the files in the options, and the player's ear for the sound.
  /// Errors: an invalid file, or the folder for pictures cannot be created.
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

/// Returns this thread's processor time in milliseconds.
double thread_milliseconds();

}  // namespace wisp::window
