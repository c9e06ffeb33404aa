// Validation of a chain on unseen recordings: falls, or gusts in a windy recording and its calm counterpart.
#include <algorithm>
#include <limits>
#include <span>
#include <string>

#include "learn/chain/chain_fidelity.hpp"
#include "learn/chain/gusts/gust_play.hpp"
#include "learn/chain/learn_chain.hpp"
#include "record/number_text.hpp"
#include "wisp/base/report.hpp"

namespace wisp {
namespace chain {
namespace {

// ---- Plotted tracks of recorded and synthesized falls ----

constexpr std::size_t kFalls = 12;    // maximum number plotted on each side: more would hide each other
constexpr double kShownSeconds = 6;   // maximum duration of a plotted fall
constexpr double kMarkedSeconds = 3;  // maximum duration of the fall with marked events

// Number of rows of a piece to plot: `seconds` of it, but at least the 8 rows that motion_of() needs.
std::size_t rows_of(const MotionPiece& piece, double seconds, double rate_hz) {
  return std::min(piece.rows(), std::max<std::size_t>(8, static_cast<std::size_t>(seconds * rate_hz)));
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

// Returns the track of a fall in those plotted rows that belong to one mode, with breaks between.
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

Result<ReportSection> fall_tracks(const Model& model, std::span<const Recording> real,
                                  const ChainFidelityOptions& options) {
  const auto seen = motion_of(real, options.smooth_rows);
  if (!seen) return seen.error();
  const auto cut = segment(*seen, real, options.segmentation);
  if (!cut) return cut.error();
  const std::size_t rows = rows_of(seen->pieces.front(), kShownSeconds, seen->rate_hz);
  const auto played = made_falls(model, std::vector<std::size_t>(kFalls, rows), options.seed);
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

// Segmentation options and seed for judging, from the model's training record.
Result<ChainFidelityOptions> judging_of(const Model& model, std::uint64_t seed) {
  if (!model.training.motion) return Error{model.name + ": does not say how its motion was cut; learn it again"};
  const MotionTraining& motion = *model.training.motion;
  auto event = parse_event(motion.event);
  if (!event) return event.error();
  return ChainFidelityOptions{.segmentation = {std::move(*event), motion.min_seconds, motion.debounce},
                              .smooth_rows = motion.smooth_rows,
                              .seed = seed};
}

ReportSection counts_of(std::size_t rows) {
  return {"", {{"rows", rows, "rows", ""}, {"channels", ReportList{}, "", ""}}};
}

ReportVerdict likeness_of(const Judged& by) {
  if (by.judged.empty()) {
    return {false, "the recorded falls are too few or too short to judge by: record more, of two seconds or longer"};
  }
  if (by.unjudged.empty()) return {true, "its falls are like the recorded ones"};
  return {true, "its falls are like the recorded ones " + by.judged + "; these are too few or too short to judge " +
                    by.unjudged};
}

Result<Report> validate_falls(const Model& model, std::span<const Recording> falls, std::uint64_t seed,
                              const Progress& progress) {
  const auto options = judging_of(model, seed);
  if (!options) return options.error();
  const auto fidelity = chain_fidelity(model, falls, *options);
  if (!fidelity) return fidelity.error();
  if (!go_on(progress, "playing falls", 0.5)) return Error{std::string(kStopped)};
  auto tracks = fall_tracks(model, falls, *options);
  if (!tracks) return tracks.error();
  Report report;
  if (fidelity->windows == 0) {
    report.warnings.push_back(falls.front().source + ": its stretches are shorter than " +
                              number_text(fidelity->window_seconds, 3) +
                              " s, expected longer ones: how like the falls are was not measured");
  }
  const auto fault = fault_of(*fidelity);
  report.verdict = fault ? ReportVerdict{false, *fault} : likeness_of(judged_by(*fidelity));
  std::size_t rows = 0;
  for (const Recording& fall : falls) rows += fall.rows();
  report.sections = {counts_of(rows), fidelity_section(*fidelity, std::holds_alternative<PoseView>(model.view)),
                     std::move(*tracks)};
  return report;
}

Result<Report> validate_gusts(const Model& model, const Recording& windy, const Recording& calm, std::uint64_t seed) {
  const auto pairs = gust_pairs(windy, calm);
  if (!pairs) return pairs.error();
  const auto play = play_gusts(model, *pairs, 0, seed);
  if (!play) return play.error();
  Report report;
  report.sections = {counts_of(windy.rows()), gusts_section(play->figures)};
  report.sections.front().entries.push_back({"fidelity", {}, "", ""});  // clones of gusts are not independent falls
  for (std::size_t k = 0; k < play->scenes.size(); ++k) report.sections.push_back(scene_section(play->scenes[k], k));
  return report;
}

}  // namespace
}  // namespace chain

Result<Report> validate_chain(const Model& model, std::span<const Recording> recordings, std::uint64_t seed,
                              const Progress& progress) {
  if (recordings.empty()) return Error{"there are no recordings to judge a chain on"};
  if (!std::holds_alternative<ChainModel>(model.dynamics)) return Error{model.name + ": is not a segment chain"};
  if (!go_on(progress, "judging falls", 0)) return Error{std::string(kStopped)};
  const auto unpaired = std::find_if(recordings.begin(), recordings.end(),
                                     [](const Recording& one) { return !find_attribute(one, "pair"); });
  if (unpaired != recordings.end() && std::any_of(recordings.begin(), recordings.end(), [](const Recording& one) {
        return find_attribute(one, "pair").has_value();
      })) {
    return Error{unpaired->source + ": is not one of a pair (it has no attribute pair), expected no pair beside it"};
  }
  const auto data = chain::sorted_recordings(recordings);
  if (!data) return data.error();
  if (data->paired.empty()) return chain::validate_falls(model, data->falls, seed, progress);
  return chain::validate_gusts(model, data->paired[0], data->paired[1], seed);
}

}  // namespace wisp
