#include "learn/choose/focus.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "learn/judge/held_out.hpp"
#include "learn/judge/judged_fit.hpp"

namespace wisp::arx {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kManyRows = 8192;    // above this, candidates are compared on a sample of the rows
constexpr std::size_t kRowsOfMany = 4096;  // number of rows in that sample
constexpr double kMaxKernelWork = 2e7;     // maximum of the sum over outputs of (number of coefficients)³
constexpr double kWorthIt = 0.02;          // minimum gain, as a share of the squared error
constexpr int kRowsALag = 10;              // minimum mean length of a recording's episodes, in lags of the kernel
constexpr double kMeasuredStarts[] = {0, 0.25, 0.5, 0.75};  // shares of a held-out recording at which runs start

ArxOrders decoupled_orders(ArxOrders orders) {
  for (int i = 0; i < orders.outputs(); ++i) {
    for (int j = 0; j < orders.outputs(); ++j) {
      if (i != j) orders.na(i, j) = 0;
    }
  }
  return orders;
}

ArxOrders kernel_orders(ArxOrders orders, int lags) {
  for (int i = 0; i < orders.outputs(); ++i) {
    for (int j = 0; j < orders.outputs(); ++j) {
      if (orders.na(i, j) > 0) orders.na(i, j) = std::max(orders.na(i, j), lags);
    }
    for (int k = 0; k < orders.inputs(); ++k) {
      if (orders.nb(i, k) == 0) continue;
      orders.nb(i, k) = std::max(orders.nb(i, k) + orders.nk(i, k), lags);
      orders.nk(i, k) = 0;
    }
  }
  return orders;
}

ArxOptions options_of(const ArxOptions& given, const FocusCandidate& candidate) {
  ArxOptions out = given;
  if (candidate.decoupled) out.orders = decoupled_orders(std::move(out.orders));
  if (candidate.kernel_lags > 0) {
    out.orders = kernel_orders(std::move(out.orders), candidate.kernel_lags);
    out.kernel = ArxKernel::kTc;
    if (out.offset == ArxOffset::kMean) out.offset = ArxOffset::kEstimate;
  }
  return out;
}

// The submodel of a set of outputs that is not coupled to other outputs.
ArxModel part_of(const ArxModel& model, const std::vector<int>& outputs) {
  const auto size = static_cast<int>(outputs.size()), inputs = model.orders.inputs();
  ArxModel part;
  part.orders = {OrderMatrix(size, size), OrderMatrix(size, inputs), OrderMatrix(size, inputs)};
  part.input_mean = model.input_mean;
  for (int i = 0; i < size; ++i) {
    const int row = outputs[std::size_t(i)];
    for (int j = 0; j < size; ++j) part.orders.na(i, j) = model.orders.na(row, outputs[std::size_t(j)]);
    for (int k = 0; k < inputs; ++k) {
      part.orders.nb(i, k) = model.orders.nb(row, k);
      part.orders.nk(i, k) = model.orders.nk(row, k);
    }
    part.theta.push_back(model.theta[std::size_t(row)]);
    part.constant.push_back(model.constant[std::size_t(row)]);
    part.output_mean.push_back(model.output_mean[std::size_t(row)]);
  }
  return part;
}

// Errors of one candidate for one block over all folds: kParts rows per fold, one column per output.
struct Errors {
  MatrixXd estimated;
  MatrixXd measured;
};

void append(const MatrixXd& more, MatrixXd& to) {
  to.conservativeResize(to.rows() + more.rows(), more.cols());
  to.bottomRows(more.rows()) = more;
}

// One block of coupled outputs, and the errors of each candidate (unset where a fold has too few rows for it).
struct Block {
  FocusChoice choice;
  std::vector<std::optional<Errors>> errors{};
};

class Chooser {
 public:
  Chooser(std::span<const Recording> recordings, const ChannelChoice& channels, const ArxOptions& options)
      : channels_(channels), options_(options) {
    std::size_t rows = 0;
    for (const Recording& one : recordings) rows += one.rows();
    seen_ = middles_of(recordings, rows > kManyRows ? kRowsOfMany : kManyRows);
    options_.judge_free_run = options_.covariance = false;
    std::vector<FocusCandidate> candidates;
    const ArxOrders apart = decoupled_orders(options.orders);
    for (const bool decoupled : {false, true}) {
      if (decoupled && apart == options.orders) continue;
      candidates.push_back({.decoupled = decoupled});
      for (const int lags : kKernelLags) {
        if (!has_kernel(recordings, decoupled ? apart : options.orders, lags)) continue;
        candidates.push_back({.kernel_lags = lags, .decoupled = decoupled});
      }
    }
    for (std::vector<int>& outputs : coupled_outputs(options.orders.na)) {
      blocks_.push_back(
          {{std::move(outputs), 0, candidates}, std::vector<std::optional<Errors>>(candidates.size(), Errors{})});
    }
  }

