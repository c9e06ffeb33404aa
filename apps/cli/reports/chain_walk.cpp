#include "reports/chain_walk.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>

#include "wisp/run/chain_facet.hpp"

namespace wisp::cli {

std::vector<Flag> chain_walk_flags() {
  return {
      {"history",
       Kind::kIntegerOrWord,
       "H|none",
       "",
       "most modes that a chain looks back; none, as by default: as many as learned",
       {"none"}},
      {"temperature", Kind::kNumber, "T", "",
       "of a chain's choice among the segments of a mode: 0 always the one that joins best, large any; default: as "
       "learned"},
      {"steer", Kind::kText, "X,Y,Z@S", "",
       "be near this place (metres from where it starts, z up) after S seconds; a fall takes some 0.75 m of height a "
       "second"},
      {"near", Kind::kNumber, "M", "0.1", "metres: how near is near enough for --steer"},
  };
}

namespace {

constexpr double kReach = 4;  // deviations of walks that are not steered: beyond it steering has nothing to choose from

// Why a chain can't be steered.
Error unsteered(const ChainModel& chain) {
  if (!chain.systems) return {"the model can't be steered: an older Wisp learned it; learn it again"};
  return {
      "the model can't be steered: its modes are systems, which go on from where they are and leave nothing to choose; "
      "learn it with --realisation segments, spline or chain"};
}

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

Result<ChainWalk> chain_walk_from(const Model& model, const Arguments& arguments) {
  ChainWalk walk;
  const auto* chain = std::get_if<ChainModel>(&model.dynamics);
  for (const char* flag : {"history", "temperature", "steer"}) {
    if (arguments.has(flag) && !chain) {
      return Error{"--" + std::string(flag) + " is for segment chains, which this model is not"};
    }
  }
  if (arguments.has("history") && arguments.text("history") != "none") {
    walk.history = arguments.integer("history");
    if (walk.history < 1) {
      return Error{"--history is " + arguments.text("history") + ", expected at least 1, or none for as learned"};
    }
  }
  if (arguments.has("steer")) {
    auto target = target_from(arguments.text("steer"));
    if (!target) return target.error();
    target->near = static_cast<float>(arguments.number("near"));
    if (!(target->near >= 0.001F && target->near <= 1000)) {
      return Error{"--near is " + arguments.text("near") + ", expected 0.001 to 1000"};
    }
    if (!chain->drift) return unsteered(*chain);
    walk.target = *target;
  }
  if (!arguments.has("temperature")) return walk;
  walk.temperature = static_cast<float>(arguments.number("temperature"));
  if (!(*walk.temperature >= 0)) {
    return Error{"--temperature is " + arguments.text("temperature") + ", expected 0 or more"};
  }
  if (chain->segments.breadth == 0) {
    return Error{"--temperature chooses among best-joining segments, and the model was learned with --best-of 0"};
  }
  return walk;
}

void warn_of_target(const Model& model, const ChainWalk& walk, Terminal& terminal) {
  if (!walk.target) return;
  const ChainDrift& drift = *std::get<ChainModel>(model.dynamics).drift;
  const double seconds = std::chrono::duration<double>(walk.target->in).count();
  const auto& to = walk.target->position;
  const auto beyond = [&](std::size_t axis) { return to[axis] - drift.drift[axis] * seconds; };
  const double reach_ground = kReach * std::sqrt(2 * drift.spread_ground * seconds) + walk.target->near;
  const double reach_height = kReach * std::sqrt(drift.spread_height * seconds) + walk.target->near;
  const double away = std::hypot(beyond(0), beyond(1)), off_height = std::abs(beyond(2));
  if (away <= reach_ground && off_height <= reach_height) return;
  terminal.warn("--steer: the target lies out of reach: after " + shown(seconds, 3) + " s falls are " +
                shown(-drift.drift[2] * seconds, 3) + " m lower, give or take " + shown(reach_height, 2) +
                " m, and within " + shown(reach_ground, 2) + " m over ground; what is out of reach is not reached");
}

void say_chain_loop(const Model& model, const ChainWalk& walk, Terminal& terminal) {
  const auto loop = chain_loop(model, walk.history);
  if (!loop) return;
  terminal.add("loop.segments", loop->segments);
  terminal.add("loop.seconds", loop->seconds);
  terminal.add("loop.lead_seconds", loop->lead_seconds);
  terminal.say("without chance it repeats itself every " + shown(loop->seconds) + " s (" +
               std::to_string(loop->segments) + " segments), from " + shown(loop->lead_seconds) + " s on");
}

void set_walk(const ChainWalk& walk, Bank& bank) {
  ChainFacet* chain = bank.chain();
  if (!chain) return;
  chain->set_history(walk.history);
  chain->set_temperature(walk.temperature);
}

void steer_all(const ChainWalk& walk, Bank& bank) {
  ChainFacet* chain = bank.chain();
  if (!chain || !walk.target) return;
  for (int slot = 0; slot < bank.slots(); ++slot) chain->steer(bank.at(slot), *walk.target);
}

}  // namespace wisp::cli
