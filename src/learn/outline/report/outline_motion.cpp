// How an outline moves as a physicist asks: its height, area and lean, the frequency of its flicker, and of two
// outlines the phase between them.

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>
#include <optional>

#include "base/statistics.hpp"
#include "learn/numeric/spectrum.hpp"
#include "learn/outline/outline_shape.hpp"
#include "learn/outline/outline_units.hpp"
#include "record/number_text.hpp"
#include "wisp/learn/advice.hpp"

namespace wisp {
namespace {

constexpr double kWindowSeconds = 4;  // of a periodogram: a quarter of a hertz apart
constexpr double kLowestHz = 1;       // slower swaying is the room's
constexpr double kDegrees = 180 / std::numbers::pi;

// One row each; what has no outline is left out, and ends a stretch of sizes.
struct Motion {
  std::vector<double> height, area, lean;
  std::vector<double> size;  // √area of every row, NaN where there is no outline
};

double enclosed_by(std::span<const OutlinePoint> line) {
  double twice = 0;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const OutlinePoint &a = line[k], &b = line[(k + 1) % line.size()];
    twice += a[0] * b[1] - b[0] * a[1];
  }
  return std::abs(twice) / 2;
}

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
    out.area.push_back(enclosed_by(line));
    out.lean.push_back(std::atan2(x, up) * kDegrees);
    out.size.back() = std::sqrt(out.area.back());
  }
  return out;
}

std::vector<std::vector<double>> stretches_of(const std::vector<double>& samples, const Recording& recording) {
  std::vector<std::vector<double>> out(1);
  for (std::size_t row = 0; row < samples.size(); ++row) {
    const bool another =
        row > 0 && !recording.episode_ids.empty() && recording.episode_ids[row] != recording.episode_ids[row - 1];
    if ((another || std::isnan(samples[row])) && !out.back().empty()) out.emplace_back();
    if (!std::isnan(samples[row])) out.back().push_back(samples[row]);
  }
  return out;
}

// A peak of the spectrum, with its width where it is half as high.
struct Flicker {
  double hz = 0, width_hz = 0;
};

// Where the power passes half of the peak's on one side, by a straight line between two frequencies.
double half_power_hz(const Spectrum& of, std::size_t peak, int step) {
  std::size_t k = peak;
  const double half = of.power[peak] / 2;
  while (k > 0 && k + 1 < of.power.size() && of.power[k] > half) k = step < 0 ? k - 1 : k + 1;
  const std::size_t before = step < 0 ? k + 1 : k - 1;
  const double part =
      std::clamp((of.power[before] - half) / std::max(of.power[before] - of.power[k], 1e-300), 0.0, 1.0);
  return of.frequency_hz[before] + part * (of.frequency_hz[k] - of.frequency_hz[before]);
}

// The peak that rises most above the usual power within half an octave to either side; nothing where chance makes as
// much: in one of twenty series of noise a mean of n periodograms has such a peak of 1 + 5.5/√n.
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
  return 2 * static_cast<std::size_t>(std::lround(kWindowSeconds * rate_hz / 2));
}

void add_flicker(const Motion& motion, const Recording& recording, ReportSection& section) {
  const Spectrum spectrum =
      welch(stretches_of(motion.size, recording), recording.rate_hz, window_rows(recording.rate_hz));
  if (spectrum.segments < 3) {
    section.entries.push_back({"", "no stretch of 8 seconds without a gap", "flicker", ""});
    return;
  }
  const auto flicker = flicker_of(spectrum);
  if (!flicker) {
    section.entries.push_back({"", "no frequency of its own: its power falls with frequency", "flicker", ""});
  } else {
    section.entries.push_back(
        {"flicker_hz", flicker->hz, "flicker", "Hz", {}, "where the spectrum of √area has its peak"});
    section.entries.push_back(
        {"flicker_width_hz",
         flicker->width_hz,
         "its width",
         "Hz",
         {},
         "at half of its power; periodograms tell " + number_text(1.5 / kWindowSeconds, 2) + " Hz apart"});
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
  add_flicker(motion, recording, section);
  return section;
}

// How two series move together at a frequency: the phase of b after a in degrees, −180 to 180, and their coherence.
struct Together {
  double phase = 0, coherence = 0;
  std::size_t windows = 0;
};

Together together_at(double hz, const std::vector<double>& a, const std::vector<double>& b, double rate_hz) {
  const std::size_t length = window_rows(rate_hz);
  std::complex<double> cross = 0;
  double power_a = 0, power_b = 0;
  Together out;
  for (std::size_t first = 0; first + length <= std::min(a.size(), b.size()); first += length / 2) {
    const std::span<const double> x(a.data() + first, length), y(b.data() + first, length);
    const double mean_x = mean(x), mean_y = mean(y);
    std::complex<double> of_x = 0, of_y = 0;
    for (std::size_t k = 0; k < length; ++k) {
      const double turn = 2 * std::numbers::pi * static_cast<double>(k);
      const double window = 0.5 - 0.5 * std::cos(turn / static_cast<double>(length));
      const auto wave = std::polar(window, -turn * hz / rate_hz);
      of_x += wave * (x[k] - mean_x);
      of_y += wave * (y[k] - mean_y);
    }
    const auto product = of_x * std::conj(of_y);
    if (std::isnan(product.real())) continue;
    cross += product;
    power_a += std::norm(of_x);
    power_b += std::norm(of_y);
    ++out.windows;
  }
  out.phase = std::arg(cross) * kDegrees;
  out.coherence = std::norm(cross) / std::max(power_a * power_b, 1e-300);
  return out;
}

// Independent series have a coherence of 1/windows on average, and one above this in one of twenty cases
// (G. C. Carter, "Coherence and time delay estimation", Proc. IEEE 75, 1987).
double coherence_by_chance(std::size_t windows) {
  return 1 - std::pow(0.05, 1 / std::max(1.0, static_cast<double>(windows) - 1));
}

ReportSection between(const Recording& a, const Motion& of_a, const Motion& of_b) {
  ReportSection section{"Between the two"};
  const Spectrum spectrum = welch(stretches_of(of_a.size, a), a.rate_hz, window_rows(a.rate_hz));
  const auto flicker = spectrum.segments < 3 ? std::nullopt : flicker_of(spectrum);
  if (!flicker) {
    section.entries.push_back({"", "the first has no flicker of one frequency", "phase", ""});
    return section;
  }
  const Together found = together_at(flicker->hz, of_a.size, of_b.size, a.rate_hz);
  const double chance = coherence_by_chance(found.windows);
  section.entries.push_back(
      {"phase",
       found.phase,
       "phase",
       "degrees",
       {},
       "of the second after the first at " + number_text(flicker->hz, 3) + " Hz: 0 together, 180 by turns"});
  section.entries.push_back({"coherence",
                             found.coherence,
                             "coherence",
                             "",
                             {},
                             (found.coherence > chance ? "they move together: chance gives at most "
                                                       : "the phase says nothing: chance gives up to ") +
                                 number_text(chance, 2)});
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
