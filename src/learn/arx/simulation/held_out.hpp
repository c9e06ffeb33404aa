#pragma once
// How free runs over rows that were not learned from judge coefficients.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "learn/arx/judge/free_run_parts.hpp"
#include "learn/arx/simulation/simulation_block.hpp"
#include "learn/arx/simulation/state_space.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::arx {

/// One way to hold out: what is learned from, and what is judged on.
struct Fold {
  std::vector<Recording> learned;
  std::vector<Recording> held_out;
};

/// The middle of every recording, the same share of all, where they have more than `max_rows` rows together.
std::vector<Recording> middles_of(std::span<const Recording> recordings, std::size_t max_rows);

/// The last, middle and first 30 % of every recording, in turn, and forward chaining: 40, 60 and 80 % are learned from
/// and the next 20 % held out. What is estimated from later rows may know more of an earlier stretch than the other way
/// round.
std::vector<Fold> folds_of(std::span<const Recording> recordings);

/// Mean squared errors of free runs over kParts parts of the block's rows, all outputs together, in scaled units: from
/// the initial state that fits best, and from measured samples at eight places.
struct HeldOutErrors {
  Eigen::VectorXd estimated;
  Eigen::VectorXd measured;
  double size = 0;            ///< mean square of the outputs themselves
  Eigen::VectorXd by_output;  ///< both kinds of starts together, over all parts
};

HeldOutErrors held_out_errors(const SimulationBlock& block, const Eigen::VectorXd& theta);

/// The same of a state-space model and its ARX form: the best initial state is the model's, measured samples are the
/// form's.
///
/// Precondition: the block remembers as many rows of every output as the form has lags.
HeldOutErrors held_out_errors(const SimulationBlock& block, const StateSpace& model, const ArxForm& form);

}  // namespace wisp::arx
