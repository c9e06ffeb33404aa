#include "reports/chain_json.hpp"

#include <cmath>

namespace wisp::cli {
namespace {

Json falls_json(const FallFigures& falls) {
  return {{"descent_speed", number(falls.descent_speed)},
          {"lateral_spread", number(falls.lateral_spread)},
          {"event_seconds", number(falls.event_seconds)},
          {"flips_per_second", number(falls.flips_per_second)}};
}

Json jumps_json(const JoinJumps& jumps, const JoinJumps& floor) {
  return {{"percentile_99", number(jumps.percentile_99)},
          {"median", number(jumps.median)},
          {"share_above", number(jumps.share_above)},
          {"floor",
           {{"percentile_99", number(floor.percentile_99)},
            {"median", number(floor.median)},
            {"share_above", number(floor.share_above)}}}};
}

std::string against(const char* what, double made, double real) {
  return "  " + std::string(what) + " " + shown(made) + " (recorded " + shown(real) + ")";
}

}  // namespace

Json matrix_json(const std::vector<double>& values, int size) {
  Json rows = Json::array();
  for (int i = 0; i < size; ++i) {
    Json row = Json::array();
    for (int j = 0; j < size; ++j) row.push_back(number(values[static_cast<std::size_t>(i * size + j)]));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json fidelity_json(const ChainFidelity& fidelity) {
  return {{"energy_distance",
           {{"value", number(fidelity.energy_distance.value)},
            {"floor", number(fidelity.energy_distance.floor)},
            {"ceiling", number(fidelity.energy_distance.ceiling)}}},
          {"energy_p_value", number(fidelity.energy_p_value)},
          {"windows", fidelity.windows},
          {"window_seconds", number(fidelity.window_seconds)},
          {"real", falls_json(fidelity.real)},
          {"synthesized", falls_json(fidelity.synthesized)}};
}

Json join_defect_json(const JoinDefect& defect) {
  return {{"position", jumps_json(defect.position, defect.position_floor)},
          {"rotation", jumps_json(defect.rotation, defect.rotation_floor)}};
}

void say_fidelity(const ChainFidelity& fidelity, Terminal& terminal) {
  const Bounded& energy = fidelity.energy_distance;
  terminal.say("normalised energy distance " + shown(energy.value) + " (two halves of the recorded falls " +
               shown(energy.floor) + ", shuffled frames " + shown(energy.ceiling) + ")");
  const FallFigures &made = fidelity.synthesized, &real = fidelity.real;
  terminal.say(against("descent, m/s:", made.descent_speed, real.descent_speed));
  terminal.say(against("lateral spread, m:", made.lateral_spread, real.lateral_spread));
  terminal.say(against("seconds between events:", made.event_seconds, real.event_seconds));
  terminal.say(against("flips a second:", made.flips_per_second, real.flips_per_second));
  const JoinDefect& defect = fidelity.join_defect;
  terminal.say("  jumps at joins above the recording's 99th percentile: " + shown(100 * defect.position.share_above) +
               " % in position, " + shown(100 * defect.rotation.share_above) + " % in orientation (at its own events " +
               shown(100 * defect.position_floor.share_above) + " % and " +
               shown(100 * defect.rotation_floor.share_above) + " %)");
}

void add_figures(const ChainFidelity& fidelity, Training& made) {
  const std::pair<const char*, double> figures[] = {
      {"energy_distance", fidelity.energy_distance.value},
      {"energy_distance_floor", fidelity.energy_distance.floor},
      {"descent_speed", fidelity.synthesized.descent_speed},
      {"descent_speed_recorded", fidelity.real.descent_speed},
  };
  for (const auto& [name, value] : figures) {
    if (std::isfinite(value)) made.figures.push_back({name, value});
  }
}

}  // namespace wisp::cli
