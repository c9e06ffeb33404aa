#include "learn/judge/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "learn/fit/arx_errors.hpp"
#include "learn/numeric/decompositions.hpp"

namespace wisp {
namespace {

constexpr int kMaxSteps = 100000;

Result<void> check_figures(const ArxModel& model, const FigureOptions& options) {
  if (auto ok = check_steps(options.steps); !ok) return ok;
  if (options.first_sample && *options.first_sample < model.orders.history()) {
    return Error{"the first sample is " + std::to_string(*options.first_sample) + ", but the model's history is " +
                 std::to_string(model.orders.history()) + " samples"};
  }
  return {};
}

// Errors of k-step predictions for k = 1, 2, …, block by block: err_k(t) = err_{k−1}(t) + F_{k−1} e(t − k + 1).
class StepErrors {
 public:
  StepErrors(const ArxModel& model, const Signals& signals, int steps)
      : filter_(model, signals), response_(noise_response(model, steps)), steps_(steps) {}

  /// Calls visit(k, first, errors) for k = 1 … steps and every block of a run; `errors` has one column per output, and
  /// its row 0 is row `first` of the recording. Rows before run.begin + k − 1 have no k-step prediction.
  template <class Visit>
  void run(const RowRun& run, Visit visit) {
    const int ny = static_cast<int>(response_.front().rows());
    const Eigen::Index before = steps_ - 1;
    shocks_.setZero(static_cast<Eigen::Index>(kBlockRows) + before, ny);
    for (std::size_t first = run.begin; first < run.end; first += kBlockRows) {
      const auto rows = static_cast<Eigen::Index>(std::min(kBlockRows, run.end - first));
      filter_.errors({run.recording, first, first + static_cast<std::size_t>(rows)}, shocks_.middleRows(before, rows));
      sum_ = shocks_.middleRows(before, rows);
      visit(1, first, sum_);
      for (int k = 2; k <= steps_; ++k) {
        const Eigen::MatrixXd& weights = response_[k - 1];
        for (int i = 0; i < ny; ++i) {
          for (int j = 0; j < ny; ++j) {
            if (weights(i, j) != 0) sum_.col(i) += weights(i, j) * shocks_.col(j).segment(before - (k - 1), rows);
          }
        }
        visit(k, first, sum_);
      }
      if (before > 0) shocks_.topRows(before) = shocks_.middleRows(rows, before).eval();
    }
  }

