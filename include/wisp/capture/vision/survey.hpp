#pragma once
// The first look at a clip: in each channel, which level, and where the thing is that moves.
//
// Wax, the wick's holder and reflections are bright too, but they stand still. Over a few pictures and a coarse grid,
// the survey finds bright regions and how much in them changes; the thing is the region where most changes and that is
// there in most pictures.

#include <optional>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/capture/vision/edge_cloud.hpp"
#include "wisp/capture/vision/picture.hpp"
#include "wisp/capture/vision/threshold.hpp"

namespace wisp {

/// What to look for.
struct SurveyOptions {
  std::optional<PixelChannel> channel;  ///< nothing: all there are
  bool dark = false;                    ///< the thing is dark on a light ground
  Region region;                        ///< where to look, pixels; empty: the whole picture
};

/// What was found.
struct Survey {
  PixelChannel channel = PixelChannel::kLuma;
  int level = 0;              ///< a pixel belongs to the thing when its value (inverted for dark things) is above this
  int steepest_level = 0;     ///< a level nearby at which the thing's rim is steepest
  double separation = 0;      ///< of the two clusters, 0 to 1
  Histogram histogram{};      ///< of the channel as stored (inverted for dark things), over the pictures that count
  Region home;                ///< around all places where the thing was seen
  std::vector<Region> seen;   ///< around the thing in each picture in which it was there
  std::vector<Region> still;  ///< bright regions where next to nothing changes
  bool moves = false;         ///< whether anything changed at all
};

/// Surveys pictures of one size. Returns what was found in each channel that was asked for and in which something
/// stands out; one at least. Errors: nothing stands out anywhere (one brightness only).
///
/// Precondition: pictures is not empty; all have one size and layout; region is empty or inside them.
Result<std::vector<Survey>> survey_scene(std::span<const Picture> pictures, const SurveyOptions& options);

/// The side on which the thing is held: below, unless the border on another side cuts it off in nearly all pictures and
/// the lower one does not, or it lies on its side: then the end that moves less.
BaseSide base_side(const Survey& survey, const Region& area);

}  // namespace wisp
