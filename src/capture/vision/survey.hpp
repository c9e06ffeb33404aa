#pragma once
// Survey of a clip: identifies the object, and the channel and level at which it is tracked.
//
// Wax, the wick's holder and reflections are bright too. So bright regions at many levels of every channel are rated
// over a few pictures by the properties of a flame (candidates.hpp), first in the whole picture on a coarse grid, then
// around each flame on a finer one. Region, channel and level are chosen together.
//
// Section 3.1 of the paper instead uses one level between the histogram's two clusters, flame and background.

#include <optional>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/capture/vision/image.hpp"
#include "wisp/capture/vision/picture.hpp"

namespace wisp {

/// Counts every `step`-th pixel of every `step`-th row.
///
/// Precondition: step >= 1.
void add_to_histogram(Histogram& histogram, const ImageView& image, int step);

/// Options of survey_scene().
struct SurveyOptions {
  std::optional<PixelChannel> channel;  ///< channel to use; empty: all are tried
  bool dark = false;                    ///< whether the object is dark on a light background
  Region region;                        ///< searched region, pixels; empty: the whole picture
  int flame = 1;                        ///< index of the flame by size, from 1; 0: any moving object
};

/// Result of a survey.
struct Survey {
  PixelChannel channel = PixelChannel::kLuma;
  int level = 0;               ///< pixels whose value (inverted for dark objects) is above this belong to the object
  Histogram histogram{};       ///< of the stored channel (inverted for dark objects), over the pictures that count
  Region home;                 ///< union of all places where the object was seen
  std::vector<Region> seen;    ///< box of the object in each picture with it
  bool stands = false;         ///< whether it has mostly merged with its stand at that level
  double area = 0;             ///< median, pixels
  double change = 0;           ///< share of its shape that changes between pictures: 0 still
  double steadiness = 0;       ///< reduction of motion from tip to base: 1 only the tip moves
  double taper = 0;            ///< 1 − width of its first quarter / width of its middle: 0 blunt, 1 pointed
  double light = 1;            ///< its luma divided by the brightest region's
  double contrast = 255;       ///< its brightness minus that of its surroundings, levels
  double clipped = 0;          ///< share of it that is saturated in every channel
  int flames = 0;              ///< number of flames; 0 where any object was requested
  std::vector<Region> others;  ///< median boxes of the other flames
};

/// Surveys pictures of one size. Where there are fewer than `options.flame` flames, the largest is described. Errors:
/// no contrast anywhere.
///
/// Precondition: pictures is not empty; all have one size and layout; region is empty or inside them.
Result<Survey> survey_scene(std::span<const Picture> pictures, const SurveyOptions& options);

/// Side on which the object is held: below, unless the border on another side (and not the lower one) cuts it off in
/// nearly all pictures, or it lies on its side, where the end that moves less is taken.
BaseSide base_side(const Survey& survey, const Region& area);

}  // namespace wisp