 private:
  ErrorFilter filter_;
  std::vector<Eigen::MatrixXd> response_;
  int steps_;
  Eigen::MatrixXd shocks_;
  Eigen::MatrixXd sum_;
};

// Errors of predictions for one finite number of steps.
Tally steps_tally(const ArxModel& model, const Signals& signals, int steps, int first_sample) {
  Tally tally(signals.outputs);
  StepErrors errors(model, signals, steps);
  for (const RowRun& run : plan_rows(signals, layout_of(model.orders), first_sample).runs) {
    errors.run(run, [&](int k, std::size_t first, const Eigen::MatrixXd& block) {
      const std::size_t start = run.begin + static_cast<std::size_t>(k) - 1;
      const auto skip = static_cast<Eigen::Index>(start > first ? start - first : 0), rows = block.rows() - skip;
      if (k < steps || rows <= 0) return;
      tally.add_errors(block.bottomRows(rows));
      for (int i = 0; i < signals.outputs; ++i) {
        const double* measured = signals.samples[run.recording][i].data() + first + skip;
        tally.add_output(i, (Eigen::Map<const Eigen::ArrayXd>(measured, rows) - signals.offset[i]).matrix());
      }
    });
  }
  return tally;
}

std::vector<std::vector<double>> nothing_predicted(const Signals& signals) {
  const std::vector<double> series(signals.samples[0].front().size(), std::numeric_limits<double>::quiet_NaN());
  return std::vector<std::vector<double>>(signals.outputs, series);
}

std::vector<std::vector<double>> predict_steps(const ArxModel& model, const Signals& signals, int steps) {
  auto out = nothing_predicted(signals);
  StepErrors errors(model, signals, steps);
  for (const RowRun& run : plan_rows(signals, layout_of(model.orders), model.orders.history()).runs) {
    errors.run(run, [&](int k, std::size_t first, const Eigen::MatrixXd& block) {
      if (k != steps) return;
      for (int i = 0; i < signals.outputs; ++i) {
        for (Eigen::Index t = 0; t < block.rows(); ++t) {
          const std::size_t row = first + static_cast<std::size_t>(t);
          if (row + 1 >= run.begin + k) out[i][row] = signals.samples[0][i][row] - block(t, i);
        }
      }
    });
  }
  return out;
}

// Moves the rows without missing samples to the front. Returns their number.
Eigen::Index drop_missing(Eigen::Index rows, Eigen::MatrixXd& measured, Eigen::MatrixXd& errors) {
  if (!errors.topRows(rows).hasNaN()) return rows;
  Eigen::Index count = 0;
  for (Eigen::Index t = 0; t < rows; ++t) {
    if (errors.row(t).hasNaN()) continue;
    measured.row(count) = measured.row(t);
    errors.row(count) = errors.row(t);
    ++count;
  }
  return count;
}

// Maximum number of rows for estimating the initial state: a stable model has forgotten it by then.
constexpr std::size_t kRowsForInitialState = 4096;

// Outputs over time, concatenated rows: `memory` rows of the past, then the simulated ones.
using Series = std::vector<double>;

struct Tap {
  std::ptrdiff_t back;
  double weight;
};

class Runner {
 public:
  Runner(const ArxModel& model, const Signals& signals, std::size_t recording)
      : model_(model), signals_(signals), recording_(recording), feedback_(model.orders.outputs()) {
    for (int order : model.orders.na.values()) memory_ = std::max(memory_, static_cast<std::size_t>(order));
    const int ny = model.orders.outputs();
    for (int i = 0; i < ny; ++i) {
      for (int j = 0; j < ny; ++j) {
        const auto a = model.a(i, j);
        for (std::size_t l = 0; l < a.size(); ++l) {
          const auto back = static_cast<std::ptrdiff_t>(l + 1) * ny - j;
          feedback_[i].push_back({-back, -a[l]});
        }
      }
      // The latest sample comes last: the processor can add the others while the latest is still being computed.
      std::sort(feedback_[i].begin(), feedback_[i].end(), [](const Tap& a, const Tap& b) { return a.back < b.back; });
    }
  }

  std::size_t memory() const { return memory_; }

  /// Treats inputs before `row` as constant at the operating point.
  void rest_until(std::size_t row) { rest_until_ = row; }

  std::size_t outputs() const { return feedback_.size(); }

  double deviation(std::size_t channel, std::size_t row) const {
    return signals_.samples[recording_][channel][row] - signals_.offset[channel];
  }

  /// Writes the contribution of inputs and constant to rows [begin, begin + count), behind `memory()` rows of the past.
  template <class Number>
  void force(std::size_t begin, std::size_t count, Series& series) const {
    const std::size_t ny = outputs();
    series.resize((count + memory_) * ny);
    std::vector<double> part(count);
    for (std::size_t i = 0; i < ny; ++i) {
      std::fill(part.begin(), part.end(), model_.constant[i]);
      for (int k = 0; k < model_.orders.inputs(); ++k) add_input<Number>(static_cast<int>(i), k, begin, part);
      for (std::size_t t = 0; t < count; ++t) series[(t + memory_) * ny + i] = part[t];
    }
  }

  /// Adds the contribution of the outputs' own past to the rows written by force().
  template <class Number>
  void feed_back(Series& series) const {
    const std::size_t ny = outputs();
    for (double* row = series.data() + memory_ * ny; row != series.data() + series.size(); row += ny) {
      for (std::size_t i = 0; i < ny; ++i) {
        auto sum = static_cast<Number>(row[i]);
        for (const Tap& tap : feedback_[i]) sum += static_cast<Number>(tap.weight) * static_cast<Number>(row[tap.back]);
        row[i] = sum;
      }
    }
  }

