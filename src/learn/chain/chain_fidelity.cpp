#include "learn/chain/chain_fidelity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

#include "base/statistics.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/report/report_values.hpp"
#include "record/number_text.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"

namespace wisp::chain {
namespace {

using arx::add;

constexpr double kPercentile = 0.99;      // quantile of all rows' jumps, above which a row at a join jumps
constexpr double kWindowSegments = 2.5;   // duration of a window, in mean segment durations
constexpr std::size_t kMaxWindows = 500;  // maximum number of windows on each side
constexpr int kSynthesizedPerReal = 2;    // synthesized falls per recorded fall
constexpr double kLongWindowSeconds = 2;
constexpr double kUnseenMetres = 0.3e-3, kUnseenRadians = 0.2 * std::numbers::pi / 180;  // smaller motion is invisible

struct Jumps {
  std::vector<double> position;
  std::vector<double> rotation;
};

template <std::size_t kSize>
double jump_of(std::span<const std::array<double, kSize>> values, std::size_t row) {
  double square = 0;
  for (std::size_t k = 0; k < kSize; ++k) {
    square += std::pow(values[row][k] - 2 * values[row - 1][k] + values[row - 2][k], 2);
  }
  return std::sqrt(square);
}

void add_jump(const MotionPiece& piece, std::size_t row, Jumps& jumps) {
  jumps.position.push_back(jump_of<3>(piece.position, row));
  if (!piece.orientation.empty()) jumps.rotation.push_back(jump_of<4>(piece.orientation, row));
}

double share_above(const std::vector<double>& joins, const std::vector<double>& all) {
  if (joins.empty() || all.empty()) return 0;
  const double usual = quantile(all, kPercentile);
  const auto above = std::count_if(joins.begin(), joins.end(), [&](double jump) { return jump > usual; });
  return static_cast<double>(above) / static_cast<double>(joins.size());
}

// Returns the jumps at joins: those in each join's row and in the row after.
Jumps jumps_at(const Motion& motion, std::span<const std::vector<std::size_t>> rows) {
  Jumps jumps;
  for (std::size_t k = 0; k < motion.pieces.size(); ++k) {
    for (std::size_t join : rows[k]) {
      for (std::size_t row = std::max<std::size_t>(2, join); row <= join + 1 && row < motion.pieces[k].rows(); ++row) {
        add_jump(motion.pieces[k], row, jumps);
      }
    }
  }
  return jumps;
}

// Compares jumps at joins with those of all rows. `joins`: for each piece of `made`, the rows at which segments join.
JoinDefect join_defect(const Motion& real, std::span<const Segment> segments, const Motion& made,
                       std::span<const std::vector<std::size_t>> joins) {
  Jumps all;
  for (const MotionPiece& piece : real.pieces) {
    for (std::size_t row = 2; row < piece.rows(); ++row) add_jump(piece, row, all);
  }
  std::vector<std::vector<std::size_t>> events(real.pieces.size());
  for (const Segment& one : segments) events[one.piece].push_back(static_cast<std::size_t>(std::lround(one.begin)));
  const Jumps joined = jumps_at(made, joins), natural = jumps_at(real, events);
  return {share_above(joined.position, all.position), share_above(joined.rotation, all.rotation),
          share_above(natural.position, all.position), share_above(natural.rotation, all.rotation)};
}

constexpr std::size_t kTiltColumn = 3;  // column of tilt in the series of poses
constexpr double kUnseenTilt = 3.5e-3;  // rad, 0.2°, the limit of the eye: noise of this size is added to tilt
constexpr double kMinSpeed = 0.05;      // m/s: below this speed heading is undefined

void add_row(const Motion& motion, const MotionPiece& piece, std::size_t row, double segment_seconds,
             std::vector<double>& out) {
  const Triple& v = piece.velocity[row];
  out.push_back(-v[2]);
  out.push_back(std::hypot(v[0], v[1]));
  if (motion.has_orientation) {
    out.push_back(std::abs(piece.spin[row][2]));
    const Triple normal = in_world_axes(piece.orientation[row], {0, 0, 1});
    out.push_back(std::acos(std::clamp(normal[2], -1.0, 1.0)));
    out.push_back(length_of(piece.spin[row]));
  } else {
    const Triple& next = piece.velocity[std::min(row + 1, piece.rows() - 1)];
    const double speed = v[0] * v[0] + v[1] * v[1];
    const double across = v[0] * next[1] - v[1] * next[0];
    out.push_back(std::abs(across) * motion.rate_hz / std::max(speed, kMinSpeed * kMinSpeed));
  }
  out.push_back(segment_seconds);
}

// Appends mean, standard deviation, minimum and maximum of one column over a range of rows.
void add_figures(const Stretch& series, std::size_t first, std::size_t rows, std::size_t column,
                 std::vector<double>& out) {
  double sum = 0, square = 0, least = 0, most = 0;
  for (std::size_t row = first; row < first + rows; ++row) {
    const double x = series.values[row * series.channels + column];
    sum += x;
    square += x * x;
    least = row == first ? x : std::min(least, x);
    most = row == first ? x : std::max(most, x);
  }
  const double mean = sum / static_cast<double>(rows);
  const double variance = std::max(0.0, square / static_cast<double>(rows) - mean * mean);
  out.insert(out.end(), {mean, std::sqrt(variance), least, most});
}

constexpr double kFlipMargin = 0.2;  // magnitude of the normal's z below which neither side counts as facing up

Recording empty_fall(const Model& model) {
  Recording fall;
  fall.source = "synthesized";
  fall.rate_hz = model.rate_hz;
  for (const Output& output : model.outputs) fall.channels.push_back({output.name, output.unit, Role::kOutput, {}});
  return fall;
}

double flips_of(const MotionPiece& piece) {
  double flips = 0;
  int side = 0;
  for (const Quad& q : piece.orientation) {
    const double height = in_world_axes(q, {0, 0, 1})[2];
    if (std::abs(height) < kFlipMargin) continue;
    const int up = height > 0 ? 1 : -1;
    if (side != 0 && up != side) ++flips;
    side = up;
  }
  return flips;
}

FallFigures figures_of(const Motion& motion, std::span<const Segment> segments) {
  FallFigures figures;
  double seconds = 0, descent = 0, spread = 0, flips = 0, between = 0;
  for (const MotionPiece& piece : motion.pieces) {
    const Triple &from = piece.position.front(), &to = piece.position.back();
    seconds += static_cast<double>(piece.rows() - 1) / motion.rate_hz;
    descent += from[2] - to[2];
    spread += (to[0] - from[0]) * (to[0] - from[0]) + (to[1] - from[1]) * (to[1] - from[1]);
    flips += flips_of(piece);
  }
  for (const Segment& one : segments) between += (one.end - one.begin) / motion.rate_hz;
  figures.descent_speed = descent / seconds;
  figures.lateral_spread = std::sqrt(spread / static_cast<double>(motion.pieces.size()));
  figures.event_seconds = between / static_cast<double>(segments.size());
  figures.flips_per_second = flips / seconds;
  return figures;
}

// Energy distance between windows, at most kMaxWindows on each side.
double energy_of(const FeatureWindows& reference, const FeatureWindows& other) {
  FeatureWindows x = thinned(reference, kMaxWindows);
  FeatureWindows y = thinned(other, kMaxWindows);
  if (x.size() < 2 || y.size() < 2) return kMissing;
  standardise(x, y);
  return energy_distance(x, y);
}

// Distance between real and made falls, its floor (between two halves of the real falls: every other fall, or a single
// fall cut in time) and its ceiling (from real falls to their rows in random order). `windows_of` cuts falls into
// windows.
template <typename Windows>
Bounded compared(std::span<const Stretch> real, std::span<const Stretch> made, std::uint64_t seed,
                 const Windows& windows_of) {
  Halves halves;
  if (real.size() == 1) halves = halves_of(real);
  for (std::size_t k = 0; real.size() > 1 && k < real.size(); ++k) {
    (k % 2 == 0 ? halves.first : halves.second).push_back(real[k]);
  }
  const auto apart = [&](std::span<const Stretch> a, std::span<const Stretch> b) {
    return energy_of(windows_of(a), windows_of(b));
  };
  return {apart(real, made), apart(halves.first, halves.second), apart(real, shuffled(real, seed))};
}

// Signals that an eye follows: descent and speed over ground; for poses also the height of the normal, and velocities
// and spins in body axes. Noise at the limit of visibility is added.
std::vector<Stretch> signals_of(const Motion& motion, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto noise = [&] { return std::sqrt(12.0) * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5); };
  std::vector<Stretch> out;
  for (const MotionPiece& piece : motion.pieces) {
    const bool pose = motion.has_orientation;
    Stretch& own = out.emplace_back(Stretch{pose ? std::size_t{9} : std::size_t{2}, {}});
    std::vector<double> before(own.channels);
    for (std::size_t row = 0; row < piece.rows(); ++row) {
      std::vector<double> values{piece.velocity[row][2], std::hypot(piece.velocity[row][0], piece.velocity[row][1])};
      if (pose) {
        const Quad& q = piece.orientation[row];
        for (const Triple& x : {in_body_axes(q, piece.velocity[row]), in_body_axes(q, piece.spin[row])})
          values.insert(values.end(), x.begin(), x.end());
        values.push_back(std::abs(in_world_axes(q, {0, 0, 1})[2]));
      }
      for (std::size_t k = 0; k < values.size(); ++k) {
        const double unseen = (k < 5 ? kUnseenMetres : kUnseenRadians) * noise();
        own.values.push_back(values[k] + (k < 8 ? motion.rate_hz * (unseen - before[k]) : unseen));
        before[k] = unseen;
      }
    }
  }
  return out;
}

// Returns the rows of a window of two seconds, made even. If they are fewer than the 8 that spectra need, returns more
// rows than any stretch has, so that there is no window.
std::size_t long_rows(double rate_hz) {
  const auto rows = 2 * static_cast<std::size_t>(std::lround(kLongWindowSeconds / 2 * rate_hz));
  return rows >= 8 ? rows : std::numeric_limits<std::size_t>::max() / 2;
}

}  // namespace

