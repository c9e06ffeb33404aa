#pragma once
// Whether a picture without the thing shows the scene that it stood in, or another one.
//
// Where a flame goes out its scene darkens, and little becomes brighter: a lamp that stood beside it stays, and what
// puts it out is small. Where a film is cut to another scene, its light is where none was before.

#include <cstdint>
#include <vector>

#include "wisp/capture/vision/picture.hpp"

namespace wisp {

class SceneLight {
 public:
  /// Takes in a picture that shows the thing.
  void remember(const Picture& picture);

  /// Whether none was taken in.
  bool empty() const { return brightest_.empty(); }

  /// Whether most of the light in a picture is where there was none in those that were taken in.
  bool another(const Picture& picture);

 private:
  void sample(const Picture& picture);

  std::vector<std::uint8_t> brightest_;  // luma of a coarse grid, at its brightest so far; empty: nothing was taken in
  std::vector<std::uint8_t> now_;
};

}  // namespace wisp