  /// Whether all outputs in the model's memory before `row` are measured.
  bool past_is_measured(std::size_t row) const {
    for (std::size_t i = 0; i < outputs(); ++i) {
      for (std::size_t lag = 1; lag <= memory_; ++lag) {
        if (!std::isfinite(deviation(i, row - lag))) return false;
      }
    }
    return true;
  }

  /// Past outputs, memory × ny, that minimise the squared error of the simulation from `begin`.
  std::vector<double> estimate_past(std::size_t begin, std::size_t count) const {
    const std::size_t unknowns = memory_ * outputs();
    const std::size_t rows = std::min(count, kRowsForInitialState);
    const auto length = static_cast<Eigen::Index>(rows * outputs());
    Series base(unknowns, 0.0);
    force<double>(begin, rows, base);
    feed_back<double>(base);
    Eigen::MatrixXd response(length, unknowns);
    for (std::size_t u = 0; u < unknowns; ++u) {
      Series unit((rows + memory_) * outputs(), 0.0);
      unit[u] = 1;
      feed_back<double>(unit);
      response.col(static_cast<Eigen::Index>(u)) = Eigen::Map<const Eigen::VectorXd>(unit.data() + unknowns, length);
    }
    Eigen::VectorXd rest = Eigen::VectorXd::Zero(length);
    for (Eigen::Index r = 0; r < length; ++r) {
      const auto at = static_cast<std::size_t>(r);
      const double measured = deviation(at % outputs(), begin + at / outputs());
      if (std::isfinite(measured)) {
        rest[r] = measured - base[unknowns + at];
      } else {
        response.row(r).setZero();
      }
    }
    const Eigen::VectorXd past = ranked_solution(response, rest).x;
    return {past.begin(), past.end()};
  }

 private:
  template <class Number>
  void add_input(int output, int input, std::size_t begin, std::vector<double>& part) const {
    const auto channel = static_cast<std::size_t>(signals_.outputs + input);
    const double* samples = signals_.samples[recording_][channel].data();
    const double offset = signals_.offset[channel];
    const auto b = model_.b(output, input);
    for (std::size_t l = 0; l < b.size(); ++l) {
      const std::size_t lag = l + static_cast<std::size_t>(model_.orders.nk(output, input));
      const std::size_t rest = rest_until_ + lag > begin ? rest_until_ + lag - begin : 0;
      const auto weight = static_cast<Number>(b[l]);
      for (std::size_t t = rest; t < part.size(); ++t) {
        part[t] = static_cast<Number>(part[t]) + weight * static_cast<Number>(samples[begin + t - lag] - offset);
      }
    }
  }

