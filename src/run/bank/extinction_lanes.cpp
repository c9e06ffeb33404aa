#include "run/bank/extinction_lanes.hpp"

#include <algorithm>
#include <cmath>

#include "run/arx/arx_program.hpp"
#include "run/state/model_hash.hpp"

namespace wisp {
namespace {

// The share of the full size by which it changes in a step. A step longer than the whole change takes all of it.
float share_of_step(double step, double seconds) {
  return static_cast<float>(std::min(1.0, step / std::max(seconds, step)));
}

constexpr double kMaxHarm = 0.5;  // harm of one step: no single sample blows a flame out

}  // namespace

ExtinctionProgram make_extinction_program(const Model& model) {
  ExtinctionProgram program;
  if (!model.extinction) return program;
  const Extinction& rule = *model.extinction;
  const double step = 1.0 / model.rate_hz;
  program.present = true;
  program.input = static_cast<std::int32_t>(rule.input);
  const double harm = std::min(step / rule.seconds, kMaxHarm);  // harm of a step at the level
  const double most = std::min(Extinction::kMaxWind, 1 + (kMaxHarm / harm - 1) / rule.haste);
  program.level = static_cast<float>(rule.level);
  program.most = static_cast<float>((rule.haste > 0 ? most : Extinction::kMaxWind) * rule.level);
  program.base = kept(harm * (1 - rule.haste));
  program.slope = kept(harm * rule.haste / rule.level);
  program.recovery = kept(step / rule.recovery);
  program.decay = share_of_step(step, rule.decay);
  program.re_ignition = share_of_step(step, rule.re_ignition);
  return program;
}

std::uint64_t hash_of(const ExtinctionProgram& program, std::uint64_t before) {
  if (!program.present) return before;
  const std::uint64_t hash = hash_number(static_cast<std::uint32_t>(program.input), before);
  return hash_floats(
      {program.level, program.most, program.base, program.slope, program.recovery, program.decay, program.re_ignition},
      hash);
}

}  // namespace wisp
