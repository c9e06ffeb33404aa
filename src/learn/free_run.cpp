#include "free_run.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "arx_errors.hpp"

namespace wisp {
namespace {

// The initial state is estimated over at most so many rows: a stable model has forgotten it long before.
constexpr std::size_t kRowsForInitialState = 4096;

// A matrix of outputs over time: `history` rows of the past, then the simulated ones.
using Series = Eigen::MatrixXd;

class Runner {
 public:
  Runner(const ArxModel& model, const Signals& signals, std::size_t recording)
      : model_(model), signals_(signals), recording_(recording), history_(model.orders.history()) {
    for (int order : model.orders.na.values()) memory_ = std::max(memory_, order);
  }

  int history() const { return history_; }
  int memory() const { return memory_; }

  double deviation(int channel, std::size_t row) const {
    return signals_.samples[recording_][channel][row] - signals_.offset[channel];
  }

  /// The inputs' and the constant's part of rows [begin, begin + count), below `memory()` rows of zeros.
  Series forced(std::size_t begin, std::size_t count) const {
    Series series = Series::Zero(static_cast<Eigen::Index>(count) + memory_, model_.orders.outputs());
    for (int i = 0; i < model_.orders.outputs(); ++i) {
      auto part = series.col(i).tail(static_cast<Eigen::Index>(count));
      part.setConstant(model_.constant[i]);
      for (int k = 0; k < model_.orders.inputs(); ++k) {
        const auto b = model_.b(i, k);
        for (std::size_t l = 0; l < b.size(); ++l) {
          const std::size_t lag = l + static_cast<std::size_t>(model_.orders.nk(i, k));
          for (std::size_t t = 0; t < count; ++t) {
            part[static_cast<Eigen::Index>(t)] += b[l] * deviation(signals_.outputs + k, begin + t - lag);
          }
        }
      }
    }
    return series;
  }

  /// Adds the outputs' own past to rows that hold the forced part.
  void feed_back(Series& series) const {
    const int ny = model_.orders.outputs();
    for (Eigen::Index t = memory_; t < series.rows(); ++t) {
      for (int i = 0; i < ny; ++i) {
        double sum = series(t, i);
        for (int j = 0; j < ny; ++j) {
          const auto a = model_.a(i, j);
          const double* past = &series(t, j);
          for (std::size_t l = 0; l < a.size(); ++l) sum -= a[l] * past[-static_cast<std::ptrdiff_t>(l) - 1];
        }
        series(t, i) = sum;
      }
    }
  }

  /// Whether the outputs before `row` that the model remembers are all measured.
  bool past_is_measured(std::size_t row) const {
    for (int i = 0; i < model_.orders.outputs(); ++i) {
      for (int lag = 1; lag <= memory_; ++lag) {
        if (!std::isfinite(deviation(i, row - lag))) return false;
      }
    }
    return true;
  }

  /// The past outputs (memory × ny) with which the simulation from `begin` fits best, by least squares.
  Series estimate_past(std::size_t begin, std::size_t count) const {
    const int ny = model_.orders.outputs();
    const Eigen::Index unknowns = static_cast<Eigen::Index>(memory_) * ny;
    const auto rows = static_cast<Eigen::Index>(std::min(count, kRowsForInitialState));
    Series base = forced(begin, static_cast<std::size_t>(rows));
    feed_back(base);
    Eigen::MatrixXd response(rows * ny, unknowns);
    for (Eigen::Index u = 0; u < unknowns; ++u) {
      Series unit = Series::Zero(rows + memory_, ny);
      unit(u % memory_, u / memory_) = 1;
      feed_back(unit);
      response.col(u) = unit.bottomRows(rows).reshaped();
    }
    Eigen::VectorXd rest(rows * ny);
    for (Eigen::Index r = 0; r < rows * ny; ++r) {
      const double measured = deviation(static_cast<int>(r / rows), begin + static_cast<std::size_t>(r % rows));
      rest[r] = measured - base.bottomRows(rows).reshaped()[r];
      if (std::isfinite(rest[r])) continue;
      rest[r] = 0;
      response.row(r).setZero();
    }
    const Eigen::VectorXd past = response.completeOrthogonalDecomposition().solve(rest);
    return past.reshaped(memory_, ny);
  }

 private:
  const ArxModel& model_;
  const Signals& signals_;
  std::size_t recording_;
  int history_;
  int memory_ = 0;
};

// Where a simulation that reaches `end` may start, or `end`.
std::size_t first_row(const Runner& runner, std::size_t begin, std::size_t end, InitialState initial) {
  if (initial != InitialState::kMeasured) return begin;
  while (begin < end && !runner.past_is_measured(begin)) ++begin;
  return begin;
}

void simulate_stretch(const Runner& runner, std::size_t begin, std::size_t end, InitialState initial,
                      std::vector<std::vector<double>>& out) {
  begin = first_row(runner, begin, end, initial);
  if (begin >= end) return;
  Series series = runner.forced(begin, end - begin);
  if (initial == InitialState::kMeasured) {
    for (Eigen::Index lag = 1; lag <= runner.memory(); ++lag) {
      for (Eigen::Index i = 0; i < series.cols(); ++i) {
        series(runner.memory() - lag, i) = runner.deviation(static_cast<int>(i), begin - static_cast<std::size_t>(lag));
      }
    }
  } else if (initial == InitialState::kEstimated && runner.memory() > 0) {
    series.topRows(runner.memory()) = runner.estimate_past(begin, end - begin);
  }
  runner.feed_back(series);
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (std::size_t t = begin; t < end; ++t) {
      out[i][t] = series(static_cast<Eigen::Index>(t - begin) + runner.memory(), static_cast<Eigen::Index>(i));
    }
  }
}

}  // namespace

std::vector<std::vector<double>> free_run(const ArxModel& model, const Signals& signals, std::size_t recording,
                                          InitialState initial) {
  const Runner runner(model, signals, recording);
  const std::size_t rows = signals.samples[recording].front().size();
  std::vector<std::vector<double>> out(signals.outputs,
                                       std::vector<double>(rows, std::numeric_limits<double>::quiet_NaN()));
  auto lags = lags_of_model(model);
  for (int i = 0; i < signals.outputs; ++i) lags[i].clear();
  Signals inputs_matter = signals;
  inputs_matter.samples = {signals.samples[recording]};
  inputs_matter.episodes = {signals.episodes[recording]};
  for (const RowRun& run : plan_rows(inputs_matter, lags, model.orders.history()).runs) {
    simulate_stretch(runner, run.begin, run.end, initial, out);
  }
  return out;
}

}  // namespace wisp
