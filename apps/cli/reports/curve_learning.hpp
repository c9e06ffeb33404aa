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

/// Curves for `learn arx`: chosen on the last 30 % of every recording where the flag leaves it open, then fitted to all
/// rows, and reported. Empty where there are none.
/// Errors: as fit_input_curves(); `--offset none`, which leaves a curve no level of its own.
Result<std::vector<InputCurve>> learn_arx_curves(std::span<const Recording> recordings, const ChannelChoice& channels,
                                                 const ArxOrders& orders, const Arguments& arguments,
                                                 Terminal& terminal);

/// The recordings with each of the named inputs bent by its curve; as they are where there is none.
std::vector<Recording> bent_recordings(std::span<const Recording> recordings, const std::vector<std::string>& inputs,
                                       std::span<const InputCurve> curves);

}  // namespace wisp::cli
