#pragma once
// Plays of a model recorded as takes, and their export to other tools: glTF and Lottie, among others.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// Length, instances and inputs of a take.
struct TakeOptions {
  double seconds = 4;            ///< above 0, at most an hour
  bool loop = false;             ///< the last frame is followed by the first one, continuous in value and velocity
  int instances = 1;             ///< 1 to 1000, each with its own random stream
  std::uint64_t seed = 1;        ///< seed of the random streams
  bool noise = true;             ///< add the residual noise; an ARX loop without it is constant; a chain's ignores it
  std::vector<double> inputs{};  ///< constant inputs of the model, in their units; missing ones are 0
  bool round = false;  ///< play a flame in 3D if in_the_round() can, for glTF and vertex shaders; wind blows along +x
  /// Rows of all inputs, one per frame, after settling under `inputs`; the last stays set. Not for loops.
  std::vector<float> schedule{};
};

/// Frames of a model at its own rate, after it has settled; a fall that does not loop is recorded from its start.
struct Take {
  double rate_hz = 0;
  bool loop = false;
  std::size_t frames = 0;  ///< number of frames; of a loop: one period, without repeating the first frame
  std::size_t instances = 0;
  std::size_t outputs = 0;
  std::size_t sides = 1;      ///< 2 for a flame played in 3D: front view, then side view, whose x is the body's z
  std::vector<float> values;  ///< sides × frames × instances × outputs
  /// For a loop of bodies, per instance: displacement of one period, metres. A leaf falls; its attitude and velocity
  /// return, and the next period begins where this one ends.
  std::vector<std::array<double, 3>> travel;

  /// Returns all outputs of one instance in one frame.
  std::span<const float> at(std::size_t frame, std::size_t instance, std::size_t side = 0) const {
    return std::span(values).subspan(((side * frames + frame) * instances + instance) * outputs, outputs);
  }
};

/// Plays a model. A loop of an ARX model is its periodic orbit under periodic shocks; a loop of a chain is a walk that
/// returns to the same row of a segment, whose remaining rotation and velocity change are distributed evenly over the
/// loop. Errors: an option out of range; more than 5e8 numbers; a flame extinguished without a schedule; no such loop
/// found; kStopped.
Result<Take> take(const Model& model, const TakeOptions& options, const Progress& progress = {});

/// Exports a take as a binary glTF 2.0 file (.glb), in metres where the model knows its size, with one key per frame of
/// the take. A body is a node with translation and rotation; its mesh, a leaf, lies in its first two axes. An outline
/// is a body of revolution, of translucent emissive shells, with one morph target per output of the model, named after
/// the output; a flame played in 3D has as many again for its side view. A weight is the output's position between
/// `lowest` (0) and `highest` (1), two lists in the mesh's extras, so that a bank's outputs can drive the same mesh
/// live. For bodies the root node turns Wisp's z up into glTF's y up. A loop ends with its first frame again. Errors:
/// the model's outputs are neither an outline nor a body; the take is not of this model.
Result<std::vector<std::byte>> gltf_bytes(const Model& model, const Take& take);

/// Exports the outline of a take's first instance as a Lottie animation, `height` pixels high: the spline as cubic
/// Bézier curves (to 0.001 pixels), closed below its base, one key per frame, filled as a body with a bright core.
/// Errors: the model's outputs are no outline; the height is not 16 to 8192; the take is not of this model.
Result<std::string> lottie_text(const Model& model, const Take& take, int height = 512);

/// Vertex positions of a take's first instance for a vertex shader: a picture of one column per vertex and, from above,
/// one row per frame with the upper bytes of x, y, z as red, green, blue, then one row per frame with the lower bytes.
/// 0 means `lowest` and 65535 `highest`. `json` states both, the frames, their rate, a loop's travel and the triangles.
struct VertexAnimation {
  std::size_t columns = 0, rows = 0;
  std::vector<std::uint8_t> rgb{};  ///< rows × columns × 3
  std::string json{};
};

/// Exports the vertices of an outline's body of revolution, in its units, y up, or of a leaf, in metres, z up.
/// Errors: the model's outputs are neither an outline nor a pose; the take is not of this model, or above 8192 frames.
Result<VertexAnimation> vertex_animation(const Model& model, const Take& take);

/// C99 source for microcontrollers: one file with the model, and its header.
struct FirmwareSource {
  std::string header;         ///< NAME.h
  std::string source;         ///< NAME.c, which includes it
  std::size_t state_bytes{};  ///< memory of one lamp's state without padding, bytes
};

/// Exports a model of one output as C source in fixed point: 32-bit integers, no heap, no floating point, no library,
/// and only operations defined by the standard, so that every processor plays the same numbers from the same seed.
/// Shocks are drawn from 17 quantiles of the residuals if the model has them, else normal. `name` prefixes all names.
/// Errors: not exactly one output; an input; a chain; more than 16 modes or 32 lags; a coefficient of 8 or more, or a
/// mode's coefficients of 24 or more together; a mean beyond ±3.9, or a range that reaches more than 4 or less than
/// 0.002 from it; a rate that is not within 0.5 % of a whole number; a name that is no C identifier.
Result<FirmwareSource> firmware_source(const Model& model, std::string_view name);

/// Languages in which plant_text() exports a plant.
enum class PlantLanguage { kOctave, kPython, kJson, kC };

/// Source text of a plant, and for C its header.
struct PlantText {
  std::string text;
  std::string header;  ///< NAME.h; empty except for C
};

/// Exports an ARX model with inputs as a linear system for another tool, on deviations from its operating point,
/// without noise. Octave and MATLAB, and Python with SciPy: discrete state space and, of one output, transfer
/// functions, and continuous ones under a zero-order hold where they exist. JSON: polynomials and state space. C99: the
/// difference equation in double precision; `name` prefixes all names. Errors: no ARX model, or one of an outline; no
/// input, or one that is not linear; for C a name that is no identifier.
Result<PlantText> plant_text(const Model& model, PlantLanguage language, std::string_view name);

/// Returns one instance's outline in one frame as a polyline: `points` × (x, y), at equal spline parameter steps.
/// Precondition: the view is an outline, the take is of this model, and points >= 2.
std::vector<float> outline_of(const Model& model, const Take& take, std::size_t frame, std::size_t instance,
                              int points);

}  // namespace wisp
