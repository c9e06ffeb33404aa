#pragma once
// What comes to a player as time passes from files: a script's events, a WAV file's sound.

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "script.hpp"
#include "window.hpp"

namespace wisp::window {

/// When a frame of a fixed rate is shown, since the start: whole nanoseconds, without drift. Frames count from 1.
inline std::chrono::nanoseconds time_of_frame(int frame) {
  return std::chrono::nanoseconds(std::chrono::seconds(frame)) / kFrameRate;
}

class Course {
 public:
  /// Opens what the options name, and the player's ear for the sound.
  /// Errors: a file is bad, the folder for pictures cannot be made.
  static Result<Course> open(const PlayOptions& options, Player& player);

  /// Brings what falls into the time up to `seconds` since the start: events go to `deliver`, sound to the player.
  void bring(double seconds, Player& player, const std::function<void(const Event&)>& deliver);

  /// Names of pictures that were requested in the time brought last.
  const std::vector<std::string>& wanted() const { return wanted_; }

  /// Whether the script asks for pictures at all.
  bool takes_pictures() const { return takes_pictures_; }

  bool scripted() const { return scripted_; }

 private:
  std::vector<TimedEvent> events_;
  std::size_t next_ = 0;
  std::vector<std::string> wanted_;
  bool takes_pictures_ = false;
  bool scripted_ = false;
  std::optional<SoundFile> sound_;
};

/// Milliseconds of the processor that this thread has used.
double thread_milliseconds();

/// Means of what frames cost.
class FrameCosts {
 public:
  void add(double milliseconds);
  void report(PlayReport& report) const;

 private:
  int frames_ = 0;
  double sum_ = 0, worst_ = 0;
};

}  // namespace wisp::window
