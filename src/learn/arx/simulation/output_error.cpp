#include "learn/arx/simulation/output_error.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "learn/numeric/lag_gram.hpp"

namespace wisp::arx {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kForgotten = 1e-9;  // of an initial state: rows where it has died down to less do not tell it

// What a row takes from its block's past outputs: those of each output by lag.
struct Feedback {
  struct Tap {
    int row;
    int from;
    int lag;
    double weight;
  };
  std::vector<Tap> taps;  // by row; the shortest lag last: it is the one that the processor has to wait for
  int outputs = 1;
};

Feedback feedback_of(const SimulationBlock& block, const VectorXd& theta) {
  Feedback feedback{{}, block.size()};
  for (std::size_t p = 0; p < block.terms().size(); ++p) {
    const BlockTerm& term = block.terms()[p];
    if (term.channel < block.size()) feedback.taps.push_back({term.row, term.channel, term.lag, theta[Index(p)]});
  }
  std::stable_sort(feedback.taps.begin(), feedback.taps.end(),
                   [](const auto& a, const auto& b) { return a.row != b.row ? a.row < b.row : a.lag > b.lag; });
  return feedback;
}

void feed_back_one(const Feedback& feedback, Index begin, Index end, double* x) {
  std::vector<double> weight;
  std::vector<Index> lag;
  for (const auto& tap : feedback.taps) {
    weight.push_back(tap.weight);
    lag.push_back(tap.lag);
  }
  const std::size_t taps = weight.size();
  for (Index t = begin; t < end; ++t) {
    double sum = x[t];
    for (std::size_t k = 0; k < taps; ++k) sum += weight[k] * x[t - lag[k]];
    x[t] = sum;
  }
}

// Turns forces, one column an output, into what the feedback makes of them; rows before `begin` are the past.
void feed_back(const Feedback& feedback, Index begin, Index end, Eigen::Ref<MatrixXd> x) {
  if (feedback.outputs == 1) return feed_back_one(feedback, begin, end, x.data());
  std::vector<double*> series;
  series.reserve(static_cast<std::size_t>(feedback.outputs));
  for (int o = 0; o < feedback.outputs; ++o) series.push_back(x.col(o).data());
  for (Index t = begin; t < end; ++t) {
    for (const auto& tap : feedback.taps) series[tap.row][t] += tap.weight * series[tap.from][t - tap.lag];
  }
}

// The inputs' and the constant's part of rows [history, history + count).
MatrixXd force_of(const SimulationBlock& block, const BlockRun& run, const VectorXd& theta, Index count) {
  const Index history = block.history();
  MatrixXd force = MatrixXd::Zero(history + count, block.size());
  for (std::size_t p = 0; p < block.terms().size(); ++p) {
    const BlockTerm& term = block.terms()[p];
    if (term.channel < block.size()) continue;
    auto part = force.col(term.row).tail(count);
    const int input = term.channel - block.size();
    if (input == block.inputs()) {
      part.array() += theta[Index(p)];
    } else {
      part += theta[Index(p)] * run.inputs.col(input).segment(history - term.lag, count);
    }
  }
  return force;
}

// Responses to a shock of each row, until they have died down: column i·outputs + o, below `history` zeros.
MatrixXd shock_responses(const SimulationBlock& block, const Feedback& feedback, Index longest) {
  const Index history = block.history(), outputs = block.size();
  Index rows = std::min(longest, kMaxStateRows);
  MatrixXd all = MatrixXd::Zero(history + rows, outputs * outputs);
  Index alive = 0;
  for (Index i = 0; i < outputs; ++i) {
    auto one = all.middleCols(i * outputs, outputs);
    one(history, i) = 1;
    feed_back(feedback, history, history + rows, one);
    const double least = kForgotten * one.cwiseAbs().maxCoeff();
    Index last = history + rows;
    while (last > history + alive && one.row(last - 1).cwiseAbs().maxCoeff() < least) --last;
    alive = std::max(alive, last - history);
  }
  return all.topRows(history + alive);
}

// Columns of the initial state: which shock, and at which row.
std::vector<std::pair<int, int>> state_columns(const SimulationBlock& block) {
  std::vector<std::pair<int, int>> columns;
  for (int i = 0; i < block.size(); ++i) {
    for (int at = 0; at < block.memory()[i]; ++at) columns.emplace_back(i, at);
  }
  return columns;
}

// The shocks to a stretch's first rows with which its simulation fits best.
VectorXd best_state(const SimulationBlock& block, const BlockRun& run, const MatrixXd& shock, const MatrixXd& base) {
  const Index history = block.history(), rows = std::min(run.rows, shock.rows() - history);
  const auto columns = state_columns(block);
  MatrixXd gram = MatrixXd::Zero(Index(columns.size()), Index(columns.size()));
  VectorXd moment = VectorXd::Zero(Index(columns.size()));
  for (Index o = 0; o < block.size(); ++o) {
    MatrixXd response(rows, Index(columns.size()));
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const auto [i, at] = columns[c];
      response.col(Index(c)) = shock.col(Index(i) * block.size() + o).segment(history - at, rows);
    }
    VectorXd rest = run.outputs.col(o).segment(history, rows) - base.col(o).segment(history, rows);
    for (Index t = 0; t < rows; ++t) {
      if (!std::isnan(rest[t])) continue;
      rest[t] = 0;
      response.row(t).setZero();
    }
    gram.selfadjointView<Eigen::Lower>().rankUpdate(response.transpose(), block.weight()[o]);
    moment += block.weight()[o] * (response.transpose() * rest);
  }
  gram.diagonal().array() += 1e-12 * gram.diagonal().maxCoeff() + 1e-300;
  return gram.selfadjointView<Eigen::Lower>().llt().solve(moment);
}

