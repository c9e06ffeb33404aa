#include <algorithm>
#include <cmath>

#include "run/arx/arx_program.hpp"
#include "run/bank/extinction_lanes.hpp"
#include "run/bank/shape_lanes.hpp"
#include "run/state/channels.hpp"
#include "run/state/model_hash.hpp"
#include "wisp/run/bank.hpp"

namespace wisp {
namespace {

constexpr double kMaxHarm = 0.5;       // harm of one step: no single sample blows a flame out
constexpr double kFadeSeconds = 0.08;  // half of what a flame was lit with is gone then

void lay_out(const SizeEvents& events, std::span<std::uint32_t> begins, std::size_t& at, std::span<float> sizes) {
  std::uint32_t begin = 0;
  for (std::size_t k = 0; k < events.ends.size(); ++k) {
    begins[k] = static_cast<std::uint32_t>(at);
    for (; begin < events.ends[k]; ++begin) sizes[at++] = static_cast<float>(events.sizes[begin]) / 255.0f;
    sizes[at++] = kEventEnds;
  }
}

}  // namespace

ExtinctionProgram make_extinction_program(const Model& model, Arena& arena) {
  ExtinctionProgram program;
  if (!model.extinction) return program;
  const Extinction& rule = *model.extinction;
  const double step = 1.0 / model.rate_hz;
  program.present = true;
  program.vector = is_vector(model.inputs[rule.input].shape);
  const bool across = model.inputs[rule.input].shape == InputShape::kWindAcross;
  program.input = static_cast<std::int32_t>(rule.input) - (across ? 1 : 0);
  const double harm = std::min(step / rule.seconds, kMaxHarm);  // harm of a step at the level
  const double most = std::min(Extinction::kMaxWind, 1 + (kMaxHarm / harm - 1) / rule.haste);
  program.level = static_cast<float>(rule.level);
  program.most = static_cast<float>((rule.haste > 0 ? most : Extinction::kMaxWind) * rule.level);
  program.base = kept(harm * (1 - rule.haste));
  program.slope = kept(harm * rule.haste / rule.level);
  program.recovery = kept(step / rule.recovery);
  program.fade = static_cast<float>(std::exp2(-step / kFadeSeconds));
  const SizeEvents dying = dying_of(rule, model.rate_hz), catching = catching_of(rule, model.rate_hz);
  program.dying = arena.take<std::uint32_t>(dying.ends.size());
  program.catching = arena.take<std::uint32_t>(catching.ends.size());
  program.sizes =
      arena.take<float>(dying.sizes.size() + catching.sizes.size() + dying.ends.size() + catching.ends.size());
  if (arena.measures()) return program;
  std::size_t at = 0;
  lay_out(dying, program.dying, at, program.sizes);
  lay_out(catching, program.catching, at, program.sizes);
  return program;
}

std::uint64_t hash_of(const ExtinctionProgram& program, std::uint64_t before) {
  if (!program.present) return before;
  std::uint64_t hash = hash_number(static_cast<std::uint32_t>(program.input), before);
  hash = hash_floats({program.level, program.most, program.base, program.slope, program.recovery, program.fade}, hash);
  for (const std::span<std::uint32_t> begins : {program.dying, program.catching}) {
    for (const std::uint32_t begin : begins) hash = hash_number(begin, hash);
  }
  for (const float size : program.sizes) hash = hash_floats({size}, hash);
  return hash;
}

namespace {

constexpr double kLargestCoordinate = 1e12;  // of a shape, in the model's units: no sum overflows

float bounded_coordinate(double value) {
  if (std::abs(value) < kMinCoefficient) return 0.0f;
  return static_cast<float>(std::clamp(value, -kLargestCoordinate, kLargestCoordinate));
}

}  // namespace

ShapeProgram make_shape_program(const Model& model, Arena& arena) {
  ShapeProgram program;
  const auto* outline = std::get_if<OutlineView>(&model.view);
  if (!outline || outline->shape.empty()) return program;
  const ShapeComponents& shape = outline->shape;
  program.points = shape.points();
  program.symmetric = shape.symmetric;
  program.antisymmetric = shape.antisymmetric;
  program.across = shape.across;
  for (auto* values : {&program.rest, &program.lowest, &program.highest}) {
    *values = arena.take<float>(shape.rest.size());
  }
  program.basis = arena.take<float>(shape.basis.size());
  if (arena.measures()) return program;
  for (std::size_t i = 0; i < shape.rest.size(); ++i) {
    program.rest[i] = bounded_coordinate(shape.rest[i]);
    program.lowest[i] = bounded_coordinate(shape.coordinates[i].lowest);
    program.highest[i] = bounded_coordinate(shape.coordinates[i].highest);
  }
  for (std::size_t k = 0; k < shape.basis.size(); ++k) program.basis[k] = bounded_coordinate(shape.basis[k]);
  return program;
}

std::uint64_t hash_of(const ShapeProgram& program, std::uint64_t before) {
  std::uint64_t hash = before;
  for (const auto numbers : {program.rest, program.lowest, program.highest, program.basis}) {
    if (!numbers.empty()) hash = hash_floats(numbers, hash);
  }
  return hash;
}

}  // namespace wisp
