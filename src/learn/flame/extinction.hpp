#pragma once
// Learning when a flame goes out (wisp/model/extinction.hpp) from recordings in which it did.
//
// Survivals bound the rule from below, deaths from above, and the moment at which a flame vanished says how fast. All
// rules of a grid are tried on the whole recordings; the one that errs least is taken, and how far others that err as
// little lie apart says how sure that is. Where few deaths leave it open, the least remarkable rule is taken: the level
// midway between what was survived and what killed, haste and recovery near the defaults.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "learn/flame/blow_outs.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/extinction.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// A recording, what blew in it, and where the flame went out.
struct ExtinctionEvidence {
  const Recording* recording = nullptr;
  std::string input;               ///< the channel that blows
  double scale = 1;                ///< its value that is 1 in the model, > 0
  std::vector<BlowOut> blow_outs;  ///< of find_blow_outs()
  double decay = 0;                ///< seconds that a flame takes to vanish: that long before it was gone it went out
};

/// How a rule does on recordings. A gust is wind of at least half of what killed, with calmer wind around it; without
/// deaths, of at least half of the strongest.
struct ExtinctionAgreement {
  std::size_t deaths = 0;            ///< that the recordings have
  std::size_t died = 0;              ///< of them, where the rule has the flame die within half a second as well
  std::size_t gusts = 0;             ///< that the flame lived through
  std::size_t spared = 0;            ///< of them, where it lives by the rule
  std::vector<double> late_seconds;  ///< of each that died: by how much after it was gone from the recording
  double strongest_survived = 0;     ///< wind averaged over 0.15 s, in the model's units; 0: no gust

  /// Median of |late_seconds|; 0 where none died.
  double median_off() const;
};

/// Follows a rule through recordings, from each lighting on.
///
/// Precondition: rates are positive, and `evidence` has what find_blow_outs() found in its recordings.
ExtinctionAgreement agreement(const Extinction& rule, std::span<const ExtinctionEvidence> evidence);

/// A learned rule and how sure it is.
struct ExtinctionFit {
  Extinction rule;                        ///< level in the model's units
  std::array<double, 2> level_range{};    ///< of all rules that do as well
  std::array<double, 2> seconds_range{};  ///< likewise
  ExtinctionAgreement agreement;          ///< of the rule with what it was learned from
};

/// Learns a rule from recordings with at least one death.
/// Errors: no death in any of them, or no rule that reproduces more than half of the deaths.
Result<ExtinctionFit> learn_extinction(std::span<const ExtinctionEvidence> evidence);

/// The rule for a flame of which no death was recorded: the default, its level raised until all that was survived is
/// survived by it, with a quarter to spare.
Extinction extinction_beyond(std::span<const ExtinctionEvidence> evidence);

}  // namespace wisp