std::vector<Stretch> motion_series(const Motion& motion, std::span<const Segment> segments) {
  std::vector<Stretch> series(motion.pieces.size());
  for (const Segment& segment : segments) {
    Stretch& own = series[segment.piece];
    own.channels = motion.has_orientation ? 6 : 4;
    const double seconds = (segment.end - segment.begin) / motion.rate_hz;
    const auto end = static_cast<std::size_t>(std::ceil(segment.end));
    for (auto row = static_cast<std::size_t>(std::ceil(segment.begin)); row < end; ++row) {
      add_row(motion, motion.pieces[segment.piece], row, seconds, own.values);
    }
  }
  return series;
}

FeatureWindows series_windows(std::span<const Stretch> series, std::size_t rows) {
  FeatureWindows windows;
  std::mt19937_64 random(rows);
  for (const Stretch& own : series) {
    for (std::size_t first = 0; first + rows <= own.rows(); first += rows) {
      for (std::size_t column = 0; column < own.channels; ++column) {
        add_figures(own, first, rows, column, windows.values);
        if (own.channels != 6 || column != kTiltColumn) continue;
        for (std::size_t k = windows.values.size() - 4; k < windows.values.size(); ++k) {
          windows.values[k] += kUnseenTilt * (2 * (static_cast<double>(random() >> 11) * 0x1p-53) - 1);
        }
      }
      windows.features = 4 * own.channels;
    }
  }
  return windows;
}