  Result<void> judge(const Progress& progress) {
    for (const Fold& fold : folds_of(seen_)) {
      for (std::size_t c = 0; c < candidates().size(); ++c) {
        judge_fold(fold, c);
        if (!go_on(progress, "choosing", -1)) return Error{std::string(kStopped)};
      }
    }
    return {};
  }

  /// Chooses per block the last candidate whose error is kWorthIt below the best before it and, unless
  /// `leave_least_squares`, surely_better() than least squares. Returns whether any block could be judged.
  bool choose(bool leave_least_squares) {
    bool judged = false;
    for (Block& block : blocks_) {
      judged |= block.errors.front().has_value();
      if (block.errors.front()) choose(block, leave_least_squares);
    }
    return judged;
  }

  std::vector<FocusChoice> choices() const {
    std::vector<FocusChoice> out;
    for (const Block& block : blocks_) {
      FocusChoice& choice = out.emplace_back(block.choice);
      if (!block.errors.front()) choice.candidates.clear();
    }
    return out;
  }

  bool changed() const {
    return std::any_of(blocks_.begin(), blocks_.end(), [](const Block& one) { return one.choice.chosen > 0; });
  }

  ArxOptions chosen(const ArxOptions& given) const {
    ArxOptions out = given;
    for (const Block& block : blocks_) {
      const FocusCandidate& candidate = block.choice.candidates[block.choice.chosen];
      const ArxOptions own = options_of(given, candidate);
      for (int i : block.choice.outputs) {
        for (int j = 0; j < own.orders.outputs(); ++j) out.orders.na(i, j) = own.orders.na(i, j);
        for (int k = 0; k < own.orders.inputs(); ++k) {
          out.orders.nb(i, k) = own.orders.nb(i, k);
          out.orders.nk(i, k) = own.orders.nk(i, k);
        }
        if (candidate.kernel_lags > 0) out.kernel_outputs.push_back(i);
      }
      if (candidate.kernel_lags > 0) out.kernel = own.kernel, out.offset = own.offset;
    }
    if (out.kernel_outputs.size() == channels_.outputs.size()) out.kernel_outputs.clear();
    std::sort(out.kernel_outputs.begin(), out.kernel_outputs.end());
    return out;
  }

 private:
  const std::vector<FocusCandidate>& candidates() const { return blocks_.front().choice.candidates; }

  // Whether to try a kernel: the mean episode of every recording is long compared with the lags, and the number of
  // coefficients keeps the computation affordable.
  bool has_kernel(std::span<const Recording> recordings, const ArxOrders& orders, int lags) const {
    double work = 0;
    const ArxOrders many = kernel_orders(orders, lags);
    for (int i = 0; i < many.outputs(); ++i) work += std::pow(many.row_size(i), 3);
    return work <= kMaxKernelWork && std::all_of(recordings.begin(), recordings.end(), [lags](const Recording& one) {
             return one.rows() >= std::size_t(kRowsALag * lags) * std::max<std::size_t>(1, episodes(one).size());
           });
  }

  void judge_fold(const Fold& fold, std::size_t c) {
    const auto fit = fit_arx(fold.learned, channels_, options_of(options_, candidates()[c]));
    for (Block& block : blocks_) {
      std::optional<Errors>& errors = block.errors[c];
      if (!errors) continue;
      if (!fit) {
        errors.reset();
        continue;
      }
      add_errors(fold, part_of(fit->model, block.choice.outputs), block.choice.outputs, errors);
    }
  }

