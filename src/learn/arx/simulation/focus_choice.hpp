#pragma once
// Which way to coefficients is taken, by the errors of held-out free runs.
//
// Least squares is left only for what is surely better: the candidate nearest to it among those whose error is within a
// twentieth of the least (as L. Breiman et al., Classification and Regression Trees (1984), section 3.4.3, take the
// simplest within one standard error), if it is better by one standard error over parts of the folds and loses none.

#include <Eigen/Core>
#include <vector>

#include "learn/arx/simulation/focus.hpp"

namespace wisp::arx {

/// One set of outputs that is simulated together, and how the ways to go did on held-out rows.
struct Unit {
  std::vector<int> outputs;
  bool decoupled = false;                    ///< taken out of a block of several
  std::vector<FocusCandidate> candidates{};  ///< least squares first, then what lies farther and farther from it
  Eigen::MatrixXd squares{};    ///< a row a candidate, kParts columns a fold: both kinds of starts together
  Eigen::MatrixXd estimated{};  ///< the same from the best initial states alone
  Eigen::MatrixXd by_output{};  ///< a row a candidate, a column an output: both kinds of starts, summed over folds
  std::vector<double> sizes{};  ///< mean squares of the outputs themselves, one a fold
  std::size_t picked = 0;

  bool refined() const { return !candidates.empty() && candidates[picked].one_step_weight.has_value(); }
  int kernel_lags() const { return candidates.empty() ? 0 : candidates[picked].kernel_lags; }
  int states() const { return candidates.empty() ? 0 : candidates[picked].states; }

  /// Sets what is picked, states aside. With `leave_least_squares` the best of what is refined.
  ///
  /// Precondition: there are candidates.
  void pick(bool leave_least_squares);
};

/// Outputs that feed each other: together, and, where there are several, each on its own.
struct Block {
  Unit together;
  std::vector<Unit> apart{};
  bool decoupled = false;  ///< as chosen

  std::vector<Unit*> chosen();

  /// Sets what is picked and whether outputs are on their own: where that is surely better. States are taken in the
  /// place of all that where they are surely better and every output gains a tenth.
  void pick(bool leave_least_squares);

 private:
  void pick_states();
};

}  // namespace wisp::arx