// One column per (row, channel) that a term has, and one per shock: what the gradient is made of.
struct Lane {
  int row;
  int channel;
};

struct Lanes {
  std::vector<Lane> lanes;
  std::vector<int> of_term;

  explicit Lanes(const std::vector<BlockTerm>& terms) {
    for (const BlockTerm& term : terms) {
      const auto found = std::find_if(lanes.begin(), lanes.end(), [&](const Lane& lane) {
        return lane.row == term.row && lane.channel == term.channel;
      });
      of_term.push_back(static_cast<int>(found - lanes.begin()));
      if (found == lanes.end()) lanes.push_back({term.row, term.channel});
    }
  }
};

// Derivatives' series of one run: per output one column a lane, below `pad` rows of rest. What a lane was before its
// first row may differ from the truth by anything that an initial state spans: that is eliminated with the state.
struct LaneSeries {
  Index pad = 0;
  std::vector<MatrixXd> of_output;
};

LaneSeries lane_series(const SimulationBlock& block, const Feedback& feedback, const Lanes& lanes, const BlockRun& run,
                       const MatrixXd& simulated) {
  const Index pad = *std::max_element(block.memory().begin(), block.memory().end());
  const Index rows = block.history() + run.rows, outputs = block.size();
  LaneSeries series{pad, {}};
  series.of_output.assign(block.outputs().size(), MatrixXd(pad + rows, Index(lanes.lanes.size())));
  MatrixXd force(pad + rows, outputs);
  for (std::size_t k = 0; k < lanes.lanes.size(); ++k) {
    const Lane& lane = lanes.lanes[k];
    force.setZero();
    auto driven = force.col(lane.row).tail(rows);
    if (lane.channel < block.size()) {
      driven = simulated.col(lane.channel);
    } else if (lane.channel < block.size() + block.inputs()) {
      driven = run.inputs.col(lane.channel - block.size());
    } else {
      driven.setOnes();
    }
    feed_back(feedback, pad, pad + rows, force);
    for (Index o = 0; o < outputs; ++o) series.of_output[std::size_t(o)].col(Index(k)) = force.col(o);
  }
  return series;
}

std::span<const double> span_of(const MatrixXd& matrix, Index column, Index first) {
  return {matrix.col(column).data() + first, static_cast<std::size_t>(matrix.rows() - first)};
}

// Products of the terms' derivatives, of the states' and of the error, over stretches of one run and one output.
class RunProducts {
 public:
  RunProducts(const SimulationBlock& block, const std::vector<BlockTerm>& terms, const Lanes& lanes)
      : block_(block),
        terms_(terms),
        lanes_(lanes),
        states_(state_columns(block)),
        with_state_(layout(true)),
        without_(layout(false)) {}

  Index states() const { return Index(states_.size()); }

