#include "learn/arx/fit/triangular_factor.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "learn/arx/fit/arx_check.hpp"
#include "learn/arx/fit/arx_estimate.hpp"
#include "learn/arx/fit/arx_report.hpp"
#include "learn/arx/rows/arx_design.hpp"
#include "learn/arx/rows/arx_rows.hpp"
#include "learn/arx/rows/lag_gram.hpp"

namespace wisp {
namespace {

// What is taken into memory of a table at a time.
constexpr std::size_t kRowsAtATime = 65536;

void widen(double lowest, double highest, bool first, ChannelSpan& span) {
  span.lowest = first ? lowest : std::min(span.lowest, lowest);
  span.highest = first ? highest : std::max(span.highest, highest);
}

// Sums over the samples that a part owns, about its reference, and their range.
void add_samples(const Signals& signals, const RowPart& part, FactorState& state) {
  for (int c = 0; c < signals.channels(); ++c) {
    const auto samples = signals.samples[0][c];
    for (std::size_t begin = part.begin; begin < part.end; begin += kBlockRows) {
      double sum = 0;
      double square = 0;
      for (std::size_t t = begin; t < std::min(part.end, begin + kBlockRows); ++t) {
        if (std::isnan(samples[t])) continue;
        widen(samples[t], samples[t], state.samples[c] == 0, state.spans[c]);
        const double deviation = samples[t] - state.reference[c];
        sum += deviation;
        square += deviation * deviation;
        ++state.samples[c];
      }
      state.sum[c] += sum;
      state.square[c] += square;
    }
  }
}

// The reference is near the mean, so that little is lost when means are taken off later.
double reference_of(std::span<const double> samples) {
  double sum = 0;
  std::size_t count = 0;
  for (double sample : samples) {
    if (std::isnan(sample)) continue;
    sum += sample;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

// (x − from)·1 becomes (x − to)·scale: columns change by a multiple of the constant's.
void shift_columns(const LagLayout& layout, const std::vector<double>& shift, const std::vector<double>& scale,
                   Eigen::MatrixXd& triangle) {
  for (int p = 1; p < layout.size(); ++p) {
    const int channel = layout[p].channel;
    triangle.col(p) = (triangle.col(p) + shift[channel] * triangle.col(0)) * scale[channel];
  }
}

// Operating point and scales, as gather_signals finds them.
FitFacts facts_of(const FactorState& state, const ArxOptions& options) {
  FitFacts facts;
  facts.options = options;
  facts.options.orders = state.options.orders;
  facts.outputs = static_cast<int>(state.options.channels.outputs.size());
  facts.names = state.options.channels.outputs;
  facts.names.insert(facts.names.end(), state.options.channels.inputs.begin(), state.options.channels.inputs.end());
  for (std::size_t c = 0; c < facts.names.size(); ++c) {
    const ChannelPoint point =
        operating_point({state.sum[c], state.square[c], static_cast<std::size_t>(state.samples[c])}, state.reference[c],
                        options.offset);
    facts.offset.push_back(point.offset);
    facts.scale.push_back(point.scale);
  }
  facts.rows = state.rows;
  facts.first_sample = state.first_sample();
  facts.episodes_used = state.episodes_used;
  facts.episodes_skipped = state.episodes_skipped;
  facts.rows_left_out = state.rows_left_out;
  return facts;
}

}  // namespace

PartRows part_rows(std::size_t rows, std::size_t index, std::size_t count) {
  const std::size_t each = rows / count;
  const std::size_t longer = rows % count;
  const auto start = [&](std::size_t k) { return k * each + std::min(k, longer); };
  return {start(index), start(index + 1)};
}

Result<TriangularFactor> TriangularFactor::create(const FactorOptions& options) {
  if (auto ok = check_factor_options(options); !ok) return ok.error();
  return TriangularFactor(FactorState(options));
}

namespace {

Result<void> add_part(const Recording& recording, const RowPart& part, FactorState& state) {
  auto signals = find_signals({&recording, 1}, state.options.channels);
  if (!signals) return signals.error();
  if (state.rate_hz != 0 && std::abs(recording.rate_hz - state.rate_hz) > 1e-6 * state.rate_hz) {
    return Error{"a part has " + std::to_string(recording.rate_hz) + " samples a second, the others " +
                 std::to_string(state.rate_hz) + "; one fit needs one rate"};
  }
  state.rate_hz = recording.rate_hz;
  for (int c = 0; c < signals->channels(); ++c) {
    const auto samples = signals->samples[0][c].subspan(part.begin, part.end - part.begin);
    if (std::any_of(samples.begin(), samples.end(), [](double sample) { return std::isinf(sample); })) {
      return Error{"channel '" + signals->names[c] + "' holds an infinite sample"};
    }
    if (std::isnan(state.reference[c])) state.reference[c] = reference_of(samples);
    if (state.spans[c].unit.empty()) {
      state.spans[c].unit = recording.channels[*find_channel(recording, signals->names[c])].unit;
    }
    signals->offset[c] = std::isnan(state.reference[c]) ? 0.0 : state.reference[c];
  }
  add_samples(*signals, part, state);
  const RowPlan plan = plan_part(*signals, state.design.layout, state.first_sample(), part);
  if (plan.rows > 0) reduce_rows(state.triangle, triangle_by_qr(*signals, plan, state.design.layout));
  state.rows += plan.rows;
  state.episodes_used += plan.episodes_used;
  state.episodes_skipped += plan.episodes_skipped;
  state.rows_left_out += plan.rows_left_out;
  return {};
}

}  // namespace

Result<void> TriangularFactor::add(const Recording& recording, const PartRows& rows) {
  const std::size_t end = std::min(rows.end, recording.rows());
  return add_part(recording, {std::min(rows.begin, end), end, end == recording.rows()}, state_);
}

Result<void> TriangularFactor::add(CsvReader& reader, const PartRows& rows, std::size_t table_rows) {
  // One row more than the history, so that an episode that goes on is never taken for one that is too short.
  const auto kept = static_cast<std::size_t>(state_.first_sample()) + 1;
  const std::size_t end = std::min(rows.end, table_rows);
  const std::size_t begin = std::min(rows.begin, end);
  const std::size_t before = std::min(kept, begin);
  Recording window = reader.header();
  if (const auto passed = reader.skip(begin - before); !passed) return passed.error();
  if (const auto history = reader.read(window, before); !history) return history.error();
  for (std::size_t at = begin;;) {
    const std::size_t known = window.rows();
    const auto read = reader.read(window, std::min(kRowsAtATime, end - at));
    if (!read) return read.error();
    at += *read;
    const bool over = *read == 0;
    const bool last = over && (at < end || end == table_rows);
    if (auto ok = add_part(window, {known, window.rows(), last}, state_); !ok) return ok;
    if (over) return {};
    window = slice(window, window.rows() - std::min(kept, window.rows()), window.rows());
  }
}

Result<void> TriangularFactor::merge(const TriangularFactor& other) {
  if (auto ok = check_same_model(state_, other.state_); !ok) return ok;
  FactorState& state = state_;
  const FactorState& more = other.state_;
  std::vector<double> shift;
  for (std::size_t c = 0; c < state.reference.size(); ++c) {
    if (std::isnan(state.reference[c])) state.reference[c] = more.reference[c];
    const double apart = std::isnan(more.reference[c]) ? 0.0 : more.reference[c] - state.reference[c];
    const double count = static_cast<double>(more.samples[c]);
    shift.push_back(apart);
    if (more.samples[c] > 0) {
      widen(more.spans[c].lowest, more.spans[c].highest, state.samples[c] == 0, state.spans[c]);
    }
    if (state.spans[c].unit.empty()) state.spans[c].unit = more.spans[c].unit;
    state.square[c] += more.square[c] + 2 * apart * more.sum[c] + apart * apart * count;
    state.sum[c] += more.sum[c] + apart * count;
    state.samples[c] += more.samples[c];
  }
  Eigen::MatrixXd triangle = more.triangle;
  shift_columns(state.design.layout, shift, std::vector<double>(shift.size(), 1.0), triangle);
  reduce_rows(state.triangle, triangle);
  if (state.rate_hz == 0) state.rate_hz = more.rate_hz;
  state.rows += more.rows;
  state.episodes_used += more.episodes_used;
  state.episodes_skipped += more.episodes_skipped;
  state.rows_left_out += more.rows_left_out;
  return {};
}

Result<ArxFit> TriangularFactor::finish(const ArxOptions& options) const {
  ArxOptions own = options;
  own.orders = state_.options.orders;
  if (auto ok = check_options(own, state_.options.channels); !ok) return ok.error();
  const ArxDesign design = make_design(own.orders, own.offset, own.kernel != ArxKernel::kNone);
  RowPlan plan;
  plan.rows = state_.rows;
  plan.first_sample = state_.first_sample();
  if (auto ok = check_rows(plan, design); !ok) return ok.error();
  for (std::size_t c = 0; c < state_.samples.size(); ++c) {
    if (state_.samples[c] > 0) continue;
    const ChannelChoice& names = state_.options.channels;
    const std::size_t outputs = names.outputs.size();
    return Error{"channel '" + (c < outputs ? names.outputs[c] : names.inputs[c - outputs]) +
                 "' has no sample that is not missing"};
  }
  const FitFacts facts = facts_of(state_, own);
  std::vector<double> shift;
  for (std::size_t c = 0; c < facts.offset.size(); ++c) shift.push_back(state_.reference[c] - facts.offset[c]);
  Eigen::MatrixXd triangle = state_.triangle;
  shift_columns(design.layout, shift, facts.scale, triangle);
  ArxFit fit =
      report_fit(facts, design, estimate_from_triangle(triangle, facts.scale, design, {own.covariance, own.kernel}));
  judge_fit(facts, fit.summary);
  return fit;
}

}  // namespace wisp
