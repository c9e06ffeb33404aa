#pragma once
// What a model is: plain values, as learned, as stored, as played.
//
// A model is dynamics, a view that says what the outputs mean, sometimes a rule of extinction, and an account of how it
// was made. Every number is in the model's own units; design notes are in docs/architecture.md.

#include <array>
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

/// How one external input enters the dynamics.
enum class InputShape {
  kLinear,      ///< as it is: one regressor
  kEvenOdd,     ///< as six: |u|, its square root and its square, then the same with the sign of u
  kWindAlong,   ///< the x of a level wind vector: as six, the vector's length, its square root and its square, then the
                ///< same times the x of its direction
  kWindAcross,  ///< the z of that vector, the input after kWindAlong: as three, the powers times its direction's z
};

/// An input as the world gives it.
struct Input {
  std::string name;
  std::string unit;   ///< the unit of 1; empty where it has none
  double lowest = 0;  ///< the trained range; input beyond it and a margin is clamped
  double highest = 0;
  InputShape shape = InputShape::kLinear;
};

/// An output as the dynamics make it.
struct Output {
  std::string name;
  std::string unit;
  double lowest = 0;  ///< the seen range; output is clamped to it and half of it more
  double highest = 0;
};

/// The outputs are the control points of an outline: p0.x, p0.y, p1.x, p1.y, … from the base's left over the tip to the
/// base's right. Origin at the middle of the base, x right, y up, mean height 1.
struct OutlineView {
  std::vector<double> knots;   ///< full, clamped, cubic: outputs/2 + 4 values
  double metres_per_unit = 0;  ///< 0 where it is not known
  double pixels_per_unit = 0;  ///< of the clip that it was learned from; 0 where there was none
  ShapeComponents shape{};     ///< what the dynamics move; empty: the control points themselves
};

/// The outputs stand for nothing but themselves.
struct PlainView {};

/// The outputs are a body's position pos.x, pos.y, pos.z in metres, z up, and its orientation, the unit quaternion q.w,
/// q.x, q.y, q.z from the body's axes to the world's. The body is flat; its normal is its third axis.
struct PoseView {
  double half_width = 0;   ///< metres along the body's first axis; 0 where it is not known
  double half_length = 0;  ///< metres along its second axis
};

/// The outputs are a thing's position pos.x, pos.y, pos.z in metres, z up.
struct PositionView {
  double half_width = 0;  ///< metres; 0 where it is not known
};

using Dynamics = std::variant<ArxModel, ChainModel, SwitchedArxModel>;
using View = std::variant<PlainView, OutlineView, PoseView, PositionView>;

/// A model of how a thing behaves.
struct Model {
  std::string name;
  double rate_hz = 0;  ///< its own steps a second
  std::vector<Input> inputs;
  std::vector<Output> outputs;
  Dynamics dynamics;
  View view;
  Training training;
  std::optional<Extinction> extinction;  ///< none: it never goes out
};

/// The same flame in the round, by rotational symmetry: symmetric components are numbers, antisymmetric ones are
/// vectors of the level plane, and the wind is one, in two inputs. Wind along x gives the numbers of `plane`, seen from
/// its camera, to the bit. One that is in the round already is returned as it is. Errors: it is no outline of symmetric
/// and antisymmetric components with residuals of its own, or has an input that has no direction.
Result<Model> in_the_round(const Model& plane);

/// Whether a model is in the round: its outputs are its outline as it is seen from one side.
bool is_in_the_round(const Model& model);

/// Number of regressors that the inputs make: the number of inputs that the dynamics see.
std::size_t regressor_count(const std::vector<Input>& inputs);

/// Regressors that one input of that shape makes: 1, 6 or 3.
int regressor_count(InputShape shape);

/// Whether its size and its sign make regressors of their own, each with its square root and its square.
bool has_powers(InputShape shape);

/// Whether an input is one of the two numbers of a vector.
bool is_vector(InputShape shape);

}  // namespace wisp
