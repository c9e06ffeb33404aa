#pragma once
// A linear system by its state, x(t+1) = a x(t) + b u(t), y(t) = c x(t) + d u(t) + level, and the ARX form that
// simulates exactly as it does.
//
// Sources: T. Kailath, Linear Systems (1980), section 6.4, for ARX forms of a state-space system. Of all ARX forms with
// `lags` lags that are exact, the one is taken that carries least of the outputs' noise on: it finds the state `lags`
// rows ago from the samples since, by least squares (the finite-memory filter of W. H. Kwon, P. S. Kim and P. Park,
// IEEE Trans. Autom. Control 44 (1999), without noise in the state). Coefficients are small then and survive single
// precision.

#include <Eigen/Core>

#include "learn/arx/simulation/simulation_block.hpp"

namespace wisp::arx {

/// Of some outputs and all inputs, as deviations in scaled units.
struct StateSpace {
  Eigen::MatrixXd a, b, c, d;
  Eigen::VectorXd level;  ///< per output
  Eigen::VectorXd noise;  ///< standard deviation of what an output is measured with, > 0

  int states() const { return static_cast<int>(a.rows()); }
  int outputs() const { return static_cast<int>(c.rows()); }
  int inputs() const { return static_cast<int>(b.cols()); }
};

/// Lags of an ARX form that averages the outputs' noise: kStateSpaceLags, of many outputs fewer, and as many as
/// `states` take.
int arx_lags(int states, int outputs);

inline constexpr int kStateSpaceLags = 15;

/// ARX coefficients: a row an output, without A's sign.
struct ArxForm {
  Eigen::MatrixXd feedback;  ///< outputs × (outputs · lags): the newest sample of all outputs first
  Eigen::MatrixXd drive;     ///< outputs × (inputs · (lags + 1)): the newest sample of all inputs first, no delay
  Eigen::VectorXd constant;

  int lags() const { return static_cast<int>(feedback.cols() / feedback.rows()); }
};

/// Rounded to single precision, as it is played. Precondition: lags · outputs >= states.
ArxForm arx_form(const StateSpace& model, int lags);

/// Largest absolute pole of the form.
double radius(const ArxForm& form);

/// Rows [begin, end) of a run, counted with its history, from the state at `begin`.
Eigen::MatrixXd simulate(const StateSpace& model, const BlockRun& run, Eigen::Index begin,
                         const Eigen::VectorXd& state);

/// The state at row `begin` that fits the rows from there on best, weighted per output; outputs may be missing.
Eigen::VectorXd best_state(const StateSpace& model, const BlockRun& run, Eigen::Index begin,
                           const Eigen::VectorXd& weight);

/// The same by the ARX form, from the measured rows before `begin`: their noise moves on through poles that the state
/// has not.
///
/// Precondition: as many rows as the form has lags are measured there.
Eigen::MatrixXd simulate(const ArxForm& form, const BlockRun& run, Eigen::Index begin);

}  // namespace wisp::arx
