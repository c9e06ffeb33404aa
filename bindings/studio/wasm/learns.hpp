#pragma once
// Two modules learn: one chains, of what falls; the other everything else, and it captures.

namespace wisp::studio {

/// Which of the two this is.
extern const bool kLearnsChains;

}  // namespace wisp::studio
