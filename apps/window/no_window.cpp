// Replaces the window in builds without SDL2.

#include "window.hpp"

namespace wisp::window {

bool has_window() { return false; }

Result<PlayReport> play_in_window(const PlayOptions&) {
  return Error{
      "this build has no window: SDL2 was not found when it was made (package libsdl2-dev); --frames N --png "
      "DIR draws without one"};
}

}  // namespace wisp::window
