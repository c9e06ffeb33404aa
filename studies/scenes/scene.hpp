#pragma once
// Scenes with a flame whose outline is known: what a camera sees of a burning candle and what it lights.

#include <cstdint>
#include <vector>

#include "capture/support/overlap.hpp"
#include "wisp/capture/vision/picture.hpp"

namespace wisp::scenes {

/// A colour as light, linear; 1 is what the camera just clips.
struct Light {
  double r = 0;
  double g = 0;
  double b = 0;
};

/// What is in the picture.
struct Scene {
  int width = 240;
  int height = 200;
  int frames = 60;
  double rate_hz = 30;
  double flame_height = 80;   ///< pixels, of the calm flame
  double brightness = 4;      ///< of the flame's core, as light
  double base_x = 0.5;        ///< where it stands, share of the width
  double base_y = 0.7;        ///< … and of the height
  double liveliness = 1;      ///< how far it moves; 0 stands still
  double slenderness = 0.16;  ///< half of its width, share of its height
  double bluntness = 1.8;     ///< of its tip: 1 a straight point, 3 nearly round
  double rim = 1;             ///< pixels over which it ends: a lens out of focus
  Light colour{1, 0.82, 0.45};
  double phase = 0;          ///< of all its movements: another flame of the same kind
  Light wax;                 ///< colour of the wax; black: none in view
  double halo = 0;           ///< light around the flame, share of its own
  double wall = 0;           ///< light of the wall behind, by the flame
  double window = 0;         ///< light of a window, by day
  double room = 0.004;       ///< light everywhere
  bool glass = false;        ///< the flame is mirrored in a glass behind it
  double glass_aside = 0.5;  ///< how far beside the flame, of its height
  double still_light = 0;    ///< light of a lamp that stands beside it and does not move
  bool table = false;        ///< … and in the table below
  bool pool = false;         ///< stands in a lit pool of wax as bright as itself
  int candles = 1;
  bool lamp = false;  ///< a lamp instead of the flame: same shape, still
  bool hand = false;  ///< a hand passes in front of it
  int lit_from = 0;   ///< lit in this frame
  int out_from = 0;   ///< blown out in this frame; 0 never
  double noise = 1;   ///< standard deviation, levels
  double exposure = 1;
  bool auto_exposure = false;  ///< follows the picture's mean, slowly
  bool blocks = false;         ///< 8 × 8 blocks, as coarse compression leaves them
  double turn = 0;             ///< of the camera, degrees
  double shake = 0;            ///< pixels
  bool irregular = false;      ///< frames are lost
  bool fair = true;            ///< whether a person would call it filmable: it must be right and called usable
};

/// One frame and the truth.
struct SceneFrame {
  bool lost = false;
  std::vector<std::uint8_t> rgb;  ///< packed
  support::Mask flame;  ///< pixels in which the flame that is followed is brighter than half of white by itself
  bool burning = true;
};

/// Frame k of a scene; the same whenever it is asked for.
SceneFrame film(const Scene& scene, int k);

}  // namespace wisp::scenes
