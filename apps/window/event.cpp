#include "event.hpp"

#include <array>
#include <utility>

namespace wisp::window {

Key key_named(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, Key>, 17> kNames{{
      {"left", Key::kLeft},
      {"right", Key::kRight},
      {"up", Key::kUp},
      {"down", Key::kDown},
      {"space", Key::kSpace},
      {"enter", Key::kEnter},
      {"tab", Key::kTab},
      {"plus", Key::kPlus},
      {"minus", Key::kMinus},
      {"c", Key::kC},
      {"g", Key::kG},
      {"h", Key::kH},
      {"m", Key::kM},
      {"n", Key::kN},
      {"q", Key::kQ},
      {"r", Key::kR},
      {"f11", Key::kF11},
  }};
  for (const auto& [word, key] : kNames) {
    if (word == name) return key;
  }
  return Key::kNone;
}

}  // namespace wisp::window
