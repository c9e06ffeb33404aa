#pragma once
// Converts pictures in the colours of BT.2020, or of high dynamic range (ITU-R BT.2100), to those of BT.709.

#include "capture/media/libav.hpp"

namespace wisp {

/// Returns whether a frame has the matrix of BT.2020, or is coded by hybrid log-gamma or perceptual quantisation.
bool has_wide_colours(const AVFrame& frame);

/// Converts `rgb48`, the 16-bit RGB of `frame` by its own matrix, to 8-bit RGB with BT.709's primaries and transfer
/// function. HDR reference white becomes white; brighter light is clipped.
void narrow_colours(const AVFrame& frame, const AVFrame& rgb48, AVFrame& rgb24);

}  // namespace wisp
