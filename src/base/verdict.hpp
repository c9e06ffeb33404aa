#pragma once
// A verdict as a table of criteria: the first one violated gives the reason.

#include <optional>
#include <span>
#include <string>

namespace wisp {

enum class Bound { kAtLeast, kAtMost };

/// One figure, its bound, and the sentence that states the reason if the figure violates it.
struct Criterion {
  double figure = 0;  ///< NaN: not measured, the criterion is skipped
  Bound bound = Bound::kAtLeast;
  double limit = 0;
  std::string sentence;  ///< "{figure}" and "{limit}" stand for the numbers
  int digits = 1;        ///< digits after the point in both numbers
  std::string code{};    ///< machine-readable name of the criterion, for programs with their own sentences
};

/// Returns the sentence of the first violated criterion, with its numbers; nothing if none is violated. Sets `code`,
/// which may be null, to the violated criterion's code.
std::optional<std::string> first_missed(std::span<const Criterion> criteria, std::string* code = nullptr);

}  // namespace wisp
