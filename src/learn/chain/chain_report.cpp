#include "learn/chain/chain_report.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "record/number_text.hpp"

namespace wisp::chain {
namespace {

constexpr double kMaxShareOfCeiling = 0.5;  // a distance above it is nearer to rows in random order than to falls

std::array<std::pair<const char*, const Bounded*>, 3> measures_of(const ChainFidelity& fidelity) {
  return {{{"over half a second", &fidelity.energy_distance},
           {"over two seconds", &fidelity.long_energy_distance},
           {"by spectra", &fidelity.spectra}}};
}

// Entries with a value, a label (empty: for programs only), a unit and a meaning.
class Entries {
 public:
  explicit Entries(ReportSection& section) : section_(section) {}
  void add(std::string id, double value, std::string label, std::string unit = "", std::string meaning = "") {
    section_.entries.push_back({std::move(id), value, std::move(label), std::move(unit), {}, std::move(meaning)});
  }

 private:
  ReportSection& section_;
};

void add_falls(const std::string& which, const FallFigures& falls, const std::string& label, bool has_orientation,
               Entries& entries) {
  const std::string id = "fidelity." + which + ".";
  entries.add(id + "descent_speed", falls.descent_speed, label + "descent", "m/s");
  entries.add(id + "lateral_spread", falls.lateral_spread, label + "lateral spread", "m",
              "root-mean-square distance over ground between start and end");
  entries.add(id + "event_seconds", falls.event_seconds, label + "time between events", "s");
  entries.add(id + "flips_per_second", falls.flips_per_second, has_orientation ? label + "flips" : "", "1/s");
}

void add_jumps(const std::string& id, const std::string& what, double share, double floor, Entries& entries) {
  const std::string label = what.empty() ? "" : "joins that jump in " + what;
  entries.add(id + ".share_above", share, label, "",
              "share above the recording's 99th percentile; 0.01 where joins are like any row");
  entries.add(id + ".floor.share_above", floor, label.empty() ? "" : "  the recording's own events", "",
              "which nobody joined");
}

void add_bounded(const std::string& id, const Bounded& measure, const std::string& label, const std::string& meaning,
                 Entries& entries) {
  entries.add(id + ".value", measure.value, label, "", meaning);
  entries.add(id + ".floor", measure.floor, "  floor", "", "two halves of the recorded falls");
  entries.add(id + ".ceiling", measure.ceiling, "  ceiling", "", "recorded rows in random order");
}

ReportList row_of(const std::vector<double>& values, std::size_t row, std::size_t columns) {
  const auto first = values.begin() + static_cast<long>(row * columns);
  return {first, first + static_cast<long>(columns)};
}

}  // namespace

ReportSection segments_section(const ChainSummary& summary) {
  ReportSection section{"Segments"};
  auto& entries = section.entries;
  const auto modes = static_cast<std::size_t>(summary.modes);
  ReportList transitions;
  for (std::size_t from = 0; from < modes; ++from) transitions.push_back(row_of(summary.transitions, from, modes));
  entries = {
      {"segments", summary.segments, "segments", "", {}, "of the stretches that were learned from"},
      {"stored", summary.stored, "stored", ""},
      {"mean_segment_seconds", summary.mean_segment_seconds, "mean duration", "s"},
      {"stretches.learned", summary.stretches_learned, "stretches learned from", ""},
      {"stretches.held_out", summary.stretches_held_out, "stretches held out", ""},
      {"modes", summary.modes, modes > 1 ? "modes" : "", ""},
      {"mode_sizes", ReportList(summary.mode_sizes.begin(), summary.mode_sizes.end()),
       modes > 1 ? "segments of each mode" : "", ""},
      {"history", summary.history, modes > 1 ? "history" : "", "modes"},
      {"initial", summary.initial, "", ""},
      {"transitions", transitions, "", ""},
      {"silhouette", summary.silhouette, modes > 1 ? "silhouette" : "", "", {}, "-1 to 1; high where modes are tight"},
      {"log_likelihood",
       summary.log_likelihood,
       modes > 1 ? "log-likelihood" : "",
       "nats a segment",
       {},
       "of held-out modes"},
  };
  for (std::size_t from = 0; modes > 1 && from < modes; ++from) {
    entries.push_back({"", transitions[from], "probabilities after mode " + std::to_string(from), ""});
  }
  return section;
}

ReportSection fidelity_section(const ChainFidelity& fidelity, bool has_orientation) {
  ReportSection section{"Fidelity: synthesized falls against recorded ones"};
  Entries entries(section);
  add_bounded("fidelity.energy_distance", fidelity.energy_distance, "energy distance", "0: one distribution, to 1",
              entries);
  section.entries.push_back({"fidelity.windows", fidelity.windows, "windows", "", {}, "a side"});
  entries.add("fidelity.window_seconds", fidelity.window_seconds, "length of a window", "s");
  add_bounded("fidelity.two_seconds", fidelity.long_energy_distance, "energy distance over 2 s",
              "of windows of two seconds", entries);
  add_bounded("fidelity.spectra", fidelity.spectra, "energy distance of spectra",
              "of log powers over two seconds, but for what is below 0.3 mm and 0.2°", entries);
  add_falls("real", fidelity.real, "recorded ", has_orientation, entries);
  add_falls("synthesized", fidelity.synthesized, "synthesized ", has_orientation, entries);
  const JoinDefect& defect = fidelity.join_defect;
  add_jumps("join_defect.position", "position", defect.position, defect.position_floor, entries);
  add_jumps("join_defect.rotation", has_orientation ? "orientation" : "", defect.rotation, defect.rotation_floor,
            entries);
  return section;
}

Judged judged_by(const ChainFidelity& fidelity) {
  Judged out;
  for (const auto& [name, measure] : measures_of(fidelity)) {
    // Where halves of the recorded falls are as far apart as rows in random order, nothing can be told from them.
    const bool told = measure->floor < kMaxShareOfCeiling * measure->ceiling;
    std::string& names = told ? out.judged : out.unjudged;
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return out;
}

std::optional<std::string> fault_of(const ChainFidelity& fidelity) {
  if (std::isnan(fidelity.synthesized.event_seconds)) {
    return "its falls have no events, and recorded ones have one every " + number_text(fidelity.real.event_seconds, 3) +
           " s: record more, or choose another event, realisation or number of modes";
  }
  for (const auto& [name, measure] : measures_of(fidelity)) {
    // Few windows are far apart by chance, recorded ones too.
    if (!(measure->value > kMaxShareOfCeiling * measure->ceiling) || measure->value <= measure->floor) continue;
    return "its falls are not like the recorded ones (energy distance " + std::string(name) + " " +
           number_text(measure->value, 3) + "; rows in random order have " + number_text(measure->ceiling, 3) +
           "): record more, or choose another event, realisation or number of modes";
  }
  return {};
}

void add_figures(const ChainFidelity& fidelity, Training& training) {
  const std::pair<const char*, double> figures[] = {
      {"energy_distance", fidelity.energy_distance.value},
      {"energy_distance_floor", fidelity.energy_distance.floor},
      {"descent_speed", fidelity.synthesized.descent_speed},
      {"descent_speed_recorded", fidelity.real.descent_speed},
  };
  for (const auto& [name, value] : figures) {
    if (std::isfinite(value)) training.figures.push_back({name, value});
  }
}

}  // namespace wisp::chain