  /// Sums over rows [begin, end) of the run, counted from its first simulated row: terms, states where `with_states`,
  /// and the error last.
  MatrixXd sums(const LaneSeries& series, const BlockSimulation& at, std::size_t run, int output, RowRun rows,
                bool with_states) const {
    const LagLayout& columns = with_states ? with_state_ : without_;
    const std::vector<int> order = order_of(columns, with_states);
    const RowPlan plan = plan_of(run, output, rows);
    const auto size = Index(order.size());
    if (plan.runs.empty()) return MatrixXd::Zero(size, size);
    const Signals signals = signals_of(series, at, run, output, with_states);
    const ChannelPairs all = ChannelPairs::Constant(columns.channels(), columns.channels(), true);
    return block_.weight()[output] * lag_gram(signals, plan, columns, all)(order, order);
  }

 private:
  LagLayout layout(bool states) const {
    std::vector<LaggedChannel> used;
    for (std::size_t p = 0; p < terms_.size(); ++p) {
      used.push_back({1 + lanes_.of_term[p], terms_[p].lag});
    }
    const int lanes = static_cast<int>(lanes_.lanes.size());
    for (const auto& [shock, row] : states_) {
      if (states) used.push_back({1 + lanes + shock, row});
    }
    return LagLayout(1, lanes + (states ? block_.size() : 0), used);
  }

  std::vector<int> order_of(const LagLayout& columns, bool with_states) const {
    std::vector<int> order;
    for (std::size_t p = 0; p < terms_.size(); ++p) {
      order.push_back(columns.find({1 + lanes_.of_term[p], terms_[p].lag}));
    }
    const int lanes = static_cast<int>(lanes_.lanes.size());
    for (const auto& [shock, row] : states_) {
      if (with_states) order.push_back(columns.find({1 + lanes + shock, row}));
    }
    order.push_back(columns.target(0));
    return order;
  }

  RowPlan plan_of(std::size_t run, int output, const RowRun& rows) const {
    const auto history = static_cast<std::size_t>(block_.history());
    RowPlan plan;
    for (const RowRun& stretch : block_.runs()[run].measured[std::size_t(output)]) {
      const std::size_t first = std::max(stretch.begin, history + rows.begin);
      const std::size_t last = std::min(stretch.end, history + rows.end);
      if (first < last) plan.runs.push_back({0, first, last});
    }
    return plan;
  }

  Signals signals_of(const LaneSeries& series, const BlockSimulation& at, std::size_t run, int output,
                     bool with_states) const {
    Signals signals;
    auto& samples = signals.samples.emplace_back();
    samples.push_back(span_of(at.error[run], output, 0));
    const MatrixXd& own = series.of_output[std::size_t(output)];
    for (Index k = 0; k < own.cols(); ++k) samples.push_back(span_of(own, k, series.pad));
    for (Index i = 0; with_states && i < block_.size(); ++i) {
      samples.push_back(span_of(at.shock, i * block_.size() + output, 0));
    }
    signals.outputs = 1;
    signals.inputs = static_cast<int>(samples.size()) - 1;
    signals.offset.assign(samples.size(), 0.0);
    signals.scale.assign(samples.size(), 1.0);
    signals.missing = false;
    return signals;
  }

  const SimulationBlock& block_;
  const std::vector<BlockTerm>& terms_;
  const Lanes& lanes_;
  std::vector<std::pair<int, int>> states_;
  LagLayout with_state_;
  LagLayout without_;
};

// Takes the states of a run out of its products: what is left is the terms' curvature when states follow.
void eliminate_states(const MatrixXd& sums, Index terms, Index states, GaussNewton& out) {
  MatrixXd own = sums.block(terms, terms, states, states);
  own.diagonal().array() += 1e-12 * own.diagonal().maxCoeff() + 1e-300;
  const MatrixXd between = sums.block(0, terms, terms, states);
  const VectorXd push = sums.col(terms + states).segment(terms, states);
  const Eigen::LLT<MatrixXd> solver(own);
  out.curvature += sums.topLeftCorner(terms, terms) - between * solver.solve(between.transpose());
  out.gradient += sums.col(terms + states).head(terms) - between * solver.solve(push);
}

}  // namespace

