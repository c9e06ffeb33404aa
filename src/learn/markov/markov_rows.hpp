#pragma once
// The regression shared by the modes of a switched model, the Markov chain of its modes, and the estimation of both by
// expectation–maximisation (markov_fit.cpp).
//
// Source: forward and backward passes as in L. E. Baum et al. (1970) and J. D. Hamilton, Econometrica 57 (1989).
// Departures of the estimation: several starts, of which the likeliest is taken; a mode's residuals are at least 1 % of
// a single ARX model's, so that no mode collapses onto a few rows; an unstable mode is stabilised.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "learn/judge/prediction.hpp"
#include "learn/rows/arx_design.hpp"
#include "learn/rows/arx_rows.hpp"
#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::markov {

/// All usable rows of the recordings as one regression, as deviations from the operating point.
struct Rows {
  struct Place {
    std::size_t recording = 0, row = 0;
  };
  /// Rows [begin, end) that are consecutive in time.
  struct Run {
    Eigen::Index begin = 0, end = 0;
  };

  ArxOrders orders;
  ArxDesign design;             ///< one group per output; columns are indices in phi, the constant's is last
  std::vector<double> offset;   ///< the operating point: outputs, then inputs
  Eigen::MatrixXd phi;          ///< rows × columns of the layout
  Eigen::MatrixXd y;            ///< rows × outputs
  std::vector<Place> places{};  ///< origin of every row
  std::vector<Run> runs{};

  Eigen::Index rows() const { return phi.rows(); }
  int outputs() const { return orders.outputs(); }
};

/// Builds the rows. `offset`: outputs, then inputs; empty: the channels' means over all recordings.
/// Errors: orders that do not fit, a missing channel, rates that differ, infinite samples, no usable row.
Result<Rows> make_rows(std::span<const Recording> recordings, const ChannelChoice& channels, const ArxOrders& orders,
                       std::vector<double> offset = {});

/// Rows between two shares (0 to 1) of every run. Runs are cut, never joined.
Rows share_of(const Rows& rows, double from, double to);

/// Coefficients and noise of one mode, for the columns of Rows::phi.
struct Mode {
  Eigen::MatrixXd theta;   ///< columns × outputs, signs of the prediction, 0 where an output lacks the coefficient
  Eigen::MatrixXd factor;  ///< lower triangular factor of the residuals' covariance
};

/// Modes, for the columns of Rows::phi, with their initial and transition probabilities.
struct Chain {
  std::vector<Mode> modes{};
  Eigen::VectorXd initial{};
  Eigen::MatrixXd transitions{};
};

Chain chain_of(const SwitchedArxModel& model, const Rows& rows);
ArxMode model_mode(const Mode& mode, const Rows& rows);
SwitchedArxModel model_of(const Chain& chain, const Rows& rows);

/// Least squares over weighted rows; the variances of residuals are at least `min_variance` (per output).
Mode fit_mode(const Rows& rows, const Eigen::VectorXd& weights, const Eigen::VectorXd& min_variance);

/// Scales the poles of a mode so that its spectral radius is at most `max_radius`, and refits its constant and
/// residuals. Returns whether that was needed.
bool limit_radius(double max_radius, const Rows& rows, const Eigen::VectorXd& weights,
                  const Eigen::VectorXd& min_variance, Mode& mode);

/// Probabilities of the modes, by forward and backward passes over the runs.
struct Belief {
  Eigen::MatrixXd given_all;       ///< rows × modes, given all rows of the run
  Eigen::MatrixXd given_past;      ///< rows × modes, given the rows before
  Eigen::MatrixXd steps;           ///< expected numbers of transitions, [from, to]
  Eigen::VectorXd log_likelihood;  ///< of each row, given the rows before

  std::vector<int> likeliest() const;  ///< likeliest mode of every row, given all rows of its run
};
Belief believe(const Chain& chain, const Rows& rows);

/// Likelihood of a recording's rows, and probabilities of the modes. Errors: channels that do not fit the model or are
/// missing, rates that differ, no usable row.
Result<Belief> believe(const SwitchedArxModel& model, const Recording& recording, const ChannelChoice& channels);

/// One series per output, as predict() of an ARX model returns them, from measured samples: `steps` ahead, or kFreeRun.
/// Errors: as believe(); steps neither 1 to 100000 nor kFreeRun.
Result<std::vector<std::vector<double>>> predict(const SwitchedArxModel& model, const Recording& recording,
                                                 const ChannelChoice& channels, int steps);

/// Figures of predict() over all recordings together, as in prediction_figures(). Errors: as predict().
Result<PredictionFigures> figures(const SwitchedArxModel& model, std::span<const Recording> recordings,
                                  const ChannelChoice& channels, int steps);

struct FitOptions {
  ArxOrders orders{};  ///< orders of every mode
  int modes = 0;       ///< 1 to kMaxArxModes; 0: as many, up to 6, as significantly raise the held-out likelihood
  std::uint64_t seed = 1;
};

/// A number of modes that was tried. Likelihoods are mean natural logarithms per row, in the outputs' units.
struct Candidate {
  int modes = 1;
  double log_likelihood = 0;           ///< of the training rows
  double held_out_log_likelihood = 0;  ///< of the held-out rows, the last 30 % of every stretch
  double gain_std_error = 0;           ///< standard error of its held-out gain over the preceding candidate
  bool determined = true;              ///< false: a mode had too few rows for its coefficients
};

struct Summary {
  std::size_t samples_used = 0;  ///< number of rows that the returned model is learned from: all usable ones
  std::size_t held_out = 0;
  std::vector<Candidate> candidates;  ///< begins with a single mode
  std::vector<std::size_t> mode_rows;
  std::vector<bool> mode_changed;            ///< whether each mode was stabilised
  std::vector<double> fit_percent;           ///< 100(1 − ‖y − ŷ‖/‖y − ȳ‖) one step ahead, per output
  std::vector<double> free_run_fit_percent;  ///< simulated from the input alone; empty without inputs
  Usable usable;
};

struct Fitted {
  SwitchedArxModel model;
  Summary summary;
};

/// Fits all episodes of all recordings together. Modes are ordered by the share of rows in which they act, largest
/// first. A fit that is unreliable, or no better than a single ARX model, has `usable.verdict` false and the reason.
/// Errors: no recordings, a missing channel, orders of the wrong shape, rates that differ, infinite samples, too few
/// rows for the modes; kStopped.
Result<Fitted> fit(std::span<const Recording> recordings, const ChannelChoice& channels, const FitOptions& options,
                   const Progress& progress = {});

}  // namespace wisp::markov
