#pragma once
// Two modules learn: one learns chains; the other learns everything else, and captures.

#include <string>

#include "wisp/base/result.hpp"

namespace wisp::studio {

/// Whether this is the module of chains.
inline constexpr bool kLearnsChains = WISP_LEARNS_CHAINS;

/// Error for models that neither module learns.
inline Error left_out(const char* what) { return Error{std::string(what) + " are not learned here; use the program"}; }

}  // namespace wisp::studio
