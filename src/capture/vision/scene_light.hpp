#pragma once
// Whether a picture without the thing shows the scene that it stood in, or another one.
//
// Where a flame goes out its scene darkens, and nothing becomes brighter: a lamp that stood beside it stays. Where a
// film is cut to another scene, its light is where none was before.

#include <cstdint>
#include <vector>

#include "wisp/capture/vision/picture.hpp"

namespace wisp {

class SceneLight {
 public:
  /// Takes in a picture that shows the thing.
  void remember(const Picture& picture);

  /// Whether most of the light in a picture is where there was none in those that were taken in.
  bool another(const Picture& picture);

  /// Whether a bright thing, which fills a box, stands where it or another one already stood.
  bool knows(const Picture& picture, const Region& box);

 private:
  /// The light above the dark, in levels, and how much of it is where none was.
  struct Share {
    double light = 0;
    double fresh = 0;
  };
  void sample(const Picture& picture);
  Share share_in(const Region& box) const;

  std::vector<std::uint8_t> brightest_;  // luma of a coarse grid, at its brightest so far; empty: nothing was taken in
  std::vector<std::uint8_t> now_;
  int step_ = 1;  // pixels from point to point
  int columns_ = 0;
};

}  // namespace wisp
