// Physical figures of an outline's motion: height, area, lean, flicker frequency, and for two outlines the phase
// between them.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/statistics.hpp"
#include "learn/numeric/spectrum.hpp"
#include "learn/outline/outline_shape.hpp"
#include "learn/outline/outline_units.hpp"
#include "learn/report/report_values.hpp"
#include "record/number_text.hpp"
#include "wisp/learn/advice.hpp"

namespace wisp {
namespace {

constexpr double kWindowSeconds = 4;  // duration of a periodogram's segment: resolution 0.25 Hz
constexpr double kLowestHz = 1;       // slower motion is attributed to draught in the room
constexpr std::size_t kMinSegments = 3;
constexpr double kDegrees = 180 / std::numbers::pi;

// Gap-free stretches of samples within episodes.
std::vector<std::vector<double>> stretches_of(const std::vector<double>& samples, const Recording& recording) {
  std::vector<std::vector<double>> out;
  for (const Episode& episode : episodes(recording)) {
    const auto own = std::span(samples).subspan(episode.begin, episode.end - episode.begin);
    for (auto& one : whole_stretches(own)) out.push_back(std::move(one));
  }
  return out;
}

// A spectral peak with its width at half height.
struct Flicker {
  double hz = 0, width_hz = 0;
};

// Frequency below (step −1) or above (1) a peak at which the power is half of the peak's, interpolated linearly.
double half_power_hz(const Spectrum& of, std::size_t peak, int step) {
  std::size_t k = peak;
  const double half = of.power[peak] / 2;
  while (k > 0 && k + 1 < of.power.size() && of.power[k] > half) k = step < 0 ? k - 1 : k + 1;
  const std::size_t before = step < 0 ? k + 1 : k - 1;
  const double part =
      std::clamp((of.power[before] - half) / std::max(of.power[before] - of.power[k], 1e-300), 0.0, 1.0);
  return of.frequency_hz[before] + part * (of.frequency_hz[k] - of.frequency_hz[before]);
}

// Returns the peak with the largest ratio to the median power within half an octave on either side. Empty if the ratio
// is at most 1 + 5.5/√n, which one of twenty noise series exceeds in a mean of n periodograms.
std::optional<Flicker> flicker_of(const Spectrum& of) {
  double most = 1 + 5.5 / std::sqrt(static_cast<double>(of.segments));
  std::size_t peak = 0;
  for (std::size_t k = 1; k + 1 < of.power.size(); ++k) {
    if (of.frequency_hz[k] < kLowestHz || of.power[k] < std::max(of.power[k - 1], of.power[k + 1])) continue;
    const auto at = static_cast<double>(k);
    const auto first = of.power.begin() + std::lround(at / std::numbers::sqrt2),
               last = of.power.begin() + std::min(std::lround(at * std::numbers::sqrt2) + 1, std::ssize(of.power));
    const double rise = of.power[k] / std::max(median(std::vector<double>(first, last)), 1e-300);
    if (rise <= most) continue;
    most = rise;
    peak = k;
  }
  if (peak == 0) return std::nullopt;
  return Flicker{of.frequency_hz[peak], half_power_hz(of, peak, 1) - half_power_hz(of, peak, -1)};
}

std::size_t window_rows(double rate_hz) {
  return 2 * std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(kWindowSeconds * rate_hz / 2)));
}

// Values per row. `height`, `area` and `lean` omit rows without an outline.
struct Motion {
  std::vector<double> height, area, lean;
  std::vector<double> size;  // √area per row, NaN without an outline
  Spectrum spectrum;         // spectrum of size
  std::optional<Flicker> flicker;
};

Motion motion_of(const Recording& recording, const OutlineLayout& layout) {
  const OutlineCurve curve(layout.knots);
  Motion out;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const std::vector<double> control = whole_row(recording, layout, row);
    out.size.push_back(std::nan(""));
    if (control.empty()) continue;
    const auto line = curve.polyline(control);
    const OutlinePoint tip = tip_of(line);
    const double x = tip[0] - (line.front()[0] + line.back()[0]) / 2,
                 up = (line.front()[1] + line.back()[1]) / 2 - tip[1];
    out.height.push_back(height_of(line));
    out.area.push_back(enclosed_area(line));
    out.lean.push_back(std::atan2(x, up) * kDegrees);
    out.size.back() = std::sqrt(out.area.back());
  }
  out.spectrum = welch(stretches_of(out.size, recording), recording.rate_hz, window_rows(recording.rate_hz));
  if (out.spectrum.segments >= kMinSegments) out.flicker = flicker_of(out.spectrum);
  return out;
}

