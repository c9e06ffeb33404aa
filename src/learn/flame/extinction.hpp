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

/// A recording, its wind, and where the flame went out.
struct ExtinctionEvidence {
  const Recording* recording = nullptr;
  std::string input;               ///< the channel of the wind
  double scale = 1;                ///< the channel's value that is 1 in the model, > 0
  std::vector<BlowOut> blow_outs;  ///< of find_blow_outs()
  double vanishing = 0;            ///< seconds for which a flame that has gone out is still seen
};

/// The agreement of a rule with recordings. A gust is wind of at least half of the strength that killed, between calmer
/// winds; in recordings without deaths, of at least half of the strongest.
struct ExtinctionAgreement {
  std::size_t deaths = 0;            ///< number of deaths in the recordings
  std::size_t died = 0;              ///< deaths that the rule reproduces within half a second
  std::size_t gusts = 0;             ///< number of gusts that the flame survived
  std::size_t spared = 0;            ///< gusts that it survives under the rule
  std::vector<double> late_seconds;  ///< for each reproduced death: how long after the recorded one
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
  std::array<double, 2> level_range{};    ///< over all rules that are as good
  std::array<double, 2> seconds_range{};  ///< likewise
  ExtinctionAgreement agreement;          ///< with the recordings that it was learned from
};

/// Learns a rule from recordings with at least one death.
/// Errors: no death in any of them, or no rule that reproduces more than half of the deaths.
Result<ExtinctionFit> learn_extinction(std::span<const ExtinctionEvidence> evidence);

/// The rule for a flame that was never seen to go out: the default with its level raised until every recorded gust is
/// survived with a quarter to spare.
Extinction extinction_beyond(std::span<const ExtinctionEvidence> evidence);

}  // namespace wisp
