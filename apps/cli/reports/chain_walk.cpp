#include "reports/chain_walk.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>

#include "wisp/run/chain_facet.hpp"

namespace wisp::cli {

std::vector<Flag> chain_walk_flags() {
  return {
      {"steer", Kind::kText, "X,Y,Z@S", "",
       "be near this place (metres from where it starts, z up) after S seconds; a fall takes some 0.75 m of height a "
       "second"},
  };
}

namespace {

constexpr double kReach = 4;  // deviations of walks that are not steered: beyond it steering has nothing to choose from

// X,Y,Z@S.
Result<SteerTarget> target_from(const std::string& text) {
  SteerTarget target;
  double seconds = 0;
  char rest = 0;
  const int found = std::sscanf(text.c_str(), "%f,%f,%f@%lf%c", &target.position[0], &target.position[1],
                                &target.position[2], &seconds, &rest);
  bool sound = found == 4 && seconds > 0 && seconds <= 10'000;
  for (float x : target.position) sound &= std::abs(x) < 1e6F;
  if (!sound) {
    return Error{"--steer: found \"" + text +
                 "\", expected X,Y,Z@S: three numbers in metres and seconds above 0, such as " + "1,0.5,-6@8"};
  }
  target.in = std::chrono::nanoseconds(std::llround(seconds * 1e9));
  return target;
}

}  // namespace

Result<std::optional<SteerTarget>> steer_target_from(const Model& model, const Arguments& arguments) {
  if (!arguments.has("steer")) return std::optional<SteerTarget>();
  const auto* chain = std::get_if<ChainModel>(&model.dynamics);
  if (!chain) return Error{"--steer is for segment chains, which this model is not"};
  auto target = target_from(arguments.text("steer"));
  if (!target) return target.error();
  if (!chain->drift)
    return Error{"the model can't be steered: it does not say where its segments lead; learn it again"};
  return std::optional(*target);
}

void warn_of_target(const Model& model, const std::optional<SteerTarget>& target, Terminal& terminal) {
  if (!target) return;
  const ChainDrift& drift = *std::get<ChainModel>(model.dynamics).drift;
  const double seconds = std::chrono::duration<double>(target->in).count();
  const auto& to = target->position;
  const auto beyond = [&](std::size_t axis) { return to[axis] - drift.drift[axis] * seconds; };
  const double reach_ground = kReach * std::sqrt(2 * drift.spread_ground * seconds) + target->near;
  const double reach_height = kReach * std::sqrt(drift.spread_height * seconds) + target->near;
  const double away = std::hypot(beyond(0), beyond(1)), off_height = std::abs(beyond(2));
  if (away <= reach_ground && off_height <= reach_height) return;
  terminal.warn("--steer: the target lies out of reach: after " + shown(seconds, 3) + " s falls are " +
                shown(-drift.drift[2] * seconds, 3) + " m lower, give or take " + shown(reach_height, 2) +
                " m, and within " + shown(reach_ground, 2) + " m over ground; what is out of reach is not reached");
}

void steer_all(const std::optional<SteerTarget>& target, Bank& bank) {
  ChainFacet* chain = bank.chain();
  if (!chain || !target) return;
  for (int slot = 0; slot < bank.slots(); ++slot) chain->steer(bank.at(slot), *target);
}

}  // namespace wisp::cli
