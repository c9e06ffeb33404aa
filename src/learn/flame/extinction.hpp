#pragma once
// Learns the extinction rule of a flame (wisp/model/extinction.hpp) from recorded extinctions, and keeps recorded time
// courses of its size and shape for playback: decay when it is blown out, and re-ignition (flame_sizes.cpp).
//
// Survived gusts bound the rule from below, extinctions from above, and the time of extinction determines its speed.
// All rules of a grid are tried on the whole recordings, and the one with the least error is chosen. The spread of
// rules with similar error is the uncertainty. A weak prior prefers a level midway between the wind survived and the
// wind that extinguished, and haste and recovery near the defaults.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "learn/flame/blow_outs.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/extinction.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// A recording, its wind, and where the flame went out.
struct ExtinctionEvidence {
  const Recording* recording = nullptr;
  std::string input;               ///< name of the wind channel
  double scale = 1;                ///< value of that channel that equals 1 in the model, > 0
  std::vector<BlowOut> blow_outs;  ///< result of find_blow_outs()
  double vanishing = 0;            ///< seconds for which an extinguished flame remains visible
  double pixels_per_unit = 0;      ///< as in OutlineRecipe
};

/// Agreement of a rule with recordings. A gust is a run of rows with at least half of the weakest wind that
/// extinguished a flame or, in recordings without extinctions, half of the strongest wind.
struct ExtinctionAgreement {
  std::size_t deaths = 0;            ///< number of recorded extinctions
  std::size_t died = 0;              ///< number of extinctions that the rule reproduces within half a second
  std::size_t gusts = 0;             ///< number of gusts that the flame survived
  std::size_t spared = 0;            ///< number of those gusts that the flame survives under the rule
  std::vector<double> late_seconds;  ///< for each reproduced extinction: delay against the recorded one
  double strongest_survived = 0;     ///< wind averaged over 0.15 s, in the model's units; 0 without gusts

  /// Median of |late_seconds|; 0 where no extinction was reproduced.
  double median_off() const;
};

/// Simulates a rule over recordings, restarting at each ignition. Precondition: rates are positive, and `evidence` has
/// the result of find_blow_outs() for its recordings.
ExtinctionAgreement agreement(const Extinction& rule, std::span<const ExtinctionEvidence> evidence);

struct ExtinctionFit {
  Extinction rule;                      ///< level in the model's units
  std::array<double, 2> level_range{};  ///< range of levels over all equally good rules
  ExtinctionAgreement agreement;        ///< agreement of the rule with the training recordings
};

/// Learns a rule from recordings. Errors: no extinction, or no rule that reproduces more than half of the extinctions.
Result<ExtinctionFit> learn_extinction(std::span<const ExtinctionEvidence> evidence);

/// Returns the default rule, for a flame that was never extinguished. Where a recorded gust would extinguish the flame,
/// the level is raised until the flame survives all gusts, and then by another quarter.
Extinction extinction_beyond(std::span<const ExtinctionEvidence> evidence);

/// Size of the flame in every row, NaN without an outline: the square root of the control polygon's area, divided by
/// its median while the flame burns. All NaN where the flame never burns undisturbed.
/// Errors: not a recording of an outline.
Result<std::vector<double>> flame_sizes(const Recording& recording, std::span<const BlowOut> blow_outs);

/// Recorded events, at most eight of a kind, equally spaced; empty where none was seen.
struct RecordedEvents {
  FlameEvents dying;             ///< from the beginning of decay, relative to the size before; then 0.05 s of glow
                                 ///< without an outline
  FlameEvents catching;          ///< from the flame's return on, 0.25 to 0.75 s
  double vanishing_seconds = 0;  ///< median duration of visible decay
};

/// Extracts the events around the blow-outs. All recordings must have one rate. If the view has a shape, outlines of
/// re-ignition are stored as its components. Errors: as flame_sizes().
Result<RecordedEvents> recorded_events(std::span<const ExtinctionEvidence> evidence, const OutlineView& view = {});

/// Extends the ranges of a shape to include the events: a flame is wider during re-ignition than when it burns.
void make_room(const FlameEvents& events, ShapeComponents& shape);

}  // namespace wisp
