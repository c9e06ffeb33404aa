#pragma once
// Two modules learn: one chains, of what falls; the other everything else, and it captures.

#include <string>

#include "wisp/base/result.hpp"

namespace wisp::studio {

/// Which of the two this is.
inline constexpr bool kLearnsChains = WISP_LEARNS_CHAINS;

/// Why something is learned by neither.
inline Error left_out(const char* what) { return Error{std::string(what) + " are not learned here; use the program"}; }

}  // namespace wisp::studio