void add_flicker(const Motion& motion, ReportSection& section) {
  const Spectrum& spectrum = motion.spectrum;
  if (spectrum.segments < kMinSegments) {
    return arx::add_line(section, "flicker", "no stretch of 8 seconds without a gap");
  }
  if (!motion.flicker) {
    arx::add_line(section, "flicker", "no frequency of its own: its power falls with frequency");
  } else {
    arx::add(section, "flicker_hz", motion.flicker->hz, "flicker", "Hz", "where the spectrum of √area has its peak");
    arx::add(section, "flicker_width_hz", motion.flicker->width_hz, "its width", "Hz",
             "at half of its power; periodograms tell " + number_text(1.5 / kWindowSeconds, 2) + " Hz apart");
  }
  section.series.push_back(
      {"flicker", "√area", "frequency, Hz", "power, px²/Hz", spectrum.frequency_hz, spectrum.power});
}

ReportSection section_of(const Recording& recording, const Motion& motion) {
  ReportSection section{recording.source.empty() ? "Outline" : "Outline of " + recording.source};
  ReportTable table{
      "motion", "motion", {{"what", "of"}, {"mean", "mean"}, {"deviation", "deviation"}, {"unit", "unit"}}, {}};
  table.rows.push_back({"height", mean(motion.height), deviation(motion.height), "px"});
  table.rows.push_back({"area", mean(motion.area), deviation(motion.area), "px²"});
  table.rows.push_back({"lean", mean(motion.lean), deviation(motion.lean), "degrees to the right"});
  section.tables.push_back(std::move(table));
  add_flicker(motion, section);
  return section;
}

// Coherence that independent series exceed in one of twenty cases (G. C. Carter, "Coherence and time delay estimation",
// Proc. IEEE 75, 1987); overlapping segments count half.
double coherence_by_chance(std::size_t segments) {
  if (segments < kMinSegments) return 1;
  return 1 - std::pow(0.05, 1 / std::max(1.0, static_cast<double>(segments - 1) / 2));
}

ReportSection between(const Recording& a, const Motion& of_a, const Motion& of_b) {
  ReportSection section{"Between the two"};
  if (!of_a.flicker) {
    arx::add_line(section, "phase", "the first has no flicker of one frequency");
    return section;
  }
  const CrossSpectrum found = cross_spectrum(of_a.size, of_b.size, a.rate_hz, window_rows(a.rate_hz), of_a.flicker->hz);
  const double chance = coherence_by_chance(found.segments);
  arx::add(section, "phase", found.phase * kDegrees, "phase", "degrees",
           "of the second after the first at " + number_text(of_a.flicker->hz, 3) + " Hz: 0 together, 180 by turns");
  arx::add(section, "coherence", found.coherence, "coherence", "",
           (found.coherence > chance ? "they move together: chance gives at most "
                                     : "the phase says nothing: chance gives up to ") +
               number_text(chance, 2));
  return section;
}

}  // namespace

Result<Report> outline_motion(std::span<const Recording> recordings) {
  Report report;
  std::vector<Motion> motions;
  for (const Recording& recording : recordings) {
    const auto layout = outline_layout(recording);
    if (!layout) return layout.error();
    motions.push_back(motion_of(recording, *layout));
    if (motions.back().height.size() < 2) return Error{recording.source + ": has no outline in two rows"};
    report.sections.push_back(section_of(recording, motions.back()));
  }
  for (std::size_t k = 1; k < recordings.size(); ++k) {
    if (recordings[k].rate_hz != recordings[0].rate_hz || recordings[k].rows() != recordings[0].rows()) {
      return Error{recordings[k].source + ": has " + std::to_string(recordings[k].rows()) + " rows at " +
                   number_text(recordings[k].rate_hz, 6) + " Hz, expected those of " + recordings[0].source +
                   ", filmed at the same time"};
    }
    report.sections.push_back(between(recordings[0], motions[0], motions[k]));
  }
  return report;
}

}  // namespace wisp
