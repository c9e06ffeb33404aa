#pragma once
// Which scenes capture is tried on.

#include <string>
#include <vector>

#include "studies/scenes/scene.hpp"

namespace wisp::scenes {

/// A name that begins with what is tried, and says how.
struct Named {
  std::string name;
  Scene scene;
};

/// One difficulty each, and what a person would not call filmable. Capture was tuned on them.
std::vector<Named> tuning_scenes();

/// Scenes drawn at random: flames of other shapes, colours and movements, several difficulties at once.
std::vector<Named> fresh_scenes(unsigned seed);

}  // namespace wisp::scenes
