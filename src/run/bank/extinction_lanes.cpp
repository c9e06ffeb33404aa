#include "run/bank/extinction_lanes.hpp"

#include <algorithm>
#include <cmath>

#include "run/bank/model_hash.hpp"

namespace wisp {
namespace {

// Of a size: all of it in a step where the step is longer than the change takes.
float share_of_step(double step, double seconds) {
  return static_cast<float>(std::min(1.0, step / std::max(seconds, step)));
}

float kept(double value) { return std::abs(value) < kLeastCoefficient ? 0.0f : static_cast<float>(value); }

constexpr double kMostHarm = 0.5;  // of a step: no single sample blows a flame out

}  // namespace

ExtinctionProgram make_extinction_program(const Model& model) {
  ExtinctionProgram program;
  if (!model.extinction) return program;
  const Extinction& rule = *model.extinction;
  const double step = 1.0 / model.rate_hz;
  program.present = true;
  program.input = static_cast<std::int32_t>(rule.input);
  const double harm = std::min(step / rule.seconds, kMostHarm);  // of a step at the level
  const double most = std::min(Extinction::kMostWind, 1 + (kMostHarm / harm - 1) / rule.haste);
  program.level = static_cast<float>(rule.level);
  program.most = static_cast<float>((rule.haste > 0 ? most : Extinction::kMostWind) * rule.level);
  program.base = kept(harm * (1 - rule.haste));
  program.slope = kept(harm * rule.haste / rule.level);
  program.recovery = kept(step / rule.recovery);
  program.dying = share_of_step(step, rule.dying);
  program.catching = share_of_step(step, rule.catching);
  return program;
}

std::uint64_t hash_of(const ExtinctionProgram& program, std::uint64_t before) {
  if (!program.present) return before;
  const std::uint64_t hash = hash_number(static_cast<std::uint32_t>(program.input), before);
  return hash_floats(
      {program.level, program.most, program.base, program.slope, program.recovery, program.dying, program.catching},
      hash);
}

}  // namespace wisp
