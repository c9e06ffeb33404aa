#pragma once
// `--input-curve`: curves on a model's inputs, from flags to figures.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/learn/curve_choice.hpp"

namespace wisp::cli {

/// The flag, and what it is where nothing is said; `help` ends its help.
Flag curve_flag(const std::string& unless_said, const std::string& help);

/// Knots as the flag says: 0 none, unset where held-out rows are to say.
std::optional<int> curve_knots_of(const Arguments& arguments);

/// How it was chosen, and the curves of the inputs that are named.
Json curve_json(const CurveChoice& choice, const std::vector<std::string>& inputs,
                std::span<const CurveEstimate> curves);

/// A curve as knot → value pairs, for people.
std::string curve_text(const InputCurve& curve);

}  // namespace wisp::cli
