#pragma once
// All that plays a model: read it, make a bank of it, let a wind act, read what it does; and a microphone's wind.
//
//   const auto model = wisp::read_model("flame.wisp");
//   auto bank = wisp::Bank::create(*model, {.capacity = 100});

#include "wisp/model/file.hpp"
#include "wisp/model/model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/body_facet.hpp"
#include "wisp/run/chain_facet.hpp"
#include "wisp/run/cost.hpp"
#include "wisp/run/extinction_facet.hpp"
#include "wisp/sound/wind_level.hpp"
#include "wisp/sound/wind_track.hpp"
