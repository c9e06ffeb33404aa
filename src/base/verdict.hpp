#pragma once
// A verdict is a table of criteria: the first that is missed gives the reason.

#include <optional>
#include <span>
#include <string>

namespace wisp {

enum class Bound { kAtLeast, kAtMost };

/// One figure, its bound, and the sentence that is the reason where the figure is beyond it.
struct Criterion {
  double figure = 0;  ///< NaN: not measured, the criterion abstains
  Bound bound = Bound::kAtLeast;
  double limit = 0;
  std::string sentence;  ///< "{figure}" and "{limit}" stand for the numbers
  int digits = 1;        ///< after the point of both numbers
  std::string code{};    ///< names the criterion for programs, which have sentences of their own
};

/// The sentence of the first criterion that is missed, its numbers filled in; nothing where all hold or abstain.
/// `code`: where to write that criterion's code; may be null.
std::optional<std::string> first_missed(std::span<const Criterion> criteria, std::string* code = nullptr);

}  // namespace wisp
