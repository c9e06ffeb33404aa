#pragma once
// The first look at a clip: which channel, which level, and where the thing is that moves.
//
// Wax, the wick's holder and reflections are bright too, but they stand still. Over a few pictures and a coarse grid,
// the survey finds bright regions and how much in them changes; the thing is the region where most changes and that is
// there in most pictures. A channel is as good as its two clusters are apart, times the share of the thing's rim that
// moves: a channel in which the flame and its candle are one region has a rim that mostly stands still.

#include <optional>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/capture/vision/picture.hpp"
#include "wisp/capture/vision/threshold.hpp"

namespace wisp {

/// What to look for.
struct SurveyOptions {
  std::optional<PixelChannel> channel;  ///< nothing: the one that separates best
  bool dark = false;                    ///< the thing is dark on a light ground
  Region region;                        ///< where to look, pixels; empty: the whole picture
};

/// What was found.
struct Survey {
  PixelChannel channel = PixelChannel::kLuma;
  int level = 0;              ///< a pixel belongs to the thing when its value (inverted for dark things) is above this
  double separation = 0;      ///< of the two clusters, 0 to 1
  Histogram histogram{};      ///< of the channel as stored (inverted for dark things), over the pictures that count
  Region home;                ///< around all places where the thing was seen
  std::vector<Region> still;  ///< bright regions where next to nothing changes
  bool moves = false;         ///< whether anything changed at all
};

/// Surveys pictures of one size.
/// Errors: nothing bright anywhere (one brightness only), or nothing bright inside the region.
///
/// Precondition: pictures is not empty; all have one size and layout; region is empty or inside them.
Result<Survey> survey_scene(std::span<const Picture> pictures, const SurveyOptions& options);

}  // namespace wisp
