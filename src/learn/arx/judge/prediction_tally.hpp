#pragma once
// Sums of prediction errors, and the figures that are made of them.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "learn/arx/judge/free_run.hpp"
#include "learn/arx/judge/prediction.hpp"
#include "learn/arx/rows/arx_rows.hpp"

namespace wisp {

/// Sums over the rows for one number of steps.
class Tally {
 public:
  /// `group`: consecutive outputs whose error is one vector.
  explicit Tally(int outputs, int group = 1)
      : group_(group), square_(outputs), y_(outputs), y_square_(outputs), norm_(outputs / group) {}

  std::size_t rows() const { return rows_; }

  /// One column an output, one row a time; none may be NaN.
  void add_errors(const Eigen::Ref<const Eigen::MatrixXd>& errors);

  /// Adds measured deviations of output i.
  void add_output(int i, const Eigen::Ref<const Eigen::VectorXd>& deviations);

  /// Adds the errors of simulated rows [first, first + rows) of a recording: `values` are the simulated deviations, row
  /// after row. Rows where an output was not measured do not count.
  void add_simulated(const Signals& signals, std::size_t recording, std::size_t first, std::size_t rows,
                     const double* values);

  PredictionFigures figures(int steps) const;

 private:
  int group_;
  std::size_t rows_ = 0;
  std::vector<double> square_;
  std::vector<double> y_;
  std::vector<double> y_square_;
  std::vector<double> norm_;
};

/// Free simulation over all recordings against what was measured, from row `first_sample` of every episode on.
///
/// Preconditions: the signals' offsets are the model's operating point; first_sample >= the model's history.
Tally free_run_tally(const ArxModel& model, const Signals& signals, const FreeRunStart& start);

/// What prediction_figures computes.
Result<std::vector<PredictionFigures>> figures_of(const ArxModel& model, const Signals& signals,
                                                  const FigureOptions& options);

}  // namespace wisp
