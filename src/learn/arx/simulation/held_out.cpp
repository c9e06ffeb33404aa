#include "learn/arx/simulation/held_out.hpp"

#include <algorithm>
#include <cmath>

#include "learn/arx/simulation/output_error.hpp"

namespace wisp::arx {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kStarts = 8;              // from measured samples
constexpr double kReach = 0.75;         // the last one starts here
constexpr Index kMinRowsPerStart = 20;  // that a start is worth
constexpr double kMaxError = 1e6;

// Sums of squared errors by parts of all rows.
class PartSums {
 public:
  explicit PartSums(const SimulationBlock& block)
      : sum_(VectorXd::Zero(kParts)), rows_(sum_), of_output_(VectorXd::Zero(block.size())), counted_(of_output_) {
    for (const BlockRun& run : block.runs()) total_ += run.rows;
  }

  void add(Index row, int output, double error) {
    const double size = std::isnan(error) ? kMaxError : std::min(std::abs(error), kMaxError);
    const Index part = row * kParts / total_;
    sum_[part] += size * size;
    ++rows_[part];
    of_output_[output] += size * size;
    ++counted_[output];
  }

  VectorXd means() const {
    const double mean = sum_.sum() / std::max(rows_.sum(), 1.0);
    VectorXd out(kParts);
    for (Index p = 0; p < kParts; ++p) out[p] = rows_[p] > 0 ? sum_[p] / rows_[p] : mean;
    return out;
  }

  VectorXd by_output() const { return of_output_.cwiseQuotient(counted_.cwiseMax(1)); }

 private:
  VectorXd sum_;
  VectorXd rows_;
  VectorXd of_output_;
  VectorXd counted_;
  Index total_ = 0;
};

bool past_is_measured(const SimulationBlock& block, const BlockRun& run, Index row) {
  for (int o = 0; o < block.size(); ++o) {
    if (run.outputs.col(o).segment(row - block.memory()[o], block.memory()[o]).hasNaN()) return false;
  }
  return true;
}

// Adds the errors of the rows from `begin` of a run on; the simulation ends with the run.
void add_errors(const SimulationBlock& block, const BlockRun& run, Index begin, Index before, const MatrixXd& simulated,
                PartSums& sums) {
  const Index end = block.history() + run.rows, first = end - simulated.rows();
  for (int o = 0; o < block.size(); ++o) {
    for (Index t = begin; t < end; ++t) {
      if (std::isnan(run.outputs(t, o))) continue;
      sums.add(before + t - block.history(), o, run.outputs(t, o) - simulated(t - first, o));
    }
  }
}

// Adds the errors of simulations from measured samples: `simulate_from` gives a run's rows from one of them on.
template <class SimulateFrom>
void add_measured_starts(const SimulationBlock& block, const BlockRun& run, Index before,
                         const SimulateFrom& simulate_from, PartSums& sums) {
  const Index history = block.history();
  const Index starts = std::clamp<Index>(run.rows / kMinRowsPerStart, 1, kStarts);
  for (Index k = 0; k < starts; ++k) {
    const Index whole = run.rows * k / starts;
    const Index begin = history + static_cast<Index>(kReach * static_cast<double>(whole));
    if (!past_is_measured(block, run, begin)) continue;
    add_errors(block, run, begin, before, simulate_from(begin), sums);
  }
}

double size_of(const SimulationBlock& block) {
  return block.weight().cwiseInverse().sum() / std::max(block.measured_rows(), 1.0);
}

}  // namespace

std::vector<Recording> middles_of(std::span<const Recording> recordings, std::size_t max_rows) {
  std::size_t total = 0;
  for (const Recording& one : recordings) total += one.rows();
  std::vector<Recording> middles;
  for (const Recording& one : recordings) {
    const double share = total > max_rows ? static_cast<double>(max_rows) / static_cast<double>(total) : 1;
    const auto rows = static_cast<std::size_t>(share * static_cast<double>(one.rows()));
    const std::size_t skipped = (one.rows() - rows) / 2;
    middles.push_back(slice(one, skipped, skipped + rows));
  }
  return middles;
}

std::vector<Fold> folds_of(std::span<const Recording> recordings) {
  struct Share {
    double first, last;
    bool later;  // whether what follows is learned from too
  };
  std::vector<Fold> folds;
  for (const Share& share : {Share{0.7, 1.0, true},
                             {0.35, 0.65, true},
                             {0.0, 0.3, true},
                             {0.4, 0.6, false},
                             {0.6, 0.8, false},
                             {0.8, 1.0, false}}) {
    Fold& fold = folds.emplace_back();
    for (const Recording& one : recordings) {
      const auto at = [&](double place) {
        return static_cast<std::size_t>(std::lround(place * static_cast<double>(one.rows())));
      };
      const std::size_t first = at(share.first), last = at(share.last);
      if (first > 0) fold.learned.push_back(slice(one, 0, first));
      fold.held_out.push_back(slice(one, first, last));
      if (share.later && last < one.rows()) fold.learned.push_back(slice(one, last, one.rows()));
    }
  }
  return folds;
}

HeldOutErrors held_out_errors(const SimulationBlock& block, const VectorXd& theta) {
  PartSums estimated(block), measured(block);
  const BlockSimulation simulation = simulate_block(block, theta);
  Index before = 0;
  for (std::size_t r = 0; r < block.runs().size(); ++r) {
    const BlockRun& run = block.runs()[r];
    add_errors(block, run, block.history(), before, simulation.simulated[r], estimated);
    const auto from = [&](Index begin) { return simulate_from(block, theta, run, begin); };
    add_measured_starts(block, run, before, from, measured);
    before += run.rows;
  }
  return {estimated.means(), measured.means(), size_of(block), estimated.by_output() + measured.by_output()};
}

HeldOutErrors held_out_errors(const SimulationBlock& block, const StateSpace& model, const ArxForm& form) {
  PartSums estimated(block), measured(block);
  Index before = 0;
  for (const BlockRun& run : block.runs()) {
    const VectorXd state = best_state(model, run, block.history(), block.weight());
    add_errors(block, run, block.history(), before, simulate(model, run, block.history(), state), estimated);
    const auto from = [&](Index begin) { return simulate(form, run, begin); };
    add_measured_starts(block, run, before, from, measured);
    before += run.rows;
  }
  return {estimated.means(), measured.means(), size_of(block), estimated.by_output() + measured.by_output()};
}

}  // namespace wisp::arx
