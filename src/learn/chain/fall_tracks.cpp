#include "learn/chain/fall_tracks.hpp"

#include <algorithm>
#include <limits>
#include <string>

namespace wisp::chain {
namespace {

constexpr std::size_t kFalls = 12;    // a side: more would hide each other
constexpr double kShownSeconds = 6;   // of a fall
constexpr double kMarkedSeconds = 3;  // of one with its events: later ones could not be distinguished

std::size_t rows_of(const MotionPiece& piece, double seconds, double rate_hz) {
  return std::min(piece.rows(), static_cast<std::size_t>(seconds * rate_hz));
}

void add_point(const MotionPiece& piece, const Triple& at, std::size_t axis, ReportSeries& out) {
  out.x.push_back(at[0] - piece.position.front()[0]);
  out.y.push_back(at[axis] - piece.position.front()[axis]);
}

ReportSeries track_of(const std::string& id, const MotionPiece& piece, std::size_t axis, std::size_t rows) {
  ReportSeries track{id, "", "x, m", axis == 1 ? "y, m" : "height, m", {}, {}};
  for (std::size_t row = 0; row < rows; ++row) add_point(piece, piece.position[row], axis, track);
  return track;
}

void add_tracks(const Motion& motion, const std::string& side, ReportSection& section) {
  for (std::size_t k = 0; k < std::min(kFalls, motion.pieces.size()); ++k) {
    const MotionPiece& piece = motion.pieces[k];
    const std::size_t rows = rows_of(piece, kShownSeconds, motion.rate_hz);
    section.series.push_back(track_of("falls-side." + side, piece, 2, rows));
    section.series.push_back(track_of("falls-above." + side, piece, 1, rows));
  }
}

ReportSeries events_of(const std::string& side, const MotionPiece& piece, const std::vector<double>& rows) {
  ReportSeries events{
      "segments." + side + ".events", side == "recorded" ? "event" : "join", "x, m", "height, m", {}, {}};
  for (double row : rows) add_point(piece, at_row(piece.position, row), 2, events);
  return events;
}

void add_marked(const Motion& motion, const Segmentation& cut, ReportSection& section) {
  const MotionPiece& piece = motion.pieces.front();
  const std::size_t rows = rows_of(piece, kMarkedSeconds, motion.rate_hz);
  std::vector<double> events;
  for (const Segment& one : cut.segments) {
    if (one.piece == 0 && one.begin < static_cast<double>(rows) - 1) events.push_back(one.begin);
  }
  section.series.push_back(track_of("segments.recorded.track", piece, 2, rows));
  section.series.push_back(events_of("recorded", piece, events));
}

// The parts of a fall's first rows that are of one mode.
ReportSeries mode_track(const MotionPiece& piece, std::span<const int> modes, int mode) {
  const std::string number = std::to_string(mode);
  ReportSeries track{"segments.synthesized.mode_" + number, "mode " + number, "x, m", "height, m", {}, {}};
  for (std::size_t row = 0; row + 1 < modes.size(); ++row) {
    if (modes[row] != mode) continue;
    add_point(piece, piece.position[row], 2, track);
    if (modes[row + 1] == mode) continue;
    add_point(piece, piece.position[row + 1], 2, track);
    track.x.push_back(track.x.back());  // a y that is not finite breaks the line
    track.y.push_back(std::numeric_limits<double>::quiet_NaN());
  }
  return track;
}

}  // namespace

Result<ReportSection> fall_tracks(const Model& model, std::span<const Recording> real,
                                  const ChainFidelityOptions& options) {
  const auto seen = motion_of(real, options.smooth_rows);
  if (!seen) return seen.error();
  const auto cut = segment(*seen, real, options.segmentation);
  if (!cut) return cut.error();
  const MotionPiece& first = seen->pieces.front();
  const auto played =
      made_falls(model, static_cast<int>(kFalls), rows_of(first, kShownSeconds, seen->rate_hz), options.seed);
  if (!played) return played.error();
  const auto made = motion_of(played->falls, options.smooth_rows);
  if (!made) return made.error();
  ReportSection section;
  add_tracks(*seen, "recorded", section);
  add_tracks(*made, "synthesized", section);
  add_marked(*seen, *cut, section);
  const MotionPiece& walk = made->pieces.front();
  const std::span modes = std::span(played->modes.front()).first(rows_of(walk, kMarkedSeconds, made->rate_hz));
  for (int mode = 0; mode < std::get<ChainModel>(model.dynamics).modes; ++mode) {
    section.series.push_back(mode_track(walk, modes, mode));
  }
  std::vector<double> joins = {0};
  for (std::size_t row : played->joins.front()) {
    if (row < modes.size()) joins.push_back(static_cast<double>(row));
  }
  section.series.push_back(events_of("synthesized", walk, joins));
  return section;
}

}  // namespace wisp::chain
