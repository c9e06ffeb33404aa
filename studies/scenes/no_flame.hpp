#pragma once
// Films without a flame: what people point a camera at, or a detector falls for.

#include <cstdint>
#include <string>
#include <vector>

namespace wisp::scenes {

/// A film without a flame. Its kind says what is to be seen; everything else is drawn from the seed.
struct NoFlame {
  std::string kind;
  unsigned seed = 0;
  int width = 240;
  int height = 200;
  int frames = 75;
  double rate_hz = 25;
};

/// The kinds: street, cartoon, tree, sky, pane, lamp, bulb, dimmed, cup, fireworks, glow, flag.
std::vector<std::string> no_flame_kinds();

/// Frame k, packed RGB; the same whenever it is asked for.
std::vector<std::uint8_t> film(const NoFlame& scene, int k);

}  // namespace wisp::scenes
