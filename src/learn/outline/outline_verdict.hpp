#pragma once
// Verdict on a learned outline, and its training record.

#include <span>

#include "learn/outline/outline_fit.hpp"

namespace wisp {

/// Whether the model may be used, judged by its free play, not by its one-step fit, which rewards stillness. Contains
/// the first reason against it or a sentence in its favour.
Usable outline_verdict(const OutlineSummary& summary, std::string* code = nullptr);

/// The training record for the model's file, without extinction rule and cost.
Training outline_training(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                          const OutlineSummary& summary);

}  // namespace wisp
