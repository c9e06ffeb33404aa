#pragma once
// What `wisp learn` makes of flames that went out: the flag, the recordings without the dying, the rule, its figures.

#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/learn/extinction.hpp"
#include "wisp/learn/outline.hpp"

namespace wisp::cli {

/// `--blow-out`; `fallback` is its default: auto for flames, off for what does not burn.
Flag blow_out_flag(const std::string& fallback);

/// Where the rule of extinction comes from.
enum class BlowOutSource { kOff, kAuto, kGiven };

/// What `--blow-out` asks for.
struct BlowOutWish {
  BlowOutSource source = BlowOutSource::kOff;
  Extinction given{};  ///< level and seconds as given, no haste: what is said is what happens
};

/// Errors: not auto, off or two numbers in their ranges.
Result<BlowOutWish> blow_out_wish(const Arguments& arguments);

/// Recordings of an outline in which what blows may have put it out.
class BlowOuts {
 public:
  /// Finds the blow-outs of the recordings' first input, and takes the dying out of them; without an input, or when
  /// they are not wanted, nothing is found and the recordings stay as they are.
  /// Errors: as find_blow_outs().
  static Result<BlowOuts> find(std::vector<Recording> recordings, const BlowOutWish& wish);

  /// What the outline is learned from.
  const std::vector<Recording>& burning() const { return burning_; }

  /// Gives the model its rule of extinction and reports it: `extinction`.
  /// Errors: the model is not valid with it.
  Result<void> complete(OutlineFit& fit, const BlowOutWish& wish, Terminal& terminal) const;

 private:
  std::vector<ExtinctionEvidence> evidence(double scale, double dying) const;

  std::string input_;  // empty: there is none
  std::vector<Recording> recordings_;
  std::vector<Recording> burning_;
  std::vector<std::vector<BlowOut>> found_;
};

/// The recording without what a model's rule of extinction speaks of, as it was learned from; all of it where the model
/// has none.
/// Errors: as find_blow_outs().
Result<Recording> burning_part(const Model& model, const Recording& recording);

/// How a model's rule does on a recording it was not learned from; null where it has none. With `own_scale` an input of
/// 1 is the 95th percentile of this recording's wind while the flame burns: another microphone, another gain. Errors:
/// as find_blow_outs(), and as scaled_input().
Result<Json> judged_extinction(const Model& model, const Recording& recording, bool own_scale);

/// A rule as `learn` and `info` show it; null where there is none.
Json json_of(const std::optional<Extinction>& rule, const Model& model);

/// The same in a sentence.
std::string sentence_of(const Extinction& rule);

}  // namespace wisp::cli
