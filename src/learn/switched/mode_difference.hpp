#pragma once
// In what the modes of a switched model differ: in how they move, or only in the size of their noise.
//
// A mixture of noise sizes makes held-out rows likelier, and rightly so: the likelihood is of the whole distribution,
// and a row of a quiet stretch is likely under a small noise. But such modes predict no better and move no differently,
// and who takes them for ways of moving is misled.

#include <cstddef>
#include <span>
#include <vector>

#include "wisp/model/switched.hpp"

namespace wisp {

/// Coefficients farther apart than this many standard errors of their difference differ. By chance alone 1 in 370 does.
inline constexpr double kDifferentStdErrors = 3;

/// Two modes beside each other.
struct ModeDifference {
  std::size_t first = 0;
  std::size_t second = 0;
  std::size_t coefficients = 0;  ///< of A and B, and constants, that differ
  std::size_t compared = 0;      ///< of so many
  double most_std_errors = 0;    ///< between the two that are farthest apart
  double noise_ratio = 1;        ///< the second's residuals over the first's, geometric mean over outputs

  /// Whether all that may distinguish them is the size of their noise.
  bool same_coefficients() const { return coefficients == 0; }
};

/// Every pair of modes, in order. Standard errors are taken as those of independent estimates; how the rows were shared
/// out among the modes is taken as known, which makes them a little too small.
///
/// Precondition: the modes have standard errors; `constant_std_error` has those of the constants, per mode and output.
std::vector<ModeDifference> mode_differences(const SwitchedArxModel& model,
                                             std::span<const std::vector<double>> constant_std_error);

}  // namespace wisp
