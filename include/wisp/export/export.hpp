#pragma once
// A recorded play of a model, and files of it for other tools: glTF and Lottie.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// Length, instances and inputs of a take.
struct TakeOptions {
  double seconds = 4;            ///< above 0, at most an hour
  bool loop = false;             ///< the frame after the last one is the first one, in value and in speed
  int instances = 1;             ///< 1 to 1000, each with its own random stream
  std::uint64_t seed = 1;        ///< of the random streams
  bool noise = true;             ///< the residual noise; a loop without it stands still
  std::vector<double> inputs{};  ///< constant, per input of the model, in its unit; missing ones are 0
  bool round =
      false;  ///< a flame that can be is played in the round, for glTF and vertex shaders: its wind is to the right
  /// Rows of all inputs, a frame each, in the place of `inputs`; the last row stays. A flame may go out. Not for loops.
  std::vector<float> schedule{};
};

/// Frames of a model at its own rate, recorded after the model has settled.
struct Take {
  double rate_hz = 0;
  bool loop = false;
  std::size_t frames = 0;  ///< of a loop: one round, without repeating the first frame
  std::size_t instances = 0;
  std::size_t outputs = 0;
  std::size_t sides = 1;      ///< 2 of a flame in the round: as seen from the front and, x being z, from the side
  std::vector<float> values;  ///< sides × frames × instances × outputs
  /// Of a loop of bodies, per instance: how far one round leads, metres. A leaf falls; what returns is its attitude and
  /// its velocity, and the next round begins where this one ends.
  std::vector<std::array<double, 3>> travel;

  /// All outputs of one instance in one frame.
  std::span<const float> at(std::size_t frame, std::size_t instance, std::size_t side = 0) const {
    return std::span(values).subspan(((side * frames + frame) * instances + instance) * outputs, outputs);
  }
};

/// Plays a model. A loop of an ARX model is its periodic orbit under shocks that repeat; a loop of a chain is a walk
/// that comes back to where it was in a segment, turned evenly by what is left of its heading.
/// Errors: an option out of range; more than 5e8 numbers; a flame goes out in that input; no loop of that length is
/// found.
Result<Take> take(const Model& model, const TakeOptions& options);

/// A take as a binary glTF 2.0 file (.glb), in metres where the model knows its size, with all times at the model's
/// rate. A body is a node with translation and rotation; its mesh, a leaf, lies in its first two axes. An outline is a
/// body of revolution, of translucent shells that emit light, with one morph target an output of the model, named after
/// it, and as many for the side of a flame in the round: its weight is where the output is between `lowest` (0) and
/// `highest` (1), two lists in the mesh's extras, so that a bank's outputs can drive the same mesh live. The root node
/// turns Wisp's z up into glTF's y up for bodies. A loop ends with its first frame again. Errors: the model's outputs
/// are neither an outline nor a body; the take is not of this model.
Result<std::vector<std::byte>> gltf_bytes(const Model& model, const Take& take);

/// The outline of a take's first instance as a Lottie animation, `height` pixels high: one closed path of cubic Bézier
/// curves, which the spline is exactly, with a key a frame.
/// Errors: the model's outputs are no outline; the height is not 16 to 8192; the take is not of this model.
Result<std::string> lottie_text(const Model& model, const Take& take, int height = 512);

/// A take's first instance as places of points for a vertex shader: a picture of `columns` points and, from above, a
/// row a frame with the upper bytes of x, y, z as red, green, blue, then a row a frame with the lower bytes. 0 is
/// `lowest` and 65535 `highest`, in `json` with frames, rate, travel of a loop and triangles.
struct VertexAnimation {
  std::size_t columns = 0, rows = 0;
  std::vector<std::uint8_t> rgb{};  ///< rows × columns × 3
  std::string json{};
};

/// Points of the rings of an outline, a body of revolution, in its units, y up; or of a leaf, in metres, z up.
/// Errors: the model's outputs are neither an outline nor a pose; the take is not of this model.
Result<VertexAnimation> vertex_animation(const Model& model, const Take& take);

/// C99 for microcontrollers: one file with what the model is, one that declares it.
struct FirmwareSource {
  std::string header;         ///< NAME.h
  std::string source;         ///< NAME.c, which includes it
  std::size_t state_bytes{};  ///< of one candle
};

/// A model of one output as C source in fixed point: 32-bit integers, no heap, no floating point, no library. All that
/// compilers agree on, so that every processor plays the same numbers from the same seed. Shocks are drawn from 17
/// quantiles of the recorded ones where the model has them, and are normal elsewhere. `name` begins all names in it.
/// Errors: not exactly one output; an input; a chain; more than 16 modes or 32 lags; a coefficient of 8 or more; a name
/// that C does not take.
Result<FirmwareSource> firmware_source(const Model& model, std::string_view name);

/// Languages of a plant.
enum class PlantLanguage { kOctave, kPython, kJson, kC };

/// One file, and for C the one that declares it.
struct PlantText {
  std::string text;
  std::string header;  ///< NAME.h; empty but for C
};

/// An ARX model with inputs as a linear system for another tool, on deviations from its operating point, without noise.
/// Octave and MATLAB, and Python with SciPy: state space, transfer functions of one output, both discrete, and
/// continuous ones under a zero-order hold where there are such. JSON: polynomials and state space. C99: the difference
/// equation in double precision, whose names begin with `name`.
/// Errors: another model; an input that does not enter linearly; a name that C does not take.
Result<PlantText> plant_text(const Model& model, PlantLanguage language, std::string_view name);

/// The outline of one instance in one frame as a polyline: `points` × (x, y), at equal steps of the spline's parameter.
///
/// Precondition: the view is an outline, the take is of this model, and points >= 2.
std::vector<float> outline_of(const Model& model, const Take& take, std::size_t frame, std::size_t instance,
                              int points);

}  // namespace wisp
