#include "learn/arx/judge/free_run.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "learn/arx/fit/arx_errors.hpp"
#include "learn/numeric/decompositions.hpp"

namespace wisp {
namespace {

// The initial state is estimated over at most so many rows: a stable model has forgotten it long before.
constexpr std::size_t kRowsForInitialState = 4096;

// Outputs over time, row after row: `memory` rows of the past, then the simulated ones.
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
      // The latest sample last: it is the one that the processor has to wait for.
      std::sort(feedback_[i].begin(), feedback_[i].end(), [](const Tap& a, const Tap& b) { return a.back < b.back; });
    }
  }

  std::size_t memory() const { return memory_; }
  std::size_t outputs() const { return feedback_.size(); }

  double deviation(std::size_t channel, std::size_t row) const {
    return signals_.samples[recording_][channel][row] - signals_.offset[channel];
  }

  /// Writes the inputs' and the constant's part of rows [begin, begin + count) below the first `memory()` rows.
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

  /// Adds the outputs' own past to rows that hold the forced part.
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

  /// Whether the outputs before `row` that the model remembers are all measured.
  bool past_is_measured(std::size_t row) const {
    for (std::size_t i = 0; i < outputs(); ++i) {
      for (std::size_t lag = 1; lag <= memory_; ++lag) {
        if (!std::isfinite(deviation(i, row - lag))) return false;
      }
    }
    return true;
  }

  /// The past outputs, memory × ny, with which the simulation from `begin` fits best by least squares.
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
    const Eigen::VectorXd past = shortest_solution(response, rest);
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
      const double* shifted = samples + begin - l - static_cast<std::size_t>(model_.orders.nk(output, input));
      const auto weight = static_cast<Number>(b[l]);
      for (std::size_t t = 0; t < part.size(); ++t) {
        part[t] = static_cast<Number>(part[t]) + weight * static_cast<Number>(shifted[t] - offset);
      }
    }
  }

  const ArxModel& model_;
  const Signals& signals_;
  std::size_t recording_;
  std::size_t memory_ = 0;
  std::vector<std::vector<Tap>> feedback_;  // per output
};

// Where a simulation that reaches `end` may start, or `end`.
std::size_t first_row(const Runner& runner, std::size_t begin, std::size_t end, InitialState initial) {
  if (initial != InitialState::kMeasured) return begin;
  while (begin < end && !runner.past_is_measured(begin)) ++begin;
  return begin;
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

void free_run(const ArxModel& model, const Signals& signals, std::size_t recording, const FreeRunStart& start,
              const SimulatedRows& visit) {
  const Runner runner(model, signals, recording);
  const LagLayout layout = layout_of_model(model);
  for (const RowRun& run : plan_input_rows(signals, layout, start.first_sample).runs) {
    if (run.recording != recording) continue;
    (start.as_played ? simulate_stretch<float> : simulate_stretch<double>)(runner, run, start.initial, visit);
  }
}

}  // namespace wisp
