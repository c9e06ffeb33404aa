#pragma once
// The ways to coefficients that a focus chooses among: what each gives for some rows, and its errors on others.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/arx/rows/arx_rows.hpp"
#include "learn/arx/simulation/focus_choice.hpp"
#include "learn/arx/simulation/held_out.hpp"
#include "learn/arx/simulation/refine.hpp"
#include "learn/arx/simulation/state_space.hpp"
#include "wisp/base/progress.hpp"

namespace wisp::arx {

/// The arguments of a fit, and what may be tried.
struct Subject {
  std::span<const Recording> recordings;
  const ChannelChoice& channels;
  ArxOptions options;
  const Progress& progress;
  std::vector<int> kernel_lags{};  ///< that are tried
  bool subspace = false;           ///< the same of subspace estimates
  bool refines = true;             ///< whether the data tell all coefficients; if not, only a state can
  bool at_zero = false;            ///< whether no input at rest may mean no output

  bool many_rows() const;
  std::vector<Recording> some_rows() const;
  int first_sample() const { return options.first_sample.value_or(options.orders.history()); }
  int judged_from() const;
  double largest_pole() const { return 1 - options.stability_margin; }

  /// The mean of a slow output is not where its inputs' means bring it: free runs show it, one step hardly does.
  ArxOffset level() const { return options.offset == ArxOffset::kMean ? ArxOffset::kEstimate : options.offset; }
  bool constant() const { return level() == ArxOffset::kEstimate; }

  /// The same with the data as they are.
  Subject about_zero() const;

  /// Whether the unit's outputs have a state in common, which reaches all of them and is driven by all inputs.
  bool has_one_state(const Unit& unit) const;
};

/// Whether every channel's mean is farther from 0 than it varies: only then is no output without input more than a
/// level like others.
bool lie_off_zero(std::span<const Recording> recordings, const ChannelChoice& channels);

/// Least squares for some rows.
struct Learned {
  Signals signals;
  ArxFit coupled;
  std::optional<ArxFit> decoupled{};
  std::vector<std::optional<ArxFit>> kernels{};  ///< by the lags that are tried; nothing where rows do not suffice
  std::vector<std::optional<ArxFit>> decoupled_kernels{};

  const ArxModel& model_of(const Unit& unit) const { return unit.decoupled ? decoupled->model : coupled.model; }
  const std::vector<std::optional<ArxFit>>& kernels_of(const Unit& unit) const {
    return unit.decoupled ? decoupled_kernels : kernels;
  }
};

/// As the subject says, and about zero where that is tried.
struct LearnedRows {
  Learned given;
  std::optional<Learned> at_zero{};
};

Result<LearnedRows> learn_rows(const Subject& subject, std::span<const Recording> recordings, bool with_decoupled);

/// A way to go, and what it gives.
struct Way {
  FocusCandidate candidate;
  ArxOrders orders;         ///< of what it gives
  Eigen::VectorXd theta{};  ///< the unit's rows about means, one after the other, in scaled units; or
  std::optional<StateSpace> space{};
  ArxForm form{};  ///< of the space

  bool is_there() const { return theta.size() > 0 || space; }
};

/// Least squares first, then what lies farther and farther from it; what rows do not suffice for is not there.
std::vector<Way> ways_of(const Subject& subject, const LearnedRows& learned, const Unit& unit);

/// `unseen` is of least squares' orders.
HeldOutErrors errors_of(const Subject& subject, const Signals& held_out, const Unit& unit, const Way& way,
                        const SimulationBlock& unseen);

/// What a unit simulates, with the orders of least squares.
SimulationBlock simulation_of(const Subject& subject, const Signals& signals, const Learned& learned, const Unit& unit);

/// The chosen refined candidate for all rows: its coefficients about means in scaled units, and their covariance where
/// feedback is refined too.
struct RefinedRows {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance{};
};

RefinedRows refined_rows(const Subject& subject, const LearnedRows& learned, const Unit& unit);

/// Orders with that many lags of every channel, and no delays.
ArxOrders kernel_orders(ArxOrders orders, int lags);

/// Of what a state gives: every output remembers all that it is simulated with.
ArxOrders state_space_orders(ArxOrders orders, const std::vector<int>& outputs, int lags);

ArxOrders decoupled_orders(ArxOrders orders, const std::vector<int>& outputs);

}  // namespace wisp::arx