  void add_errors(const Fold& fold, const ArxModel& model, const std::vector<int>& outputs,
                  std::optional<Errors>& errors) const {
    ChannelChoice own{channels_.inputs, {}};
    for (int output : outputs) own.outputs.push_back(channels_.outputs[std::size_t(output)]);
    std::vector<Recording> starts;
    for (const Recording& one : fold.held_out) {
      for (double share : kMeasuredStarts) {
        starts.push_back(slice(one, static_cast<std::size_t>(share * static_cast<double>(one.rows())), one.rows()));
      }
    }
    // All candidates are judged on the same rows.
    const int first = std::max(kKernelLags[1], options_.orders.history());
    const auto estimated = free_run_parts(model, fold.held_out, own, {InitialState::kEstimated, first});
    const auto measured = free_run_parts(model, starts, own, {InitialState::kMeasured, first});
    if (!estimated || !measured) {
      errors.reset();
      return;
    }
    append(*estimated, errors->estimated);
    append(*measured, errors->measured);
  }

  static void choose(Block& block, bool leave_least_squares) {
    const Errors& reference = *block.errors.front();
    const VectorXd estimated = relative_errors(reference.estimated, reference.estimated);
    const VectorXd both = estimated + relative_errors(reference.measured, reference.measured);
    double least = both.mean();
    for (std::size_t c = 0; c < block.errors.size(); ++c) {
      FocusCandidate& candidate = block.choice.candidates[c];
      if (!block.errors[c]) continue;
      candidate.estimated_error = std::sqrt(block.errors[c]->estimated.mean());
      candidate.measured_error = std::sqrt(block.errors[c]->measured.mean());
      const VectorXd own = relative_errors(block.errors[c]->estimated, reference.estimated);
      const VectorXd own_both = own + relative_errors(block.errors[c]->measured, reference.measured);
      const bool squares = block.choice.candidates[block.choice.chosen].kernel_lags == 0;
      if (!leave_least_squares && squares && candidate.kernel_lags > kKernelLags[0]) continue;
      if (c == 0 || !(own_both.mean() < (1 - kWorthIt) * least)) continue;
      if (!leave_least_squares && !(surely_better(own, estimated) && surely_better(own_both, both))) continue;
      least = own_both.mean();
      block.choice.chosen = c;
    }
  }

  const ChannelChoice& channels_;
  ArxOptions options_;
  std::vector<Recording> seen_;
  std::vector<Block> blocks_;
};

// Reason why no choice is possible; empty where one is.
std::string obstacle(const ArxOptions& options, const ArxFit& plain, ArxFocus focus) {
  const auto& nb = options.orders.nb.values();
  const auto& na = options.orders.na.values();
  const auto positive = [](int order) { return order > 0; };
  if (focus == ArxFocus::kPrediction) return "one step ahead, as requested";
  if (std::none_of(nb.begin(), nb.end(), positive)) return "no input drives a free simulation";
  if (std::none_of(na.begin(), na.end(), positive)) return "without feedback a prediction is a simulation";
  if (!plain.summary.rank_problems.empty()) return "the data cannot tell all coefficients";
  if (!options.stabilise) return "an unstable estimate was to be kept";
  return "";
}

}  // namespace

Result<FocusedFit> focus_fit(std::span<const Recording> recordings, const ChannelChoice& channels,
                             const ArxOptions& options, ArxFit plain, ArxFocus focus, const Progress& progress) {
  std::string reason = obstacle(options, plain, focus);
  FocusedFit out{std::move(plain), options, {.reason = std::move(reason)}};
  FocusOutcome& outcome = out.outcome;
  if (!outcome.reason.empty()) return out;
  Chooser chooser(recordings, channels, options);
  if (auto ok = chooser.judge(progress); !ok) return ok.error();
  const bool simulation = focus == ArxFocus::kSimulation;
  const bool judged = chooser.choose(simulation);
  outcome.choices = chooser.choices();
  outcome.changed = chooser.changed();
  outcome.reason = !judged      ? "too few rows to hold some out"
                   : simulation ? "the least error of held-out free runs, as requested"
                   : outcome.changed
                       ? "held-out free runs are surely better than with least squares at the given orders"
                       : "held-out free runs are not surely better than with least squares";
  if (!outcome.changed) return out;
  out.options = chooser.chosen(options);
  auto fit = fit_arx(recordings, channels, out.options);
  if (!fit) return fit.error();
  out.fit = std::move(*fit);
  return out;
}

}  // namespace wisp::arx
