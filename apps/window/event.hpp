#pragma once
// User input as plain values, from SDL or from a script.

#include <string>
#include <string_view>
#include <variant>

#include "wisp/draw/image.hpp"

namespace wisp::window {

/// Keys with a function.
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

/// The pointer moved. Places are shares of the picture's width and height, from its top left.
struct PointerMoved {
  Point at{};
};

/// The pointer's button, or a finger, went down or up there.
struct PointerTurned {
  Point at{};
  bool down = true;
};

/// A file was dropped onto the window.
struct FileDropped {
  std::string path;
};

/// The microphone is gone: pulled out, or taken by the system.
struct MicrophoneLost {};

/// The window is asked to close.
struct Closed {};

using Event = std::variant<KeyTurned, PointerMoved, PointerTurned, FileDropped, MicrophoneLost, Closed>;

}  // namespace wisp::window