  const ArxModel& model_;
  const Signals& signals_;
  std::size_t recording_, rest_until_ = 0;
  std::size_t memory_ = 0;
  std::vector<std::vector<Tap>> feedback_;  // per output
};

// First row from `begin` on at which a simulation may start; `end` where there is none.
std::size_t first_row(const Runner& runner, std::size_t begin, std::size_t end, InitialState initial) {
  if (initial != InitialState::kMeasured) return begin;
  while (begin < end && !runner.past_is_measured(begin)) ++begin;
  return begin;
}

// Returns the first row of a simulation from rest: `first_sample` rows before `run`, in general the episode's first
// row, or the run's first row where an input is missing between.
std::size_t rested_begin(const Signals& signals, const RowRun& run, int first_sample) {
  std::size_t begin = run.begin;
  const auto present = [&](std::size_t row) {
    for (int c = signals.outputs; c < signals.channels(); ++c)
      if (!std::isfinite(signals.samples[run.recording][c][row])) return false;
    return true;
  };
  const auto back = static_cast<std::size_t>(first_sample);
  for (std::size_t k = 0; k < back && begin > 0 && present(begin - 1); ++k) --begin;
  return run.begin - begin == back ? begin : run.begin;
}

template <class Number>
void simulate_stretch(const Runner& runner, const RowRun& run, InitialState initial, const SimulatedRows& visit) {
  const std::size_t begin = first_row(runner, run.begin, run.end, initial);
  if (begin == run.end) return;
  const std::size_t past = runner.memory() * runner.outputs();
  Series series(past, 0.0);
  if (initial == InitialState::kMeasured) {
    for (std::size_t k = 0; k < past; ++k) {
      series[k] = runner.deviation(k % runner.outputs(), begin - runner.memory() + k / runner.outputs());
    }
  } else if (initial == InitialState::kEstimated && past > 0) {
    series = runner.estimate_past(begin, run.end - begin);
  }
  for (std::size_t first = begin; first < run.end; first += kBlockRows) {
    const std::size_t rows = std::min(kBlockRows, run.end - first);
    runner.force<Number>(first, rows, series);
    runner.feed_back<Number>(series);
    visit(first, rows, series.data() + past);
    std::copy(series.end() - static_cast<std::ptrdiff_t>(past), series.end(), series.begin());
  }
}

}  // namespace

Result<std::vector<std::vector<double>>> predict(const ArxModel& model, const Recording& recording,
                                                 const ChannelChoice& channels, const PredictOptions& options) {
  if (auto ok = check_steps({&options.steps, 1}); !ok) return ok.error();
  const auto signals = signals_of_model(model, {&recording, 1}, channels);
  if (!signals) return signals.error();
  if (options.steps != kFreeRun) return predict_steps(model, *signals, options.steps);
  auto out = nothing_predicted(*signals);
  free_run(model, *signals, 0, {options.initial, model.orders.history()},
           [&](std::size_t first, std::size_t rows, const double* values) {
             for (std::size_t t = first; t < first + rows; ++t) {
               for (int i = 0; i < signals->outputs; ++i) out[i][t] = *values++ + model.output_mean[i];
             }
           });
  return out;
}

Result<std::vector<PredictionFigures>> prediction_figures(const ArxModel& model, std::span<const Recording> recordings,
                                                          const ChannelChoice& channels, const FigureOptions& options) {
  const auto signals = signals_of_model(model, recordings, channels);
  if (!signals) return signals.error();
  return figures_of(model, *signals, options);
}

Result<std::vector<PredictionFigures>> figures_of(const ArxModel& model, const Signals& signals,
                                                  const FigureOptions& options) {
  if (auto ok = check_figures(model, options); !ok) return ok.error();
  const int first_sample = options.first_sample.value_or(model.orders.history());
  std::vector<PredictionFigures> out;
  for (int steps : options.steps) {
    const Tally tally = steps == kFreeRun ? free_run_tally(model, signals, {options.initial, first_sample})
                                          : steps_tally(model, signals, steps, first_sample);
    if (tally.rows() == 0) {
      return Error{"no row can be predicted: no stretch without gaps is longer than the model's history of " +
                   std::to_string(model.orders.history()) + " samples" +
                   (steps > 1 ? " and " + std::to_string(steps) + " steps" : "")};
    }
    out.push_back(tally.figures(steps));
  }
  return out;
}

Result<void> check_steps(std::span<const int> all) {
  if (all.empty()) return Error{"no number of steps was requested"};
  for (int steps : all) {
    if (steps == kFreeRun || (steps >= 1 && steps <= kMaxSteps)) continue;
    return Error{"predictions were requested " + std::to_string(steps) + " steps ahead, expected 1 to 100000, or free"};
  }
  return {};
}

std::vector<std::vector<double>> prediction_sd(const ArxModel& model, int steps) {
  const int ny = model.orders.outputs();
  const Eigen::Map<const Eigen::VectorXd> noise(model.noise.sd.data(), ny);
  std::vector<std::vector<double>> sd(ny);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(ny);
  for (const Eigen::MatrixXd& weights : noise_response(model, steps)) {
    variance += (weights * noise.asDiagonal()).rowwise().squaredNorm();
    for (int i = 0; i < ny; ++i) sd[i].push_back(std::sqrt(variance[i]));
  }
  return sd;
}

void Tally::add_errors(const Eigen::Ref<const Eigen::MatrixXd>& errors) {
  rows_ += static_cast<std::size_t>(errors.rows());
  for (std::size_t i = 0; i < square_.size(); ++i) {
    const auto column = errors.col(static_cast<Eigen::Index>(i));
    square_[i] += column.squaredNorm();
    size_[i] += column.cwiseAbs().sum();
  }
}

void Tally::add_output(int i, const Eigen::Ref<const Eigen::VectorXd>& deviations) {
  y_[i] += deviations.sum();
  y_square_[i] += deviations.squaredNorm();
}

PredictionFigures Tally::figures(int steps) const {
  PredictionFigures out;
  out.steps = steps;
  out.rows = rows_;
  const double n = static_cast<double>(rows_);
  for (std::size_t i = 0; i < square_.size(); ++i) {
    out.mean_square.push_back(square_[i] / n);
    const double variance = y_square_[i] / n - (y_[i] / n) * (y_[i] / n);
    out.fit_percent.push_back(variance > 1e-13 * y_square_[i] / n ? 100 * (1 - std::sqrt(out.mean_square[i] / variance))
                                                                  : 0);
  }
  for (double sum : size_) out.j.push_back(sum / n);
  return out;
}

void Tally::add_simulated(const Signals& signals, std::size_t recording, std::size_t first, std::size_t rows,
                          const double* values) {
  const auto count = static_cast<Eigen::Index>(rows);
  const Eigen::Map<const Eigen::MatrixXd> simulated(values, signals.outputs, count);
  Eigen::MatrixXd measured(count, signals.outputs);
  for (int i = 0; i < signals.outputs; ++i) {
    const double* samples = signals.samples[recording][i].data() + first;
    measured.col(i) = Eigen::Map<const Eigen::VectorXd>(samples, count).array() - signals.offset[i];
  }
  Eigen::MatrixXd errors = measured - simulated.transpose();
  const Eigen::Index whole = drop_missing(count, measured, errors);
  add_errors(errors.topRows(whole));
  for (int i = 0; i < signals.outputs; ++i) add_output(i, measured.col(i).head(whole));
}

Tally free_run_tally(const ArxModel& model, const Signals& signals, const FreeRunStart& start) {
  Tally tally(signals.outputs);
  for (std::size_t r = 0; r < signals.samples.size(); ++r) {
    free_run(model, signals, r, start, [&](std::size_t first, std::size_t rows, const double* values) {
      tally.add_simulated(signals, r, first, rows, values);
    });
  }
  return tally;
}

void free_run(const ArxModel& model, const Signals& signals, std::size_t recording, const FreeRunStart& start,
              const SimulatedRows& visit) {
  Runner runner(model, signals, recording);
  std::vector<double> played;
  // Play adds the operating point in single precision.
  const auto rounded = [&](std::size_t first, std::size_t rows, const double* values) {
    played.assign(values, values + rows * runner.outputs());
    for (std::size_t k = 0; k < played.size(); ++k) {
      const double mean = model.output_mean[k % runner.outputs()];
      played[k] = static_cast<double>(static_cast<float>(played[k] + mean)) - mean;
    }
    visit(first, rows, played.data());
  };
  for (RowRun run : plan_input_rows(signals, recording, layout_of(model.orders), start.first_sample).runs) {
    if (start.initial == InitialState::kZero) run.begin = rested_begin(signals, run, start.first_sample);
    runner.rest_until(start.initial == InitialState::kZero ? run.begin : 0);
    if (start.as_played) {
      simulate_stretch<float>(runner, run, start.initial, rounded);
    } else {
      simulate_stretch<double>(runner, run, start.initial, visit);
    }
  }
}

}  // namespace wisp
