#include "run/bank/extinction_lanes.hpp"

#include <algorithm>
#include <cmath>

#include "run/arx/arx_program.hpp"
#include "run/state/channels.hpp"
#include "run/state/model_hash.hpp"

namespace wisp {
namespace {

constexpr double kMaxHarm = 0.5;       // largest damage per step: no single sample blows a flame out
constexpr double kFadeSeconds = 0.08;  // half-life of the excess size at relighting

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
  const double harm = std::min(step / rule.seconds, kMaxHarm);  // damage of a step at the level
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

}  // namespace wisp
