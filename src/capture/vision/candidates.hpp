#pragma once
// What could be the thing: bright regions that are there in most of a clip's pictures, and the evidence on each.
//
// A flame gives light: it is as bright as anything in the picture. Its edges move, and not as a whole: lit wax, glass
// and a table stay in shape and only change brightness with it, and what a shaken camera moves keeps its shape. It
// stands on a place and tapers away from it: its tip moves more than its base. Its rim is steep: another level gives
// nearly the same region.

#include <optional>
#include <span>
#include <vector>

#include "capture/vision/shoulder.hpp"
#include "wisp/capture/vision/picture.hpp"

namespace wisp {

/// One channel of several pictures over one region, every `step`-th pixel of it.
struct PictureGrid {
  Region area;  ///< pixels of the picture
  int step = 1;
  int width = 0;
  int height = 0;
  std::vector<std::vector<std::uint8_t>> pictures;

  ImageView view(std::size_t k) const { return {pictures[k].data(), width, height, width}; }
  std::size_t size() const { return static_cast<std::size_t>(width) * height; }
  Region to_pixels(const Region& box) const;
};

/// A grid over `area` at most `most` points wide and high, without pictures.
PictureGrid grid_over(const Region& area, int most);

/// Samples a picture's `channel`, inverted for dark things.
void add_picture(PictureGrid& grid, const Picture& picture, PixelChannel channel, bool dark);

/// All of several pictures.
PictureGrid sample_grid(std::span<const Picture> pictures, PixelChannel channel, const Region& area, int most,
                        bool dark);

/// What is looked for.
struct Evidence {
  bool flame = true;  ///< gives light, tapers and stands; else only moves
  BaseSide base = BaseSide::kBottom;
  std::span<const double> brightest;  ///< luma of the brightest there is in each picture; empty: does not matter
};

/// A bright region seen in most pictures.
struct Candidate {
  PixelChannel channel = PixelChannel::kLuma;
  int level = 0;
  std::vector<Region> seen;  ///< its box in each picture where it is, pixels, without what it stands on
  Region home;               ///< around all of them
  bool stands = false;       ///< it has run together with what it stands on
  double presence = 0;       ///< share of the pictures
  double area = 0;           ///< median, pixels
  double light = 1;          ///< its luma over the brightest there is
  double change = 0;         ///< what two of its shapes do not share, laid over each other: 0 never moves
  double taper = 0;          ///< how much narrower its first quarter is than its middle: 0 not at all, 1 pointed
  double solidity = 0;       ///< its area over its convex hull's
  double steadiness = 0;     ///< how much less its base moves than its tip: 0 only the base moves, 1 only the tip
  double contrast = 255;     ///< its brightness less that of what is around it, levels, once its level has settled
  double softness = 0;       ///< share of its area that comes or goes with a level's change
  double likeness = 0;       ///< what a still picture tells of all these, in one: more is likelier
  double score = 0;          ///< … and how it moves
};

/// All candidates in one channel at one level.
std::vector<Candidate> find_candidates(const PictureGrid& grid, const PictureGrid& luma, int level,
                                       const Evidence& evidence);

/// Sets `softness` from the candidates of the levels below and above (that below may be null), the likeness and the
/// score.
void weigh(std::vector<Candidate>& candidates, const std::vector<Candidate>* below, const std::vector<Candidate>* above,
           const Evidence& evidence);

/// The median left, upper, right and lower sides of some boxes: what a thing now and then runs together with counts
/// not.
///
/// Precondition: there is one.
Region usual_place(std::span<const Region> seen);

/// The area that two rectangles share over the area of both.
double shared_share(const Region& a, const Region& b);

}  // namespace wisp
