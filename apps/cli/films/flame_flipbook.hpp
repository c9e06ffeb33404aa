#pragma once
// A take of a flame as pictures of light on nothing.

#include "wisp/base/result.hpp"
#include "wisp/draw/film_strip.hpp"
#include "wisp/export/export.hpp"
#include "wisp/model/model.hpp"

namespace wisp::cli {

/// Frames `height` pixels high, cut to where the flame and its halo reach in any of them.
/// Errors: the model is no flame; the height is not 16 to 2048.
Result<Flipbook> flame_flipbook(const Model& model, const Take& take, int height);

}  // namespace wisp::cli
