#include "run/bank/extinction_lanes.hpp"

#include <algorithm>
#include <cmath>

#include "run/arx/arx_program.hpp"
#include "run/state/channels.hpp"
#include "run/state/model_hash.hpp"

namespace wisp {
namespace {

constexpr double kMaxHarm = 0.5;       // largest damage per step: no single sample blows a flame out
constexpr double kStirs = 0.1;         // wind above this share of the level ends the replay of a re-ignition
constexpr double kJoinSeconds = 0.06;  // duration of the cross-over from decay to re-ignition
constexpr double kLeaveSeconds = 0.2;  // duration of the cross-over from re-ignition to the dynamics

// Returns the number of steps in a duration, 1 to 1000.
std::size_t steps_in(double seconds, double step) {
  return static_cast<std::size_t>(std::clamp(std::round(seconds / step), 1.0, 1000.0));
}

// Appends events to the program's sizes and shapes, each followed by `leaving` steps of cross-over.
void lay_out(const FlameEvents& events, std::size_t leaving, std::span<std::uint32_t> begins, std::size_t& at,
             ExtinctionProgram& program) {
  const std::size_t components = events.scale.size();
  std::uint32_t begin = 0;
  for (std::size_t k = 0; k < events.ends.size(); ++k) {
    begins[k] = static_cast<std::uint32_t>(at);
    for (; begin < events.ends[k]; ++begin, ++at) {
      program.sizes[at] = static_cast<float>(events.sizes[begin]) / 255.0f;
      for (std::size_t c = 0; c < components; ++c) {
        program.shapes[at * components + c] =
            kept(std::clamp(events.scale[c], 0.0, 1e12) * events.shapes[begin * components + c]);
      }
    }
    for (std::size_t step = 1; step <= leaving; ++step) {
      program.sizes[at++] = kEventEnds * static_cast<float>(step) / static_cast<float>(leaving);
    }
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
  program.stirs = static_cast<float>(kStirs * rule.level);
  program.join = 1.0f / static_cast<float>(steps_in(kJoinSeconds, step));
  const FlameEvents dying = dying_of(rule, model.rate_hz), catching = catching_of(rule, model.rate_hz);
  const std::size_t leaving = steps_in(kLeaveSeconds, step);
  program.dying = arena.take<std::uint32_t>(dying.ends.size());
  program.catching = arena.take<std::uint32_t>(catching.ends.size());
  const std::size_t steps =
      1 + dying.sizes.size() + dying.ends.size() + catching.sizes.size() + catching.ends.size() * leaving;
  program.sizes = arena.take<float>(steps);
  program.shapes = arena.take<float>(steps * catching.scale.size());
  if (arena.measures()) return program;
  std::size_t at = 0;
  program.sizes[at++] = kEventEnds;
  lay_out(dying, 1, program.dying, at, program);
  lay_out(catching, leaving, program.catching, at, program);
  return program;
}

std::uint64_t hash_of(const ExtinctionProgram& program, std::uint64_t before) {
  if (!program.present) return before;
  std::uint64_t hash = hash_number(static_cast<std::uint32_t>(program.input), before);
  hash = hash_floats(
      {program.level, program.most, program.base, program.slope, program.recovery, program.join, program.stirs}, hash);
  for (const std::span<std::uint32_t> begins : {program.dying, program.catching}) {
    for (const std::uint32_t begin : begins) hash = hash_number(begin, hash);
  }
  for (const std::span<float> numbers : {program.sizes, program.shapes}) {
    if (!numbers.empty()) hash = hash_floats(numbers, hash);
  }
  return hash;
}

}  // namespace wisp
