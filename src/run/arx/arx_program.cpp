#include "run/arx/arx_program.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "run/bank/model_hash.hpp"

namespace wisp {
namespace {

constexpr double kMostSum = 1e30;  // far below the largest float, so that no sum overflows

float kept(double value) { return std::abs(value) < kLeastCoefficient ? 0.0f : static_cast<float>(value); }

double output_scale(const Model& model, int i) {
  return channel_scale(model.outputs[i].lowest, model.outputs[i].highest);
}

// Calls tap(row, channel, lag, coefficient) for every coefficient that is not zero, in the order of adding.
template <class Tap>
void for_each_tap(const Model& model, const ArxModel& arx, Tap tap) {
  const int ny = arx.orders.outputs();
  for (int i = 0; i < ny; ++i) {
    const double unit = output_scale(model, i);
    for (int j = 0; j < ny; ++j) {
      const double factor = -output_scale(model, j) / unit;
      std::uint32_t lag = 1;
      for (double a : arx.a(i, j)) {
        if (const float coefficient = kept(a * factor); coefficient != 0) tap(i, j, lag, coefficient);
        ++lag;
      }
    }
    for (int k = 0; k < arx.orders.inputs(); ++k) {
      const double factor = regressor_scale(model, k) / unit;
      auto lag = static_cast<std::uint32_t>(arx.orders.nk(i, k));
      for (double b : arx.b(i, k)) {
        if (const float coefficient = kept(b * factor); coefficient != 0) tap(i, ny + k, lag, coefficient);
        ++lag;
      }
    }
  }
}

// Where the next tap would continue a run.
struct RunEnd {
  int row = -1;
  int channel = -1;
  std::uint32_t lag = 0;