Result<MadeFalls> made_falls(const Model& model, std::span<const std::size_t> rows, std::uint64_t seed) {
  auto bank = Bank::create(model, {.capacity = static_cast<int>(rows.size()), .seed = seed});
  if (!bank) return bank.error();
  std::vector<InstanceId> ids;
  while (ids.size() < rows.size()) ids.push_back(bank->spawn());
  MadeFalls made{std::vector<Recording>(rows.size(), empty_fall(model)),
                 std::vector<std::vector<std::size_t>>(rows.size()), std::vector<std::vector<int>>(rows.size())};
  std::vector<float> outputs(model.outputs.size());
  const ChainFacet* chain = bank->chain();
  for (std::size_t row = 0; bank->size() > 0; ++row) {
    if (row > 0) bank->step();
    for (std::size_t k = 0; k < ids.size(); ++k) {
      if (row >= rows[k]) bank->end(ids[k]);
      if (!bank->outputs(ids[k], outputs)) continue;
      for (std::size_t i = 0; i < outputs.size(); ++i) made.falls[k].channels[i].samples.push_back(outputs[i]);
      if (!chain) continue;
      const ChainPlace place = *chain->place_of(ids[k]);
      made.modes[k].push_back(static_cast<int>(place.mode));
      if (row > 0 && place.step == 0) made.joins[k].push_back(row);
    }
  }
  return made;
}

