#pragma once
// Recordings in which a flame may have been put out: its burning and its rule of extinction are learned from them.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learn/flame/extinction.hpp"
#include "learn/flame/extinction_learning.hpp"
#include "learn/flame/flame_sizes.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/outline_recipe.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// A model's rule of extinction, and what the recordings say of it.
struct LearnedExtinction {
  std::string input;  ///< the channel whose wind puts it out
  Origin origin = Origin::kDefault;
  std::optional<ExtinctionFit> fit;  ///< where the rule was learned
  ExtinctionAgreement agreement;     ///< of the rule with the recordings
  std::size_t unexplained = 0;       ///< stretches without an outline that no wind explains
  std::optional<std::string> warning;
};

/// Recordings of an outline whose first input may have put it out.
class ExtinguishedRecordings {
 public:
  /// Finds the extinctions, and leaves them out of what burning is learned from. Without an input, or with a recipe
  /// without extinction, nothing is found and the recordings stay as they are.
  /// Errors: as find_blow_outs(); a given rule out of range.
  static Result<ExtinguishedRecordings> find(std::vector<Recording> recordings, const ExtinctionRecipe& recipe);

  /// What the outline is learned from.
  const std::vector<Recording>& burning() const { return burning_; }

  /// Gives a model that was learned from burning() its rule of extinction, durations and training included. `scale` is
  /// the input's value that is 1 in the model. Nothing where the recipe has no extinction or the model no input.
  /// Errors: a given rule without an input; as flame_sizes().
  Result<std::optional<LearnedExtinction>> complete(Model& model, const ExtinctionRecipe& recipe) const;

 private:
  std::vector<ExtinctionEvidence> evidence(double scale, double vanishing) const;

  std::string input_;  // empty: there is none
  std::vector<Recording> recordings_;
  std::vector<Recording> burning_;
  std::vector<std::vector<BlowOut>> found_;
};

/// The agreement of a model's rule with a recording that it was not learned from.
struct JudgedExtinction {
  ExtinctionAgreement agreement;
  std::size_t unexplained = 0;
};

/// Nothing where the model has no rule. With `own_scale` an input of 1 is the 95th percentile of this recording's
/// while the flame burns.
/// Errors: as find_blow_outs(), and as scaled_input().
Result<std::optional<JudgedExtinction>> judge_extinction(const Model& model, const Recording& recording,
                                                         bool own_scale);

/// The recording without extinctions, as the model was learned from; the whole of it where the model has no rule.
/// Errors: as find_blow_outs().
Result<Recording> burning_part(const Model& model, const Recording& recording);

/// `extinction` {input, level, seconds, haste, recovery, modes […]} as model_report() has it; none where nothing puts
/// the model out.
ReportSection extinction_section(const Model& model);

/// extinction_section() of a model that was just learned, with `source`, `agreement` {…}, `unexplained`, `level_range`
/// and `seconds_range`.
ReportSection extinction_section(const Model& model, const std::optional<LearnedExtinction>& learned);

/// `extinction` {deaths, died, gusts, spared, …}; none where the model has no rule.
ReportSection extinction_section(const std::optional<JudgedExtinction>& judged);

}  // namespace wisp
