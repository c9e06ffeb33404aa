#pragma once
// Folds of recordings, errors of free simulation over held-out rows, and significance of a difference of two models.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "learn/fit/arx_fit.hpp"
#include "learn/judge/prediction.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::arx {

/// A fold: recordings to learn from, and recordings to judge on.
struct Fold {
  std::vector<Recording> learned;
  std::vector<Recording> held_out;
};

/// Forward chaining: trains on the first 40, 60 and 80 % of every recording and holds out the next 20 %. No fold trains
/// on rows that follow the rows it is judged on.
std::vector<Fold> folds_of(std::span<const Recording> recordings);

/// Fit percentages of free simulation over held-out rows, per output: the last 30 % of every recording with a model of
/// the rest, and the first 30 % likewise. Empty without inputs, or where a fit or a simulation fails (too few rows).
std::vector<double> held_out_fits(std::span<const Recording> recordings, const ChannelChoice& channels,
                                  const ArxOptions& options);

/// The central part of every recording, the same share of all: at most `max_rows` rows in total, but of many recordings
/// 400 rows each on average, so that brief ones keep enough for the lags of a model.
std::vector<Recording> middles_of(std::span<const Recording> recordings, std::size_t max_rows);

/// Number of parts of a fold; errors are computed for each.
inline constexpr int kParts = 8;

/// Mean squared errors of free simulation over kParts parts of all rows: a row per part, a column per output, divided
/// by the output's variance; 0 for an output that never moves. `start.first_sample` is raised to the model's history,
/// and `start.as_played` ignored. Errors: the channels do not fit the model; no row can be simulated.
Result<Eigen::MatrixXd> free_run_parts(const ArxModel& model, std::span<const Recording> recordings,
                                       const ChannelChoice& channels, const FreeRunStart& start = {});

/// Errors of every part divided by the reference model's mean error, averaged with equal weight over outputs that the
/// reference does not simulate exactly. Precondition: `errors` and `reference` are of the same parts and outputs.
Eigen::VectorXd relative_errors(const Eigen::MatrixXd& errors, const Eigen::MatrixXd& reference);

/// Number of standard errors (over parts) by which the logarithms of `errors` lie below those of `others`; both are
/// squared errors of the same parts. Infinite where every part is lower by the same factor.
double standard_errors_below(const Eigen::VectorXd& errors, const Eigen::VectorXd& others);

/// Whether `errors` are below `others` by two standard errors, which chance alone reaches once in 40.
bool surely_better(const Eigen::VectorXd& errors, const Eigen::VectorXd& others);

}  // namespace wisp::arx