Result<ChainFidelity> chain_fidelity(const Model& model, std::span<const Recording> real,
                                     const ChainFidelityOptions& options) {
  auto seen = motion_of(real, options.smooth_rows);
  if (!seen) return seen.error();
  if (auto ok = check_rate(model, real.front()); !ok) return ok.error();
  if (seen->has_orientation != std::holds_alternative<PoseView>(model.view))
    return Error{real.front().source + ": either it or the model has orientation, expected both or neither"};
  auto cut = segment(*seen, real, options.segmentation);
  if (!cut) return cut.error();
  const std::string& signal = options.segmentation.event.signal;
  bool played_too = signal.ends_with("speed");
  for (const Output& output : model.outputs) played_too |= output.name == signal;
  if (!played_too) return Error{"falls cut at events of " + signal + " cannot be judged: the model does not play it"};
  std::vector<std::size_t> lengths;  // each made fall is as long as the recorded fall that it is compared with
  for (int k = 0; k < kSynthesizedPerReal; ++k) {
    for (const MotionPiece& piece : seen->pieces) lengths.push_back(piece.rows());
  }
  auto made = made_falls(model, lengths, options.seed);
  if (!made) return made.error();
  auto played = motion_of(made->falls, options.smooth_rows);
  if (!played) return played.error();
  // A model whose play has no events has no segments to compare; the report says so.
  const auto played_cut = segment(*played, made->falls, options.segmentation);
  const std::vector<Segment> played_segments = played_cut ? played_cut->segments : std::vector<Segment>();
  ChainFidelity out;
  out.real = figures_of(*seen, cut->segments);
  out.synthesized = figures_of(*played, played_segments);
  const auto rows = static_cast<std::size_t>(std::lround(kWindowSegments * out.real.event_seconds * model.rate_hz));
  out.window_seconds = static_cast<double>(rows) / model.rate_hz;
  const auto seen_series = motion_series(*seen, cut->segments);
  const auto played_series = motion_series(*played, played_segments);
  const auto over = [&](std::size_t length) {
    return compared(seen_series, played_series, options.seed,
                    [length](std::span<const Stretch> series) { return series_windows(series, length); });
  };
  out.energy_distance = over(std::max<std::size_t>(2, rows));
  out.windows = std::min(series_windows(seen_series, std::max<std::size_t>(2, rows)).size(), kMaxWindows);
  out.long_energy_distance = over(long_rows(model.rate_hz));
  out.spectra = spectra_apart(*seen, *played, options.seed);
  out.join_defect = join_defect(*seen, cut->segments, *played, made->joins);
  return out;
}

double longest_verbatim_seconds(const Model& model, std::span<const std::uint64_t> origin, std::size_t segments,
                                std::uint64_t seed) {
  auto bank = Bank::create(model, {.capacity = 1, .seed = seed});
  if (!bank) return 0;
  const InstanceId id = bank->spawn();
  std::size_t run = 0, longest = 0, joined = 0;
  const ChainFacet& chain = *bank->chain();
  std::uint64_t before = origin[chain.place_of(id)->segment];
  while (joined < segments) {
    bank->step();
    ++run;
    const auto place = *chain.place_of(id);
    if (place.step != 0) continue;
    ++joined;
    const std::uint64_t now = origin[place.segment];
    if (now != before + 1) run = 0;
    longest = std::max(longest, run);
    before = now;
  }
  return static_cast<double>(longest) / model.rate_hz;
}

Bounded spectra_apart(const Motion& real, const Motion& synthesized, std::uint64_t seed) {
  const std::size_t rows = long_rows(real.rate_hz);
  return compared(signals_of(real, 1), signals_of(synthesized, 2), seed,
                  [rows](std::span<const Stretch> series) { return spectral_windows(series, rows, rows); });
}

