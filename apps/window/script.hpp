#pragma once
// A script of events: what a person would do at the window, with times, for tests and demonstrations.
// docs/reference/window.md describes the file.

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "event.hpp"
#include "wisp/base/result.hpp"

namespace wisp::window {

/// A picture is kept: NAME.png in the folder for pictures.
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

}  // namespace wisp::window
