#pragma once
// Fidelity of a chain's falls to recorded falls. docs/explanation/fidelity.md says what is measured and why.

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

/// Shares of the rows at joins that jump, that is, deviate from the linear extrapolation of the two rows before more
/// than 99 % of the recording's rows do: 0.01 where joins are like any other row. Floors are the shares at the
/// recording's own events, where nothing was joined.
struct JoinDefect {
  double position = 0, rotation = 0;  ///< rotation: 0 without orientation
  double position_floor = 0, rotation_floor = 0;
};

/// Time series in SI units, one per piece, from its first event to its last: descent speed, horizontal speed, rate of
/// heading, for poses also tilt and spin, and the duration of the row's segment. A piece with fewer than two events has
/// no rows.
std::vector<Stretch> motion_series(const Motion& motion, std::span<const Segment> segments);

/// Adjacent windows of `rows` rows: mean, deviation, minimum and maximum of every column, with ±0.2° of noise for tilt.
/// Precondition: rows >= 2.
FeatureWindows series_windows(std::span<const Stretch> series, std::size_t rows);

struct ChainFidelityOptions {
  SegmentationOptions segmentation{};
  int smooth_rows = 0;  ///< as in motion_of()
  std::uint64_t seed = 1;
};

struct FallFigures {
  double descent_speed = 0;     ///< metres a second
  double lateral_spread = 0;    ///< root-mean-square horizontal distance between start and end of a fall, metres
  double event_seconds = 0;     ///< mean time between events
  double flips_per_second = 0;  ///< rate at which the body turns its other side up; 0 without orientation
};

/// Energy distance of the logarithms of band power of the visible signals, over windows of two seconds. Motion below
/// 0.3 mm or 0.2° is masked by noise. NaN where recordings are too short.
Bounded spectra_apart(const Motion& real, const Motion& synthesized, std::uint64_t seed);

struct ChainFidelity {
  FallFigures real;
  FallFigures synthesized;
  Bounded energy_distance;       ///< over windows of 2.5 recorded segments of mean duration
  Bounded long_energy_distance;  ///< over windows of two seconds; NaN where recordings are shorter
  Bounded spectra;               ///< result of spectra_apart()
  JoinDefect join_defect;
  std::size_t windows = 0;  ///< number of recorded windows compared in energy_distance
  double window_seconds = 0;
};

/// Falls made by a model, as recordings at its rate; for a chain also each fall's rows of joins and every row's mode.
struct MadeFalls {
  std::vector<Recording> falls;
  std::vector<std::vector<std::size_t>> joins;
  std::vector<std::vector<int>> modes;
};

/// Makes falls of so many rows each. Errors: as Bank::create().
Result<MadeFalls> made_falls(const Model& model, std::span<const std::size_t> rows, std::uint64_t seed);

/// Compares falls that the model makes with recorded ones (to be unseen in training). Distances are NaN where a side
/// has under two windows. Errors: as motion_of() and segment(); a view other than pose or position; rates that differ.
Result<ChainFidelity> chain_fidelity(const Model& model, std::span<const Recording> real,
                                     const ChainFidelityOptions& options);

/// Seconds of the longest recorded stretch that a played fall of `segments` segments repeats segment by segment; the
/// stretch's last segment is not counted. `origin` as in ChainFit.
double longest_verbatim_seconds(const Model& model, std::span<const std::uint64_t> origin, std::size_t segments,
                                std::uint64_t seed);

ReportSection segments_section(const ChainSummary& summary);

/// Section with the figures `fidelity.*` and `join_defect.*`. Without orientation the figures that need it have no
/// label, so that only programs see them.
ReportSection fidelity_section(const ChainFidelity& fidelity, bool has_orientation);

/// Copies the figures that a model stores to its training record.
void add_figures(const ChainFidelity& fidelity, Training& training);

/// Names of measures: `judged`, for which the recorded falls suffice; `unjudged`, for which they are too few or short.
struct Judged {
  std::string judged;
  std::string unjudged;
};

Judged judged_by(const ChainFidelity& fidelity);

/// Returns why played falls are unlike recorded ones: they have no events, or a measure is above its floor and above
/// half of its ceiling. Empty if neither is the case.
std::optional<std::string> fault_of(const ChainFidelity& fidelity);

}  // namespace wisp::chain
