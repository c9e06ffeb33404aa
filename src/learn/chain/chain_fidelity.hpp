#pragma once
// How like the recorded falls are those that a chain makes? docs/explanation/fidelity.md says what is measured and why.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "learn/chain/chain_fit.hpp"
#include "learn/chain/motion/motion.hpp"
#include "learn/chain/motion/segmentation.hpp"
#include "learn/fidelity/fidelity.hpp"
#include "learn/fidelity/fidelity_distance.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::chain {

/// Shares of rows at joins that jump: that lie farther from where the two rows before them would lead than 99 % of the
/// recording's rows do. 0.01 where joins are like any row. Floors are of the recording's own events, which nobody
/// joined.
struct JoinDefect {
  double position = 0, rotation = 0;  ///< without orientation no rotation jumps
  double position_floor = 0, rotation_floor = 0;
};

/// Descent speed, horizontal speed, heading change and segment length, and for poses tilt and spin: one row a row of
/// each piece, from its first event to its last.
/// A piece without two events has no rows.
std::vector<Stretch> motion_series(const Motion& motion, std::span<const Segment> segments);

/// Windows of `rows` rows, end to end; the features are mean, standard deviation, least and most of every column. A
/// block is a piece.
///
/// Precondition: rows >= 2.
FeatureWindows series_windows(std::span<const Stretch> series, std::size_t rows);

struct ChainFidelityOptions {
  SegmentationOptions segmentation{};
  int smooth_rows = 0;  ///< as motion_of()
  std::uint64_t seed = 1;
};

/// What is told of a set of falls in a word each.
struct FallFigures {
  double descent_speed = 0;     ///< metres a second
  double lateral_spread = 0;    ///< metres: root-mean-square distance over ground between start and end of a fall
  double event_seconds = 0;     ///< mean time between events
  double flips_per_second = 0;  ///< how often another side of the body comes to lie up; 0 without orientation
};

/// Energy distance of the logarithms of the power in bands of what an eye follows, over windows of two seconds; below
/// 0.3 mm and 0.2° nothing counts. NaN where recordings are too short for it.
Bounded spectra_apart(const Motion& real, const Motion& synthesized, std::uint64_t seed);

struct ChainFidelity {
  FallFigures real;
  FallFigures synthesized;
  Bounded energy_distance;
  Bounded long_energy_distance;  ///< over windows of two seconds; NaN where recordings are shorter
  Bounded spectra;               ///< spectra_apart()
  JoinDefect join_defect;
  std::size_t windows = 0;  ///< a side
  double window_seconds = 0;
};

/// Falls made by a model, as recordings of its rate, and of a chain the rows of each at which a segment was joined, and
/// the mode of every row.
struct MadeFalls {
  std::vector<Recording> falls;
  std::vector<std::vector<std::size_t>> joins;
  std::vector<std::vector<int>> modes;
};

/// As many as requested, each of `rows` rows. Errors: as Bank::create().
Result<MadeFalls> made_falls(const Model& model, int falls, std::size_t rows, std::uint64_t seed);

/// Compares falls that the model makes with recorded ones, which it should not have seen.
/// Errors: as motion_of() and segment(); the model's view is not a pose or a position; rates that differ; too little
/// for two windows a side.
Result<ChainFidelity> chain_fidelity(const Model& model, std::span<const Recording> real,
                                     const ChainFidelityOptions& options);

/// The longest stretch in seconds over which a model's falls follow one recorded stretch segment by segment. `origin`
/// as ChainFit's.
double longest_verbatim_seconds(const Model& model, std::span<const std::uint64_t> origin, std::size_t segments,
                                std::uint64_t seed);

ReportSection segments_section(const ChainSummary& summary);

/// `fidelity` and `join_defect`; without orientation what needs one is for programs only.
ReportSection fidelity_section(const ChainFidelity& fidelity, bool has_orientation);

/// The figures that a model keeps.
void add_figures(const ChainFidelity& fidelity, Training& training);

/// Measures by name, and those of which the recorded falls are too few or too short to say anything.
struct Judged {
  std::string judged;
  std::string unjudged;
};

Judged judged_by(const ChainFidelity& fidelity);

/// Why falls are not like the recorded ones: a measure near its ceiling, or past it. Nothing: they are.
std::optional<std::string> fault_of(const ChainFidelity& fidelity);

}  // namespace wisp::chain
