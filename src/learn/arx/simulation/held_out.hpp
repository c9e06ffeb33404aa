#pragma once
// How free runs over rows that were not learned from judge coefficients.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "learn/arx/simulation/simulation_block.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::arx {

/// One way to hold out: what is learned from, and what is judged on.
struct Fold {
  std::vector<Recording> learned;
  std::vector<Recording> held_out;
};

/// The last, middle and first 30 % of every recording, in turn, of at most `max_rows` rows in all.
std::vector<Fold> folds_of(std::span<const Recording> recordings, std::size_t max_rows);

/// Parts of a fold whose errors are told apart.
inline constexpr int kParts = 8;

/// Mean squared errors of free runs over kParts parts of the block's rows, as shares of its outputs' variance: of runs
/// from the initial state that fits best plus those from measured samples, which start at eight places.
struct HeldOutErrors {
  Eigen::VectorXd estimated;
  Eigen::VectorXd measured;
};

HeldOutErrors held_out_errors(const SimulationBlock& block, const Eigen::VectorXd& theta);

}  // namespace wisp::arx
