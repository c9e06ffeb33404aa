#pragma once
// Learns the burning of a flame and its extinction rule from recordings that may contain extinctions.

#include <optional>
#include <string>
#include <vector>

#include "learn/flame/extinction.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/outline_recipe.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// A model's extinction rule, and its evidence in the recordings.
struct LearnedExtinction {
  Origin origin = Origin::kDefault;
  std::optional<ExtinctionFit> fit;  ///< set where the rule was learned
  ExtinctionAgreement agreement;     ///< agreement of the rule with the recordings
  std::size_t unexplained = 0;       ///< number of absences of the outline without wind
  std::optional<std::string> warning;
};

/// Recordings of an outline that the recipe's first input, or else the recording's, may have extinguished.
class ExtinguishedRecordings {
 public:
  /// Finds extinctions and removes them from the recordings that burning is learned from. Without an input, or with a
  /// recipe without extinction, recordings stay unchanged. Errors: as find_blow_outs(); a given rule out of range.
  static Result<ExtinguishedRecordings> find(std::vector<Recording> recordings, const OutlineRecipe& recipe);

  /// Recordings to learn the outline's dynamics from.
  const std::vector<Recording>& burning() const { return burning_; }

  /// Adds the extinction rule, its recorded events and its training record to a model learned from burning(). Returns
  /// nothing if the recipe has no extinction or the model lacks the input.
  /// Errors: a given rule without an input; as flame_sizes().
  Result<std::optional<LearnedExtinction>> complete(Model& model, const ExtinctionRecipe& recipe) const;

 private:
  std::vector<ExtinctionEvidence> evidence(double scale, double vanishing) const;

  std::string input_;           // empty: no input
  double pixels_per_unit_ = 0;  // as in OutlineRecipe
  std::vector<Recording> recordings_;
  std::vector<Recording> burning_;
  std::vector<std::vector<BlowOut>> found_;
};

/// Agreement of a model's rule with an unseen recording.
struct JudgedExtinction {
  ExtinctionAgreement agreement;
  std::size_t unexplained = 0;
};

/// Judges a model's rule; returns nothing if it has none. With `own_scale` an input of 1 is the 95th percentile of this
/// recording's input while the flame burns, if there is any wind. Errors: as find_blow_outs(), trained_scale().
Result<std::optional<JudgedExtinction>> judge_extinction(const Model& model, const Recording& recording,
                                                         bool own_scale);

/// The recording without extinctions, as in training; unchanged if the model has no rule. Errors: as find_blow_outs().
Result<Recording> burning_part(const Model& model, const Recording& recording);

const char* word_of(Origin origin);

/// Section `extinction` {input, level, seconds, haste, recovery, modes […]} as in model_report(); empty without a rule.
ReportSection extinction_section(const Model& model);

/// extinction_section() of a freshly learned model, with `source`, `agreement` {…}, `unexplained`, `level_range`.
ReportSection extinction_section(const Model& model, const std::optional<LearnedExtinction>& learned);

/// Section `extinction` {deaths, died, gusts, spared, …}; empty where the model has no rule.
ReportSection extinction_section(const std::optional<JudgedExtinction>& judged);

}  // namespace wisp
