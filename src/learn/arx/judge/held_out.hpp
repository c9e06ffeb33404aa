#pragma once
// Folds of recordings, errors of free simulation over what a fold holds out, and whether one model is surely better.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/arx/judge/prediction.hpp"
#include "learn/arx/rows/arx_design.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::arx {

/// One way to hold out: recordings to learn from, and recordings to judge on.
struct Fold {
  std::vector<Recording> learned;
  std::vector<Recording> held_out;
};

/// Forward chaining: the first 40, 60 and 80 % of every recording are learned from and the next 20 % are held out. No
/// fold learns from rows that follow the rows it is judged on.
std::vector<Fold> folds_of(std::span<const Recording> recordings);

/// Fits in percent of free simulation over rows that were held out, per output: the last 30 % of every recording by a
/// model of the rest, and the first 30 %. Empty without inputs, or where there are too few rows.
std::vector<double> held_out_fits(std::span<const Recording> recordings, const ChannelChoice& channels,
                                  const ArxOptions& options);

/// The middle of every recording, the same share of all, so that at most `max_rows` rows are left in total.
std::vector<Recording> middles_of(std::span<const Recording> recordings, std::size_t max_rows);

/// Parts of a fold, each with errors of its own.
inline constexpr int kParts = 8;

/// Standard errors by which a less simple model has to be better to be taken: 1 in 40 is so by chance.
inline constexpr double kSurelyBetter = 2;

/// Mean squared errors of free simulation over kParts parts of all rows: a row per part, a column per output, in shares
/// of the output's variance; 0 for an output that never moves. `start.first_sample` is raised to the model's history.
/// Errors: the channels do not fit the model; no row can be simulated.
Result<Eigen::MatrixXd> free_run_parts(const ArxModel& model, std::span<const Recording> recordings,
                                       const ChannelChoice& channels, const FreeRunStart& start = {});

/// The errors of every part divided by the mean error of the reference model, averaged over the outputs that the
/// reference does not simulate exactly: every output counts alike.
///
/// Precondition: `errors` and `reference` are of the same parts and outputs.
Eigen::VectorXd relative_errors(const Eigen::MatrixXd& errors, const Eigen::MatrixXd& reference);

/// By how many standard errors over parts the logarithms of `errors` are below those of `others`: both squared errors
/// of the same parts. Infinite where every part is lower by the same factor.
double standard_errors_below(const Eigen::VectorXd& errors, const Eigen::VectorXd& others);

/// Whether `errors` are below `others` by kSurelyBetter standard errors.
bool surely_better(const Eigen::VectorXd& errors, const Eigen::VectorXd& others);

}  // namespace wisp::arx
