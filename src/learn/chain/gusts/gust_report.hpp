#pragma once
// What is said of a chain's response to gusts.

#include "learn/chain/gusts/gust_play.hpp"
#include "learn/chain/gusts/gust_response.hpp"
#include "wisp/base/report.hpp"

namespace wisp::chain {

/// Of gusts that were held out.
ReportSection gusts_section(const GustFigures& figures);

/// Of gusts that the model played.
ReportSection gusts_section(const GustPlayFigures& figures);

/// Tracks of a scene from above, in centimetres from each clone's own onset, where the wind blows and where it does
/// not: ids `gusts-above.NUMBER.SIDE.WHAT`. The title says which gust it is.
ReportSection scene_section(const GustScene& scene, std::size_t number);

}  // namespace wisp::chain
