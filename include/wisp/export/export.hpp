#pragma once
// Animations for tools that draw: glTF and Lottie.

#include <cstddef>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/export/take.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// A take as a binary glTF 2.0 file (.glb), in metres where the model knows its size, with all times at the model's
/// rate. A body is a node with translation and rotation; its mesh lies in its first two axes. An outline is a flat mesh
/// with one morph target an output of the model, named after it: its weight is where the output is between `lowest` (0)
/// and `highest` (1), two lists in the mesh's extras, so that a bank's outputs can drive the same mesh live. The root
/// node turns Wisp's z up into glTF's y up for bodies. A loop ends with its first frame again.
/// Errors: the model's outputs are neither an outline nor a body; the take is not of this model.
Result<std::vector<std::byte>> gltf_bytes(const Model& model, const Take& take);

/// The outline of a take's first instance as a Lottie animation, `height` pixels high: one closed path of cubic Bézier
/// curves, which the spline is exactly, with a key a frame.
/// Errors: the model's outputs are no outline; the height is not 16 to 8192; the take is not of this model.
Result<std::string> lottie_text(const Model& model, const Take& take, int height = 512);

/// The outline of one instance in one frame as a polyline: `points` × (x, y), at equal steps of the spline's parameter.
///
/// Precondition: the view is an outline, the take is of this model, and points >= 2.
std::vector<float> outline_of(const Model& model, const Take& take, std::size_t frame, std::size_t instance,
                              int points);

}  // namespace wisp
