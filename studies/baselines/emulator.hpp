#pragma once
// A small neural emulator: a multilayer perceptron from history and input to the next output.
//
// Source: R. Grzeszczuk, D. Terzopoulos & G. Hinton, "NeuroAnimator: Fast Neural Network Emulation and Control of
// Physics-Based Models", SIGGRAPH 1998, section 3 (one hidden layer of sigmoids; the network gives the change of state
// and not the state; inputs and outputs scaled to unit variance). Trained by stochastic gradients with moments
// (D. P. Kingma & J. Ba, "Adam", 2015) until held-out frames are predicted no better. Departures: history stands for
// the state, which is not recorded; what the network leaves is played as Gaussian noise of its covariance; outputs are
// held to the range seen plus half of it, since a network that is fed its own outputs is not known to be stable.

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <span>

#include "studies/baselines/frames.hpp"

namespace wisp::baselines {

/// How to learn.
struct EmulatorOptions {
  int lags = 4;          ///< frames of outputs looked back on, >= 1
  int wind_lags = 4;     ///< frames of wind, the present one among them, >= 0; 0: not driven
  int hidden = 48;       ///< units
  double jitter = 0.05;  ///< noise on the history while learning, in standard deviations, >= 0: teaches it to come back
                         ///< from its own errors
  double held_out = 0.2;  ///< last share of every stretch, which says when to stop
  int max_epochs = 150;
  int patience = 15;   ///< epochs without a better prediction of what is held out
  double rate = 2e-3;  ///< of learning
  int batch = 128;
  std::uint64_t seed = 1;
};

/// A network on scaled inputs: y(t) = y(t−1) + spread · (W₂ tanh(W₁ x + b₁) + b₂).
struct Emulator {
  int lags = 0;
  int wind_lags = 0;
  Eigen::VectorXd mean;    ///< of outputs
  Eigen::VectorXd sd;      ///< of outputs
  Eigen::VectorXd spread;  ///< of their changes
  double wind_scale = 1;   ///< standard deviation of the wind
  Eigen::MatrixXd w1;
  Eigen::VectorXd b1;
  Eigen::MatrixXd w2;
  Eigen::VectorXd b2;
  Eigen::MatrixXd noise;      ///< root of the covariance of what it leaves, outputs × outputs
  Eigen::VectorXd lowest;     ///< that an output is held to
  Eigen::VectorXd highest;    ///< that an output is held to
  double learned_error = 0;   ///< mean square of the scaled error one step ahead on what was learned from
  double held_out_error = 0;  ///< and on what was held out
  int epochs = 0;

  /// The outputs that follow: `history` newest first, lags of them; `wind` newest first, wind_lags of it.
  Eigen::VectorXd next(const std::deque<Eigen::VectorXd>& history, const std::deque<double>& wind) const;
  /// In single precision.
  std::size_t bytes() const;
  /// Multiplications and additions of a frame, a tanh as one operation; without what random numbers cost.
  std::int64_t operations() const;
};

/// Learns an emulator.
///
/// Precondition: there are frames, more in one stretch than lags.
Emulator learn_emulator(std::span<const Frames> frames, const EmulatorOptions& options = {});

/// Plays one from its mean.
class EmulatorPlayer {
 public:
  EmulatorPlayer(const Emulator& emulator, std::uint64_t seed, bool noise);
  Eigen::VectorXd step(double wind);

  /// Share of steps in which an output left what it is held to: it diverged there.
  double held_share() const;

 private:
  const Emulator& emulator_;
  NormalStream random_;
  bool noise_;
  std::deque<Eigen::VectorXd> history_;
  std::deque<double> wind_;
  std::uint64_t steps_ = 0;
  std::uint64_t held_ = 0;
};

}  // namespace wisp::baselines