  bool continued_by(int next_row, int next_channel, std::uint32_t next_lag) const {
    return row == next_row && channel == next_channel && lag == next_lag;
  }
};

struct TapCount {
  std::size_t runs = 0;
  std::size_t coefficients = 0;
};

TapCount count_taps(const Model& model, const ArxModel& arx) {
  TapCount count;
  RunEnd end;
  for_each_tap(model, arx, [&](int row, int channel, std::uint32_t lag, float) {
    if (!end.continued_by(row, channel, lag)) ++count.runs;
    ++count.coefficients;
    end = {row, channel, lag + 1};
  });
  return count;
}

void fill_taps(const Model& model, const ArxModel& arx, ArxProgram& program) {
  std::uint32_t runs = 0, coefficients = 0;
  RunEnd end;
  std::fill(program.row_end.begin(), program.row_end.end(), 0U);
  for_each_tap(model, arx, [&](int row, int channel, std::uint32_t lag, float coefficient) {
    if (!end.continued_by(row, channel, lag)) {
      program.runs[runs++] = {static_cast<std::uint32_t>(channel), lag, 0, coefficients};
    }
    ++program.runs[runs - 1].count;
    program.coefficients[coefficients++] = coefficient;
    program.row_end[row] = runs;
    end = {row, channel, lag + 1};
  });
  for (std::size_t row = 1; row < program.row_end.size(); ++row) {
    program.row_end[row] = std::max(program.row_end[row], program.row_end[row - 1]);
  }
}

std::span<const TapRun> runs_of(const ArxProgram& program, int row) {
  const std::uint32_t begin = row == 0 ? 0 : program.row_end[row - 1];
  return program.runs.subspan(begin, program.row_end[row] - begin);
}

// Whether output b looks back at nothing but itself and the regressors, as a does at itself and at their opposites.
bool taps_mirror(const ArxProgram& program, int a, int b) {
  const auto ours = runs_of(program, a), theirs = runs_of(program, b);
  const auto mirrors = [&](const TapRun& x, const TapRun& y) {
    const bool own = x.channel == static_cast<std::uint32_t>(a) && y.channel == static_cast<std::uint32_t>(b);
    const bool common = x.channel == y.channel && x.channel >= static_cast<std::uint32_t>(program.outputs);
    if (!(own || common) || x.first_lag != y.first_lag || x.count != y.count) return false;
    for (std::uint32_t k = 0; k < x.count; ++k) {
      const float opposite = program.coefficients[y.coefficient + k];
      if (program.coefficients[x.coefficient + k] != (own ? opposite : -opposite)) return false;
    }
    return true;
  };
  return std::equal(ours.begin(), ours.end(), theirs.begin(), theirs.end(), mirrors);
}

bool noise_mirrors(const ArxProgram& program, int a, int b) {
  if (!program.drawn.empty()) return residuals_mirror(program.drawn, a, b);
  bool opposite = program.sd[a] == 0 && program.sd[b] == 0;
  for (int r = 0; r < program.rank; ++r) {
    opposite &= program.mixing[a * program.rank + r] == -program.mixing[b * program.rank + r];
  }
  return opposite;
}

bool ranges_mirror(const OutputChannel& a, const OutputChannel& b) {
  return a.scale == b.scale && a.mean == -b.mean && a.low == -b.high && a.high == -b.low && a.lowest == -b.highest &&
         a.highest == -b.lowest && a.start == -b.start;
}

}  // namespace

ArxProgram make_arx_program(const Model& model, const ArxModel& arx, Arena& arena) {
  ArxProgram program;
  program.outputs = arx.orders.outputs();
  program.regressors = arx.orders.inputs();
  program.drawn = make_drawn_program(model, arx, arena);
  program.depth = std::max(arx.orders.history() + 1, 2);
  if (program.drawn.driven()) program.depth = std::max(program.depth, program.drawn.trend_steps + 1);
  program.rank = arx.noise.rank;
  const TapCount count = count_taps(model, arx);
  const auto ny = static_cast<std::size_t>(program.outputs);
  program.runs = arena.take<TapRun>(count.runs);
  program.row_end = arena.take<std::uint32_t>(ny);
  program.coefficients = arena.take<float>(count.coefficients);
  program.constant = arena.take<float>(ny);
  program.sd = arena.take<float>(ny);
  program.mixing = arena.take<float>(ny * program.rank);
  if (arena.measures()) return program;
  fill_taps(model, arx, program);
  for (int i = 0; i < program.outputs; ++i) {
    const double unit = output_scale(model, i);
    program.constant[i] = kept(arx.constant[i] / unit);
    program.sd[i] = kept(arx.noise.sd[i] / unit);
    for (int r = 0; r < program.rank; ++r) {
      program.mixing[i * program.rank + r] = kept(arx.noise.mixing[i * program.rank + r] / unit);
    }
  }
  return program;
}

void mark_mirrored(const ArxProgram& program, std::span<OutputChannel> outputs) {
  for (int b = 0; b < program.outputs; ++b) {
    for (int a = 0; a < b && outputs[b].mirrors < 0; ++a) {
      const bool opposite = outputs[a].mirrors < 0 && ranges_mirror(outputs[a], outputs[b]) &&
                            program.constant[a] == -program.constant[b] && taps_mirror(program, a, b) &&
                            noise_mirrors(program, a, b);
      if (opposite) outputs[b].mirrors = a;
    }
  }
}

std::uint64_t hash_of(const ArxProgram& program, std::uint64_t before) {
  std::uint64_t hash = hash_number(static_cast<std::uint32_t>(program.depth), before);
  for (const TapRun& run : program.runs) {
    for (std::uint32_t number : {run.channel, run.first_lag, run.count}) hash = hash_number(number, hash);
  }
  for (std::uint32_t end : program.row_end) hash = hash_number(end, hash);
  for (const auto numbers : {program.coefficients, program.constant, program.sd, program.mixing}) {
    hash = hash_floats(numbers, hash);
  }
  return hash_of(program.drawn, hash);
}

Result<void> check_arx_program(const Model& model, const ArxModel& arx) {
  double sum = 0;
  for_each_tap(model, arx, [&](int, int, std::uint32_t, float coefficient) { sum += std::abs(coefficient); });
  for (int i = 0; i < arx.orders.outputs(); ++i) {
    const double unit = output_scale(model, i);
    sum += std::abs(arx.constant[i]) / unit + arx.noise.sd[i] / unit;
  }
  for (double share : arx.noise.mixing) sum += std::abs(share);
  if (sum < kMostSum) return {};
  return Error{"the ARX coefficients add up to " + std::to_string(sum) +
               " in units of the channels' ranges, expected less than 1e30: learn the model again"};
}

}  // namespace wisp
