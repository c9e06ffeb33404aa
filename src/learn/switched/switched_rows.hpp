#pragma once
// The regression that switched modes share: every usable row of the recordings with all samples that any mode or region
// looks at, scaled to the size of their channels; and working models on it.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "learn/channel_choice.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/switched.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Operating point and size of every channel.
struct SwitchedScales {
  std::vector<double> output_mean, input_mean;
  std::vector<double> output_size, input_size;  ///< > 0
};

struct SwitchedRows {
  struct Place {
    std::size_t recording = 0, row = 0;
  };
  /// Rows [begin, end) that follow each other in time.
  struct Run {
    Eigen::Index begin = 0, end = 0;
  };

  ArxOrders orders;
  SwitchedScales scales;
  std::vector<RegionSample> samples;
  std::vector<std::vector<int>> columns;  ///< per output: of phi, in theta's order; the constant comes last
  Eigen::MatrixXd phi;                    ///< rows × (1 + samples), the constant's 1 first
  Eigen::MatrixXd y;                      ///< rows × outputs
  std::vector<Place> places;
  std::vector<Run> runs;

  Eigen::Index rows() const { return phi.rows(); }
  int outputs() const { return orders.outputs(); }
};

/// Means (or zeros) and standard deviations of the channels over all recordings; a channel that never moves has size 1.
/// Precondition: all channels are there.
SwitchedScales scales_of(std::span<const Recording> recordings, const ChannelChoice& channels, bool subtract_means);

/// Errors: orders that do not fit, a channel that a recording has not, rates that differ, infinite samples.
Result<void> check_switched_data(std::span<const Recording> recordings, const ChannelChoice& channels,
                                 const ArxOrders& orders);

/// Errors: no usable row. Precondition: check_switched_data() has no error.
Result<SwitchedRows> make_switched_rows(std::span<const Recording> recordings, const ChannelChoice& channels,
                                        const ArxOrders& orders, const SwitchedScales& scales);

/// Of every run the rows between two shares of it, 0 to 1. Runs are cut, none is joined.
SwitchedRows share_of(const SwitchedRows& rows, double from, double to);

/// A switched model on scaled rows.
struct ScaledModes {
  Switching switching = Switching::kRegions;
  std::vector<Eigen::MatrixXd> theta;   ///< per mode (1 + samples) × outputs, 0 where a row has no such coefficient
  std::vector<Eigen::MatrixXd> factor;  ///< per mode, lower triangular, of the residuals' covariance
  Eigen::MatrixXd regions;              ///< modes × (1 + samples)
  Eigen::VectorXd initial;
  Eigen::MatrixXd transitions;

  int modes() const { return static_cast<int>(theta.size()); }
};

/// A coefficient in the model's units is the scaled one times this. Column 0 is the constant's.
double coefficient_scale(const SwitchedRows& rows, int output, int column);

ScaledModes scaled_modes(const SwitchedArxModel& model, const SwitchedRows& rows);
SwitchedArxModel model_of(const ScaledModes& modes, const SwitchedRows& rows);

/// ln of the Gaussian density of every row's outputs under every mode, rows × modes.
Eigen::MatrixXd log_densities(const ScaledModes& modes, const SwitchedRows& rows);

/// The mode of each row by the regions, as the model plays.
std::vector<int> region_modes(const ScaledModes& modes, const SwitchedRows& rows);

/// What forward and backward passes over the rows' runs tell of a Markov chain's modes.
struct ModeBelief {
  Eigen::MatrixXd given_all;       ///< rows × modes: the probability of each mode, by all rows of its run
  Eigen::MatrixXd given_past;      ///< by the rows before it
  Eigen::MatrixXd steps;           ///< modes × modes: expected number of transitions
  Eigen::VectorXd log_likelihood;  ///< of each row, given those before it
};
ModeBelief believe(const ScaledModes& modes, const SwitchedRows& rows, const Eigen::MatrixXd& log_density);

/// ln of the density of each row given those before it, in scaled units.
std::vector<double> row_log_likelihoods(const ScaledModes& modes, const SwitchedRows& rows);

/// The likeliest mode of each row: its region or, of a Markov chain, by all rows of its run.
std::vector<int> likeliest_modes(const ScaledModes& modes, const SwitchedRows& rows);

}  // namespace wisp
