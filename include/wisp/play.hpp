#pragma once
// All headers for playing a model: read it, create a bank, set its wind, also from a microphone, and read its outputs.
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
