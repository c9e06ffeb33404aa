#pragma once
// How far free simulation is from what was held out, part by part, and whether one way is surely better than another.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "learn/channel_choice.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::arx {

/// Parts of a fold, each with errors of its own.
inline constexpr int kParts = 8;

/// Standard errors by which what is less simple has to be better, to be taken: by chance 1 in 40 is.
inline constexpr double kSurelyBetter = 2;

/// Mean squared errors of free simulation from measured samples over kParts parts of all rows: a row a part, a column
/// an output, in shares of the output's variance; 0 for an output that never moves. Errors: as predict(); no row that
/// is simulated.
Result<Eigen::MatrixXd> free_run_parts(const ArxModel& model, std::span<const Recording> recordings,
                                       const ChannelChoice& channels);

/// The errors of every part in shares of another way's over all parts, mean over the outputs that it does not simulate
/// exactly: an output that is followed well counts as much as one that is not.
///
/// Precondition: `errors` and `others` are of the same parts and outputs.
Eigen::VectorXd relative_errors(const Eigen::MatrixXd& errors, const Eigen::MatrixXd& others);

/// By how many standard errors over parts the logarithms of `errors` are below those of `others`: both squared errors
/// of the same parts. Infinite where every part is alike below.
double standard_errors_below(const Eigen::VectorXd& errors, const Eigen::VectorXd& others);

}  // namespace wisp::arx
