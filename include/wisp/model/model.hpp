#pragma once
// A model as plain values.
//
// A model consists of dynamics, a view that says what the outputs mean, optionally a rule of extinction, and a record
// of how the model was made. Numbers are in the units of its inputs and outputs; docs/architecture.md has design notes.

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "wisp/model/arx.hpp"
#include "wisp/model/chain.hpp"
#include "wisp/model/extinction.hpp"
#include "wisp/model/shape_components.hpp"
#include "wisp/model/switched.hpp"
#include "wisp/model/training.hpp"

namespace wisp {

/// Regressors that one external input contributes to the dynamics.
enum class InputShape {
  kLinear,      ///< u itself: one regressor
  kEvenOdd,     ///< six: |u|, its square root and its square, then these multiplied by the sign of u
  kWindAlong,   ///< x component of a horizontal wind vector: six, the vector's length, its square root and its square,
                ///< then these multiplied by the x component of its direction
  kWindAcross,  ///< z component, the input after kWindAlong: three, the powers times the direction's z component
};

/// One external input.
struct Input {
  std::string name;
  std::string unit;   ///< the input's unit; empty: dimensionless
  double lowest = 0;  ///< lowest value in training; input is clamped to the range extended by half its width
  double highest = 0;
  InputShape shape = InputShape::kLinear;
};

/// One output of the dynamics.
struct Output {
  std::string name;
  std::string unit;
  double lowest = 0;  ///< lowest value in training; output is clamped to the range extended by half its width
  double highest = 0;
};

/// View of outputs as control points of an outline: p0.x, p0.y, p1.x, p1.y, … from the base's left over the tip to the
/// base's right. Origin at the middle of the base, x right, y up, mean height 1.
struct OutlineView {
  std::vector<double> knots;   ///< full, clamped, cubic: outputs/2 + 4 values
  double metres_per_unit = 0;  ///< 0: unknown
  double pixels_per_unit = 0;  ///< scale of the training clip; 0: no clip
  ShapeComponents shape{};     ///< shape components moved by the dynamics; empty: the control points themselves
};

/// View of outputs without further meaning.
struct PlainView {};

/// View of outputs as a body's position pos.x, pos.y, pos.z in metres, z up, and orientation, the unit quaternion q.w,
/// q.x, q.y, q.z from body axes to world axes. The body is flat; its normal is its third axis.
struct PoseView {
  double half_width = 0;   ///< metres along the body's first axis; 0: unknown
  double half_length = 0;  ///< metres along the body's second axis; 0: unknown
};

/// View of outputs as an object's position pos.x, pos.y, pos.z in metres, z up.
struct PositionView {
  double half_width = 0;  ///< metres; 0: unknown
};

using Dynamics = std::variant<ArxModel, ChainModel, SwitchedArxModel>;
using View = std::variant<PlainView, OutlineView, PoseView, PositionView>;

/// A model of an object's behaviour.
struct Model {
  std::string name;
  double rate_hz = 0;  ///< steps per second
  std::vector<Input> inputs;
  std::vector<Output> outputs;
  Dynamics dynamics;
  View view;
  Training training;
  std::optional<Extinction> extinction;  ///< none: the object is never extinguished
};

/// Returns a flame's outline model as the model of a three-dimensional body, assuming rotational symmetry. Symmetric
/// components stay numbers; antisymmetric ones, and the wind (two inputs), become vectors of the horizontal plane. Wind
/// along x reproduces the outputs of `plane`, in its camera's view, to the bit. A body's model is returned unchanged.
/// Errors: those of check(); no ARX model of an outline's symmetric and antisymmetric components, not coupled to each
/// other, with resampled residuals; inputs other than none or one wind whose range is symmetric about 0.
Result<Model> in_the_round(const Model& plane);

/// Returns whether a model is that of a three-dimensional body, as in_the_round() makes it.
bool is_in_the_round(const Model& model);

/// Returns the number of regressors of all inputs: the number of inputs of the dynamics.
std::size_t regressor_count(const std::vector<Input>& inputs);

/// Returns the number of regressors of one input of that shape: 1, 6 or 3.
int regressor_count(InputShape shape);

/// Returns whether an input of that shape contributes size, square root and square as regressors: all but kLinear.
bool has_powers(InputShape shape);

/// Returns whether an input is one component of a vector.
bool is_vector(InputShape shape);

}  // namespace wisp
