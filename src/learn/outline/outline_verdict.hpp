#pragma once
// What a learned outline says of itself: whether to use it, and how it was made.

#include <span>

#include "learn/outline/outline_fit.hpp"

namespace wisp {

/// Whether the model may be used: by what is seen of its free play, not by its fit one step ahead, which pays for
/// stillness. With the first reason against it or a sentence in its favour.
Usable outline_verdict(const OutlineSummary& summary, std::string* code = nullptr);

/// What the model's file says of how it was made, but for a rule of extinction and the cost.
Training outline_training(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                          const OutlineSummary& summary);

}  // namespace wisp
