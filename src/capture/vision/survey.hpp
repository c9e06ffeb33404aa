#pragma once
// The first look at a clip: what the thing is, and in which channel and at which level it is followed.
//
// Wax, the wick's holder and reflections are bright too. Over a few pictures, bright regions of many levels in every
// channel are weighed by what a flame does (candidates.hpp), first in the whole picture on a coarse grid, then around
// each flame on a finer one: region, channel and level are chosen together.
//
// Section 3.1 of the paper asks for one level that separates the histogram's two clusters, flame and background.

#include <optional>
#include <span>
#include <vector>

#include "capture/vision/edge_cloud.hpp"
#include "wisp/base/result.hpp"
#include "wisp/capture/vision/image.hpp"
#include "wisp/capture/vision/picture.hpp"

namespace wisp {

/// Counts every `step`-th pixel of every `step`-th row.
///
/// Precondition: step >= 1.
void add_to_histogram(Histogram& histogram, const ImageView& image, int step);

/// What to look for.
struct SurveyOptions {
  std::optional<PixelChannel> channel;  ///< nothing: all there are
  bool dark = false;                    ///< the thing is dark on a light ground
  Region region;                        ///< where to look, pixels; empty: the whole picture
  int flame = 1;                        ///< which of several flames, 1 the largest; 0: what moves, flame or not
};

/// What was found.
struct Survey {
  PixelChannel channel = PixelChannel::kLuma;
  int level = 0;               ///< a pixel belongs to the thing when its value (inverted for dark things) is above this
  Histogram histogram{};       ///< of the channel as stored (inverted for dark things), over the pictures that count
  Region home;                 ///< around all places where the thing was seen
  std::vector<Region> seen;    ///< around the thing in each picture in which it was there
  bool stands = false;         ///< at that level it has mostly run together with what it stands on
  double area = 0;             ///< median, pixels
  double change = 0;           ///< share of its shape that changes from picture to picture: 0 nothing moves
  double steadiness = 0;       ///< how much less its base moves than its tip: 1 only the tip
  double taper = 0;            ///< how much narrower its first quarter is than its middle: 0 not at all, 1 pointed
  double light = 1;            ///< its luma over the brightest there is
  double contrast = 255;       ///< its brightness less that of what is around it, levels
  double clipped = 0;          ///< share of it that is flat: as bright in every channel as it gets
  int flames = 0;              ///< how many flames there are; 0 where any thing was looked for
  std::vector<Region> others;  ///< the median boxes of the others
};

/// Surveys pictures of one size. Where there are fewer flames than `options.flame`, the largest is described. Errors:
/// nothing stands out anywhere (one brightness only).
///
/// Precondition: pictures is not empty; all have one size and layout; region is empty or inside them.
Result<Survey> survey_scene(std::span<const Picture> pictures, const SurveyOptions& options);

/// The side on which the thing is held: below, unless the border on another side cuts it off in nearly all pictures and
/// the lower one does not, or it lies on its side: then the end that moves less.
BaseSide base_side(const Survey& survey, const Region& area);

}  // namespace wisp
