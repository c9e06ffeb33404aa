#pragma once
// One-step prediction errors of an ARX model, and how they accumulate over several steps.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "learn/rows/arx_rows.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

/// Channels of `recordings` as deviations from the model's operating point. Errors: those of find_signals, and channels
/// that do not fit the model.
Result<Signals> signals_of_model(const ArxModel& model, std::span<const Recording> recordings,
                                 const ChannelChoice& channels);

/// The prediction-error filter A(q) y − B(q) u − c, on deviations from the operating point.
class ErrorFilter {
 public:
  /// Preconditions: `model` and `signals` outlive the filter and fit each other; scales are 1.
  ErrorFilter(const ArxModel& model, const Signals& signals);

  /// Writes the errors of the rows to `out`, one column an output.
  ///
  /// Preconditions: all history is present, rows.begin >= model.orders.history(); out has one row per row of `rows`.
  void errors(const RowRun& rows, Eigen::Ref<Eigen::MatrixXd> out);

 private:
  struct Row {
    std::vector<LaggedChannel> columns;
    std::vector<double> weights;
  };

  const ArxModel& model_;
  ScaledBlock block_;
  std::vector<Row> rows_;  // one row of coefficients per output
  std::vector<const double*> series_;
};

/// F_0 … F_{count−1}: the response of the outputs to a unit shock e(0). F_0 is the identity.
std::vector<Eigen::MatrixXd> noise_response(const ArxModel& model, int count);

}  // namespace wisp
