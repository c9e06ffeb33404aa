#pragma once
// Survey of a clip: identifies the object, and the channel and level at which it is tracked.
//
// Wax, the wick's holder and reflections are bright too. So bright regions at many levels of every channel are rated
// over a few pictures by the properties of a flame, first in the whole picture on a coarse grid, then around the chosen
// region on a finer grid. Region, channel and level are chosen together. Candidates are regions in most pictures.
//
// Evidence for a flame: it emits light, so it is among the brightest regions. Its edges deform, whereas lit wax, glass
// and tables keep their shape and only change in brightness, and a moving camera preserves shapes. Its base stays in
// place and it tapers upwards, so its tip moves more than its base. Its rim is steep, so another level gives nearly the
// same region.
//
// Section 3.1 of the paper instead uses one level between the histogram's two clusters, flame and background.

#include <optional>
#include <span>
#include <vector>

#include "capture/vision/region.hpp"
#include "wisp/base/result.hpp"
#include "wisp/capture/vision/image.hpp"
#include "wisp/capture/vision/picture.hpp"

namespace wisp {

inline constexpr double kSurelyMoves = 0.06;  ///< Candidate::change from which an object certainly moves
inline constexpr double kSamePlace = 0.5;     ///< minimum intersection over union of boxes of one object
inline constexpr double kAsBright = 0.9;      ///< minimum relative brightness of another, or refound, or snuffed flame
inline constexpr double kAsNear = 0.35;       ///< maximum displacement of an object's base, object lengths

inline constexpr int kNoise = 16;  ///< of 255: a smaller difference may be coding errors or camera noise

/// One channel of several pictures over one region, sampled at every `step`-th pixel.
struct PictureGrid {
  Region area;  ///< region in pixels of the picture
  int step = 1;
  int width = 0;
  int height = 0;
  std::vector<std::vector<std::uint8_t>> pictures;

  ImageView view(std::size_t k) const { return {pictures[k].data(), width, height, width}; }
  std::size_t size() const { return static_cast<std::size_t>(width) * height; }
  Region to_pixels(const Region& box) const;
};

/// Returns a grid over `area` without pictures, at most `most` points wide and high.
PictureGrid grid_over(const Region& area, int most);

/// Samples a picture's `channel` on the grid, inverted if the object is dark.
void add_picture(PictureGrid& grid, const Picture& picture, PixelChannel channel, bool dark);

/// Samples several pictures on one grid.
PictureGrid sample_grid(std::span<const Picture> pictures, PixelChannel channel, const Region& area, int most,
                        bool dark);

/// Kind of object that is searched for.
struct Evidence {
  bool flame = true;  ///< emits light, tapers and stands; false: only moves
  BaseSide base = BaseSide::kBottom;
  std::span<const double> brightest;  ///< luma of the brightest points of each picture; empty: ignored
};

/// A bright region present in most pictures.
struct Candidate {
  PixelChannel channel = PixelChannel::kLuma;
  int level = 0;
  std::vector<Region> seen;  ///< box in each picture that has the region, pixels, stand excluded
  Region home;               ///< union of `seen`
  bool stands = false;       ///< whether the region merges with its stand, which is then cut off
  double presence = 0;       ///< share of the pictures with the region
  double area = 0;           ///< median area, pixels
  double light = 1;          ///< luma divided by that of the picture's brightest points
  double change = 0;         ///< 1 − overlap of aligned shapes in two pictures, median: 0 never deforms
  double taper = 0;          ///< 1 − width of the first quarter / width of the middle: 0 blunt, 1 pointed
  double solidity = 0;       ///< area divided by the convex hull's area
  double steadiness = 0;     ///< tip's motion / (tip's + base's motion): 0 only the base moves, 1 only the tip
  double contrast = 255;     ///< brightness minus that of the surroundings, levels; set with the final level
  double softness = 0;       ///< share of the area that changes with the level
  double likeness = 0;       ///< combined evidence from still pictures: larger is likelier
  double score = 0;          ///< likeness combined with evidence from movement
};

std::vector<Candidate> find_candidates(const PictureGrid& grid, const PictureGrid& luma, int level,
                                       const Evidence& evidence);

/// Sets `softness` from the candidates of the next lower level (may be null) and of the next higher level, then
/// `likeness` and `score`.
void weigh(std::vector<Candidate>& candidates, const std::vector<Candidate>* below, const std::vector<Candidate>* above,
           const Evidence& evidence);

/// Returns the box of the median left, upper, right and lower sides, robust against occasional merging of regions.
/// Precondition: seen is not empty.
Region usual_place(std::span<const Region> seen);

/// Returns the intersection over union of two rectangles.
double shared_share(const Region& a, const Region& b);

/// Adds an image's pixels to a histogram.
void add_to_histogram(Histogram& histogram, const ImageView& image);

struct SurveyOptions {
  std::optional<PixelChannel> channel;  ///< channel to use; empty: all are tried
  bool dark = false;                    ///< whether the object is dark on a light background
  Region region;                        ///< searched region, pixels; empty: the whole picture
  int flame = 1;                        ///< index of the flame by size, from 1; 0: any moving object
};

/// The object, with the level above which pixels (inverted for dark objects) belong to it, and the scene.
struct Survey : Candidate {
  Histogram histogram{};       ///< histogram of the channel (inverted for dark objects) over the surveyed pictures
  double clipped = 0;          ///< share of the object that is saturated in every channel
  int flames = 0;              ///< number of flames; 0 where any object was requested
  std::vector<Region> others;  ///< median boxes of the other flames
};

/// Surveys pictures of one size. Where there are fewer than `options.flame` flames, the largest is described. Errors:
/// no contrast anywhere, no region in most pictures. Precondition: pictures is not empty; all have one size and layout;
/// region is empty or inside them.
Result<Survey> survey_scene(std::span<const Picture> pictures, const SurveyOptions& options);

/// Returns the side on which the object is held: below if the lower border cuts it off in half of the pictures; else
/// another border that does in nearly all; else the stiller end of an object much wider than high; else below.
BaseSide base_side(const Survey& survey, const Region& area);

}  // namespace wisp