namespace {

constexpr double kMaxShareOfCeiling = 0.5;  // share of the ceiling above which falls count as unlike the recorded ones

std::array<std::pair<const char*, const Bounded*>, 3> measures_of(const ChainFidelity& fidelity) {
  return {{{"over 2.5 segments", &fidelity.energy_distance},
           {"over two seconds", &fidelity.long_energy_distance},
           {"by spectra", &fidelity.spectra}}};
}

void add_falls(const std::string& which, const FallFigures& falls, const std::string& label, bool has_orientation,
               ReportSection& section) {
  const std::string id = "fidelity." + which + ".";
  add(section, id + "descent_speed", falls.descent_speed, label + "descent", "m/s");
  add(section, id + "lateral_spread", falls.lateral_spread, label + "lateral spread", "m",
      "root-mean-square distance over ground between start and end");
  add(section, id + "event_seconds", falls.event_seconds, label + "time between events", "s");
  add(section, id + "flips_per_second", falls.flips_per_second, has_orientation ? label + "flips" : "", "1/s");
}

void add_jumps(const std::string& id, const std::string& what, double share, double floor, ReportSection& section) {
  const std::string label = what.empty() ? "" : "joins that jump in " + what;
  add(section, id + ".share_above", share, label, "",
      "share above the recording's 99th percentile; 0.01 where joins are like any row");
  add(section, id + ".floor.share_above", floor, label.empty() ? "" : "  the recording's own events", "",
      "which nobody joined");
}

void add_bounded(const std::string& id, const Bounded& measure, const std::string& label, const std::string& meaning,
                 ReportSection& section) {
  add(section, id + ".value", measure.value, label, "", meaning);
  add(section, id + ".floor", measure.floor, "  floor", "", "two halves of the recorded falls");
  add(section, id + ".ceiling", measure.ceiling, "  ceiling", "", "recorded rows in random order");
}

}  // namespace

ReportSection segments_section(const ChainSummary& summary) {
  ReportSection section{"Segments"};
  const auto modes = static_cast<std::size_t>(summary.modes);
  const auto if_many = [modes](const char* label) { return modes > 1 ? label : ""; };
  const ReportList transitions = arx::matrix_of(summary.transitions, modes);
  add(section, "segments", summary.segments, "segments", "", "of the stretches that were learned from");
  add(section, "stored", summary.stored, "stored");
  add(section, "mean_segment_seconds", summary.mean_segment_seconds, "mean duration", "s");
  add(section, "stretches.learned", summary.stretches_learned, "stretches learned from");
  add(section, "stretches.held_out", summary.stretches_held_out, "stretches held out");
  add(section, "modes", summary.modes, if_many("modes"));
  add(section, "mode_sizes", ReportList(summary.mode_sizes.begin(), summary.mode_sizes.end()),
      if_many("segments of each mode"));
  add(section, "history", summary.history, if_many("history"), "modes");
  arx::add_all(section, "", "initial", summary.initial, "transitions", transitions);
  add(section, "silhouette", summary.silhouette, if_many("silhouette"), "", "-1 to 1; high where modes are tight");
  add(section, "log_likelihood", summary.log_likelihood, if_many("log-likelihood"), "nats a segment",
      "of held-out modes");
  for (std::size_t from = 0; modes > 1 && from < modes; ++from) {
    add(section, "", transitions[from], "probabilities after mode " + std::to_string(from));
  }
  return section;
}

ReportSection fidelity_section(const ChainFidelity& fidelity, bool has_orientation) {
  ReportSection section{"Fidelity: synthesized falls against recorded ones"};
  add_bounded("fidelity.energy_distance", fidelity.energy_distance, "energy distance", "0: one distribution, to 1",
              section);
  add(section, "fidelity.windows", fidelity.windows, "windows", "", "a side");
  add(section, "fidelity.window_seconds", fidelity.window_seconds, "length of a window", "s");
  add_bounded("fidelity.two_seconds", fidelity.long_energy_distance, "energy distance over 2 s",
              "of windows of two seconds", section);
  add_bounded("fidelity.spectra", fidelity.spectra, "energy distance of spectra",
              "of log powers over two seconds, but for what is below 0.3 mm and 0.2°", section);
  add_falls("real", fidelity.real, "recorded ", has_orientation, section);
  add_falls("synthesized", fidelity.synthesized, "synthesized ", has_orientation, section);
  const JoinDefect& defect = fidelity.join_defect;
  add_jumps("join_defect.position", "position", defect.position, defect.position_floor, section);
  add_jumps("join_defect.rotation", has_orientation ? "orientation" : "", defect.rotation, defect.rotation_floor,
            section);
  return section;
}

Judged judged_by(const ChainFidelity& fidelity) {
  Judged out;
  for (const auto& [name, measure] : measures_of(fidelity)) {
    // The measure is uninformative where two recorded halves are half as far apart as rows in random order, or farther.
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
    // With few windows the distance is large by chance, even between recorded falls.
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
