#pragma once
// Moments of a recording to be shown, and those of a played life that are in a like state: pictures beside each other
// compare how things look and move, not where chance has taken them.

#include <cstddef>
#include <vector>

#include "wisp/learn/validate_outline.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Rows of the recording, and of what was played along its inputs.
struct LikeMoments {
  std::vector<std::size_t> recorded;
  std::vector<std::size_t> played;
};

/// Twelve moments an eighth of a second apart, where the outline's tip moves most, and the stretch of the played life
/// whose inputs, tip and height are nearest to theirs all along. Fewer where the recording is shorter.
///
/// Precondition: captured and played have the recording's rows.
LikeMoments like_moments(const Recording& recording, const OutlineRows& captured, const OutlineRows& played);

}  // namespace wisp::cli