BlockSimulation simulate_block(const SimulationBlock& block, const VectorXd& theta) {
  const Feedback feedback = feedback_of(block, theta);
  const Index history = block.history();
  Index longest = 0;
  for (const BlockRun& run : block.runs()) longest = std::max(longest, run.rows);
  BlockSimulation out{theta, {}, {}, shock_responses(block, feedback, longest), 0};
  const auto columns = state_columns(block);
  for (const BlockRun& run : block.runs()) {
    MatrixXd simulated = force_of(block, run, theta, run.rows);
    const Index head = history + std::min(run.rows, out.shock.rows() - history);
    MatrixXd base = simulated.topRows(head);
    feed_back(feedback, history, head, base);
    const VectorXd state = best_state(block, run, out.shock, base);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (columns[c].second < run.rows) simulated(history + columns[c].second, columns[c].first) += state[Index(c)];
    }
    feed_back(feedback, history, simulated.rows(), simulated);
    MatrixXd error = run.outputs - simulated;
    error = error.array().isNaN().select(0.0, error).eval();
    error.topRows(history).setZero();
    out.cost += error.colwise().squaredNorm().dot(block.weight());
    out.simulated.push_back(std::move(simulated));
    out.error.push_back(std::move(error));
  }
  return out;
}

MatrixXd simulate_from(const SimulationBlock& block, const VectorXd& theta, const BlockRun& run, Index begin) {
  MatrixXd simulated = force_of(block, run, theta, run.rows);
  simulated.topRows(begin) = run.outputs.topRows(begin);
  feed_back(feedback_of(block, theta), begin, simulated.rows(), simulated);
  return simulated;
}

void filter_by_feedback(const SimulationBlock& block, const VectorXd& theta, MatrixXd& columns) {
  const Feedback feedback = feedback_of(block, theta);
  for (Index c = 0; c < columns.cols(); ++c) {
    feed_back_one(feedback, block.memory().front(), columns.rows(), columns.col(c).data());
  }
}

GaussNewton gauss_newton(const SimulationBlock& block, const BlockSimulation& at) {
  return gauss_newton(block, at, block.terms());
}

GaussNewton gauss_newton(const SimulationBlock& block, const BlockSimulation& at, const std::vector<BlockTerm>& moved) {
  const Feedback feedback = feedback_of(block, at.theta);
  const Lanes lanes(moved);
  const RunProducts products(block, moved, lanes);
  const Index terms = Index(moved.size()), states = products.states();
  GaussNewton out{MatrixXd::Zero(terms, terms), VectorXd::Zero(terms)};
  for (std::size_t r = 0; r < block.runs().size(); ++r) {
    const BlockRun& run = block.runs()[r];
    const LaneSeries series = lane_series(block, feedback, lanes, run, at.simulated[r]);
    const auto head = static_cast<std::size_t>(std::min(run.rows, at.shock.rows() - block.history()));
    const auto end = static_cast<std::size_t>(run.rows);
    MatrixXd early = MatrixXd::Zero(terms + states + 1, terms + states + 1);
    for (int o = 0; o < block.size(); ++o) {
      early += products.sums(series, at, r, o, {r, 0, head}, true);
      if (head == end) continue;
      const MatrixXd late = products.sums(series, at, r, o, {r, head, end}, false);
      out.curvature += late.topLeftCorner(terms, terms);
      out.gradient += late.col(terms).head(terms);
    }
    eliminate_states(early, terms, states, out);
  }
  return out;
}

MatrixXd batch_gradients(const SimulationBlock& block, const BlockSimulation& at, int batches) {
  const Feedback feedback = feedback_of(block, at.theta);
  const Lanes lanes(block.terms());
  const RunProducts products(block, block.terms(), lanes);
  const Index terms = Index(block.terms().size());
  std::size_t rows = 0, before = 0;
  for (const BlockRun& run : block.runs()) rows += static_cast<std::size_t>(run.rows);
  MatrixXd out = MatrixXd::Zero(terms, batches);
  const std::size_t share = (rows + static_cast<std::size_t>(batches) - 1) / static_cast<std::size_t>(batches);
  for (std::size_t r = 0; r < block.runs().size(); ++r) {
    const BlockRun& run = block.runs()[r];
    const LaneSeries series = lane_series(block, feedback, lanes, run, at.simulated[r]);
    const auto end = static_cast<std::size_t>(run.rows);
    for (std::size_t begin = 0, next = 0; begin < end; begin = next) {
      const std::size_t batch = (before + begin) / share;
      next = std::min(end, (batch + 1) * share - before);
      for (int o = 0; o < block.size(); ++o) {
        out.col(Index(batch)) += products.sums(series, at, r, o, {r, begin, next}, false).col(terms).head(terms);
      }
    }
    before += end;
  }
  return out;
}

}  // namespace wisp::arx
