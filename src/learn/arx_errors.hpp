#pragma once
// One-step prediction errors of an ARX model, and how they add up over several steps.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "arx_rows.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

/// The channels of `recordings`, with the model's own operating point. Errors: as find_signals, and channels that do
/// not fit the model.
Result<Signals> signals_of_model(const ArxModel& model, std::span<const Recording> recordings,
                                 const ChannelChoice& channels);

/// The lags of each channel that the model uses, and lag 0 of every output.
std::vector<std::vector<int>> lags_of_model(const ArxModel& model);

/// A(q) y − B(q) u − c on the signals' deviations.
class ErrorFilter {
 public:
  /// Preconditions: `model` and `signals` outlive the filter and fit each other.
  ErrorFilter(const ArxModel& model, const Signals& signals);

  /// Writes the errors of rows [begin, begin + out.rows()) to `out`, one column an output.
  ///
  /// Precondition: the rows' history is there: begin >= model.orders.history().
  void errors(std::size_t recording, std::size_t begin, Eigen::Ref<Eigen::MatrixXd> out);

  /// The deviations of output i over the rows of the last call.
  auto output(int i) const { return samples_.col(i).tail(rows_); }

 private:
  struct Term {
    int channel;
    int lag;
    double weight;
  };

  const ArxModel& model_;
  const Signals& signals_;
  int history_;
  Eigen::Index rows_ = 0;
  std::vector<std::vector<Term>> terms_;  // per output
  Eigen::MatrixXd samples_;
};

/// F_0 … F_{count−1}: the response of the outputs to a unit shock e(0). F_0 is the identity.
std::vector<Eigen::MatrixXd> noise_response(const ArxModel& model, int count);

}  // namespace wisp
