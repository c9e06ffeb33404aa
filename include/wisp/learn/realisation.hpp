#pragma once
// How a mode of a chain is realised once it is its turn. Source: section 2.2 of the paper, which names segments,
// splines, systems, differential equations and chains of their own.

#include <string_view>

#include "wisp/base/result.hpp"

namespace wisp {

enum class Realisation {
  kSegments,  ///< by one of its recorded segments
  kLinear,    ///< by a linear system with noise, from where the mode before ended
  kOde,       ///< by a differential equation with products of velocities, likewise
  kChain,     ///< by a chain of its own, of parts of segments
  kSpline,    ///< by one spline, that varies as its segments do
};

/// `segments`, `linear`, `ode`, `chain` or `spline`.
/// Errors: another word.
Result<Realisation> parse_realisation(std::string_view text);

/// The word for it.
std::string_view word_of(Realisation realisation);

}  // namespace wisp
