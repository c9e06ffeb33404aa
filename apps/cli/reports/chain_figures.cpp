#include "reports/chain_figures.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "reports/clip_figures.hpp"
#include "wisp/draw/plot.hpp"
#include "wisp/learn/motion.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"

namespace wisp::cli {
namespace {

constexpr std::size_t kFalls = 12;    // a side: more would hide each other
constexpr double kShownSeconds = 6;   // of a side view
constexpr double kMarkedSeconds = 3;  // of a fall with its events: later ones could not be told apart
constexpr Colour kModeColours[] = {{31, 119, 180}, {214, 96, 20},  {44, 140, 44},   {190, 40, 40},
                                   {130, 90, 180}, {120, 80, 60},  {210, 100, 170}, {90, 90, 90},
                                   {150, 150, 20}, {20, 160, 170}, {0, 0, 0},       {240, 170, 60}};

std::size_t rows_of(const MotionPiece& piece, double seconds, double rate_hz) {
  return std::min(piece.rows(), static_cast<std::size_t>(seconds * rate_hz));
}

double along(const Triple& at, const Triple& from, bool above, int axis) {
  return at[static_cast<std::size_t>(axis == 0 ? 0
                                     : above   ? 1
                                               : 2)] -
         from[static_cast<std::size_t>(axis == 0 ? 0
                                       : above   ? 1
                                                 : 2)];
}

PlotSeries track_of(const MotionPiece& piece, bool above, std::size_t rows) {
  PlotSeries track{.width = 1.0};
  for (std::size_t row = 0; row < rows; ++row) {
    track.x.push_back(along(piece.position[row], piece.position.front(), above, 0));
    track.y.push_back(along(piece.position[row], piece.position.front(), above, 1));
  }
  return track;
}

Plot tracks(const Motion& motion, const std::string& title, bool above) {
  Plot plot{.title = title, .x = {.label = "x, m"}, .y = {.label = above ? "y, m" : "height, m"}, .equal_units = true};
  for (std::size_t k = 0; k < std::min(kFalls, motion.pieces.size()); ++k) {
    const MotionPiece& piece = motion.pieces[k];
    plot.series.push_back(track_of(piece, above, rows_of(piece, kShownSeconds, motion.rate_hz)));
  }
  return plot;
}

PlotSheet side_by_side(const Motion& real, const Motion& made, bool above) {
  Plot a = tracks(real, "recorded", above), b = tracks(made, "synthesized", above);
  share_axes(a, b);
  return {.title = above ? "Falls seen from above" : "Falls seen from the side", .plots = {std::move(a), std::move(b)}};
}

// One fall of the model, and the mode of every row.
struct Walk {
  Recording fall;
  std::vector<std::uint16_t> mode;
  std::vector<std::size_t> joins;
};

Result<Walk> walk_of(const Model& model, std::size_t rows, std::uint64_t seed) {
  auto bank = Bank::create(model, {.capacity = 1, .seed = seed});
  if (!bank) return bank.error();
  const InstanceId id = bank->spawn();
  Walk walk;
  walk.fall.source = "synthesized";
  walk.fall.rate_hz = model.rate_hz;
  for (const Output& output : model.outputs)
    walk.fall.channels.push_back({output.name, output.unit, Role::kOutput, {}});
  std::vector<float> values(model.outputs.size());
  for (std::size_t row = 0; row < rows; ++row) {
    if (row > 0) bank->step();
    bank->outputs(id, values);
    for (std::size_t k = 0; k < values.size(); ++k) walk.fall.channels[k].samples.push_back(values[k]);
    const ChainPlace place = *bank->chain()->place_of(id);
    walk.mode.push_back(static_cast<std::uint16_t>(place.mode));
    if (place.step == 0) walk.joins.push_back(row);
  }
  return walk;
}

PlotSeries marks_of(const MotionPiece& piece, const std::vector<double>& events, const std::string& label) {
  PlotSeries marks{.label = label, .shape = SeriesShape::kPoints, .colour = Colour{0, 0, 0}, .marker = Marker::kRing};
  for (double event : events) {
    const Triple at = at_row(piece.position, event);
    marks.x.push_back(along(at, piece.position.front(), false, 0));
    marks.y.push_back(along(at, piece.position.front(), false, 1));
  }
  return marks;
}

Plot marked_real(const Motion& motion, const Segmentation& cut) {
  const MotionPiece& piece = motion.pieces.front();
  const std::size_t rows = rows_of(piece, kMarkedSeconds, motion.rate_hz);
  std::vector<double> events;
  for (const Segment& one : cut.segments) {
    if (one.piece == 0 && one.begin < static_cast<double>(rows - 1)) events.push_back(one.begin);
  }
  Plot plot{.title = "recorded", .x = {.label = "x, m"}, .y = {.label = "height, m"}, .equal_units = true};
  plot.series = {track_of(piece, false, rows), marks_of(piece, events, "event")};
  return plot;
}

Plot marked_made(const Motion& motion, const Walk& walk, int modes) {
  const MotionPiece& piece = motion.pieces.front();
  const std::size_t rows = piece.rows();
  Plot plot{.title = "synthesized, by mode", .x = {.label = "x, m"}, .y = {.label = "height, m"}, .equal_units = true};
  PlotSeries track = track_of(piece, false, rows);
  track.width = 2;
  for (std::size_t row = 0; row + 1 < rows; ++row) {
    track.colours.push_back(kModeColours[walk.mode[row] % std::size(kModeColours)]);
  }
  plot.series.push_back(std::move(track));
  const std::vector<double> events(walk.joins.begin(), walk.joins.end());
  plot.series.push_back(marks_of(piece, events, "join"));
  for (int mode = 0; mode < std::min(modes, static_cast<int>(std::size(kModeColours))); ++mode) {
    plot.series.push_back({.label = "mode " + std::to_string(mode),
                           .x = {0},
                           .y = {std::nan("")},
                           .colour = kModeColours[static_cast<std::size_t>(mode)]});
  }
  return plot;
}

}  // namespace

Result<void> write_chain_figures(const std::filesystem::path& folder, const Model& model,
                                 const std::vector<Recording>& real, const ChainFidelityOptions& options) {
  const auto seen = motion_of(real, options.smooth_rows);
  if (!seen) return seen.error();
  const auto cut = segment(*seen, real, options.segmentation);
  if (!cut) return cut.error();
  const auto falls = synthesize_falls(model, static_cast<int>(kFalls),
                                      rows_of(seen->pieces.front(), kShownSeconds, seen->rate_hz), options.seed);
  if (!falls) return falls.error();
  const auto made = motion_of(*falls, options.smooth_rows);
  if (!made) return made.error();
  const auto walk = walk_of(model, rows_of(seen->pieces.front(), kMarkedSeconds, seen->rate_hz), options.seed);
  if (!walk) return walk.error();
  const auto walked = motion_of(std::span(&walk->fall, 1), options.smooth_rows);
  if (!walked) return walked.error();

  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) return Error{folder.string() + ": cannot be made: " + code.message()};
  if (auto ok = write_figure(folder, "falls-side", side_by_side(*seen, *made, false)); !ok) return ok;
  if (auto ok = write_figure(folder, "falls-above", side_by_side(*seen, *made, true)); !ok) return ok;
  Plot a = marked_real(*seen, *cut);
  Plot b = marked_made(*walked, *walk, std::get<ChainModel>(model.dynamics).modes);
  share_axes(a, b);
  return write_figure(folder, "segments",
                      {.title = "One fall, cut at its events", .plots = {std::move(a), std::move(b)}});
}

}  // namespace wisp::cli
