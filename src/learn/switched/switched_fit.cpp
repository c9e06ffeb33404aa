#include "learn/switched/switched_fit.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "learn/arx/fit/arx_stability.hpp"
#include "learn/numeric/decompositions.hpp"
#include "learn/numeric/lyapunov.hpp"
#include "learn/switched/switched_prediction.hpp"
#include "learn/switched/switched_refine.hpp"
#include "learn/switched/switched_rows.hpp"
#include "learn/switched/switched_start.hpp"

namespace wisp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kFirstRounds = 25;   // of every start, before the best is taken further
constexpr double kSureGain = 2;    // standard errors by which a further mode must gain on rows held out
constexpr double kUsableFit = 10;  // per cent, one step ahead

Result<void> check_options(const SwitchedOptions& options) {
  const auto wrong = [](const std::string& what, const std::string& found, const std::string& expected) {
    return Error{what + " is " + found + ", expected " + expected};
  };
  const int most = static_cast<int>(kMaxArxModes);
  if (options.max_modes < 1 || options.max_modes > most)
    return wrong("the largest number of modes", std::to_string(options.max_modes), "1 to 64");
  if (options.modes < 0 || options.modes > most)
    return wrong("the number of modes", std::to_string(options.modes), "1 to 64, or 0 for the best");
  if (!(options.holdout > 0 && options.holdout <= 0.9))
    return wrong("the share of rows held out", std::to_string(options.holdout), "more than 0 and at most 0.9");
  if (options.starts < 1) return wrong("the number of starts", std::to_string(options.starts), "at least 1");
  if (options.max_iterations < 1)
    return wrong("the number of rounds", std::to_string(options.max_iterations), "at least 1");
  if (options.neighbours < 0)
    return wrong("the rows of a local model", std::to_string(options.neighbours), "at least 1, or 0");
  if (!(options.stability_margin > 0 && options.stability_margin < 1))
    return wrong("the margin of stability", std::to_string(options.stability_margin), "between 0 and 1");
  return {};
}

int row_size(const SwitchedRows& rows) {
  std::size_t most = 0;
  for (const auto& columns : rows.columns) most = std::max(most, columns.size());
  return static_cast<int>(most);
}

// Modes with more than this are determined.
double min_rows(const SwitchedRows& rows) { return 1.5 * row_size(rows) + 3; }

// Modes by how much of the rows is theirs, most first.
void sort_modes(RefinedModes& found) {
  const Index count = found.weights.cols();
  std::vector<Index> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), Index{0});
  const VectorXd share = found.weights.colwise().sum().transpose();
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return share(a) > share(b); });
  ScaledModes sorted = found.modes;
  for (std::size_t k = 0; k < order.size(); ++k) {
    sorted.theta[k] = found.modes.theta[order[k]];
    sorted.factor[k] = found.modes.factor[order[k]];
  }
  if (sorted.switching == Switching::kRegions) {
    sorted.regions = MatrixXd(found.modes.regions(order, Eigen::all));
  } else {
    sorted.initial = VectorXd(found.modes.initial(order));
    sorted.transitions = MatrixXd(found.modes.transitions(order, order));
  }
  found.modes = std::move(sorted);
  found.weights = MatrixXd(found.weights(Eigen::all, order));
}

// By regions a row has the mode that plays it, and residuals are those of the model as it plays.
void settle(const SwitchedRows& rows, const VectorXd& least, RefinedModes& found) {
  sort_modes(found);
  if (found.modes.switching == Switching::kMarkov) return;
  const std::vector<int> mode = region_modes(found.modes, rows);
  for (int k = 0; k < found.modes.modes(); ++k) {
    VectorXd own(rows.rows());
    for (Index t = 0; t < rows.rows(); ++t) own(t) = mode[static_cast<std::size_t>(t)] == k ? 1 : 0;
    if (own.sum() == 0) continue;
    found.modes.factor[k] = residual_factor(rows.y - rows.phi * found.modes.theta[k], own, least);
  }
}

Result<RefinedModes> best_of_starts(const SwitchedRows& rows, int modes, const SwitchedOptions& options,
                                    const Progress& progress) {
  const VectorXd least = min_variance(rows);
  const int near = options.neighbours > 0 ? options.neighbours : 3 * row_size(rows);
  std::optional<RefinedModes> best;
  const int starts = modes == 1 ? 1 : options.starts;
  for (int start = 0; start < starts; ++start) {
    const std::string stage = "trying " + std::to_string(modes) + (modes == 1 ? " mode" : " modes");
    if (!go_on(progress, stage, static_cast<double>(start) / starts)) return Error{std::string(kStopped)};
    const std::uint64_t seed = options.seed * 1000 + static_cast<std::uint64_t>(start);
    // Larger neighbourhoods tell modes apart where noise is strong, smaller ones where regions are.
    const auto first = start < std::max(1, starts / 4)
                           ? clustered_start(rows, options.switching, modes, near << start, seed)
                           : drawn_start(rows, options.switching, modes, near << (start % 2), seed);
    RefinedModes found = refine(rows, options.switching, first, modes, least, kFirstRounds);
    if (!best || found.log_likelihood > best->log_likelihood) best = std::move(found);
  }
  RefinedModes found = refine_further(rows, *best, least, options.max_iterations);
  settle(rows, least, found);
  return found;
}

std::vector<double> mode_shares(const ScaledModes& modes, const SwitchedRows& rows) {
  std::vector<double> count(static_cast<std::size_t>(modes.modes()), 0.0);
  for (int mode : likeliest_modes(modes, rows)) ++count[static_cast<std::size_t>(mode)];
  return count;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) /
         static_cast<double>(std::max<std::size_t>(1, values.size()));
}

double gain_error(const std::vector<double>& better, const std::vector<double>& worse) {
  std::vector<double> gain(better.size());
  for (std::size_t t = 0; t < gain.size(); ++t) gain[t] = better[t] - worse[t];
  const double mean = mean_of(gain);
  double square = 0;
  for (double g : gain) square += (g - mean) * (g - mean);
  return std::sqrt(square) / static_cast<double>(std::max<std::size_t>(1, gain.size()));
}

// From scaled units to the outputs' own.
double likelihood_offset(const SwitchedRows& rows) {
  double sum = 0;
  for (double size : rows.scales.output_size) sum -= std::log(size);
  return sum;
}

struct Judged {
  std::vector<SwitchedCandidate> candidates;
  int chosen = 1;
  double gain = 0;  // of the chosen over a single mode, per row held out
  double gain_std_error = 0;
};

// Learns every number of modes from the first part of each stretch and judges it by the rest. A number is taken where
// it gains surely over the last one that was.
Result<Judged> judge(const SwitchedRows& rows, const SwitchedOptions& options, const Progress& progress) {
  const SwitchedRows learned = share_of(rows, 0, 1 - options.holdout), unseen = share_of(rows, 1 - options.holdout, 1);
  Judged out;
  std::vector<int> counts{1};
  if (options.modes > 1) counts.push_back(options.modes);
  for (int k = 2; options.modes == 0 && k <= options.max_modes; ++k) counts.push_back(k);
  std::vector<double> single, last, chosen;
  for (int count : counts) {
    if (static_cast<double>(learned.rows()) < count * min_rows(rows)) break;
    const auto found = best_of_starts(learned, count, options, progress);
    if (!found) return found.error();
    const std::vector<double> row = row_log_likelihoods(found->modes, unseen);
    const std::vector<double> share = mode_shares(found->modes, learned);
    SwitchedCandidate candidate{count, found->log_likelihood / static_cast<double>(learned.rows()), mean_of(row)};
    candidate.log_likelihood += likelihood_offset(rows);
    candidate.held_out_log_likelihood += likelihood_offset(rows);
    candidate.determined = *std::min_element(share.begin(), share.end()) >= min_rows(rows);
    if (!last.empty()) candidate.gain_std_error = gain_error(row, last);
    out.candidates.push_back(candidate);
    last = row;
    if (single.empty()) single = chosen = row;
    const double gain = mean_of(row) - mean_of(chosen);
    if (options.modes == count || (candidate.determined && gain > kSureGain * gain_error(row, chosen))) {
      chosen = row;
      out.chosen = count;
    }
  }
  out.gain = mean_of(chosen) - mean_of(single);
  out.gain_std_error = gain_error(chosen, single);
  return out;
}

// Standard errors, and curvature for what makes a mode stable, in the model's own units.
struct ModeErrors {
  std::vector<std::vector<double>> std_error;
  std::vector<double> constant;  // standard errors, per output
  std::vector<RowCurvature> curvature;
};

ModeErrors errors_of(const SwitchedRows& rows, const MatrixXd& theta, const VectorXd& weights) {
  ModeErrors out;
  for (int i = 0; i < rows.outputs(); ++i) {
    const auto& columns = rows.columns[i];
    const MatrixXd x = rows.phi(Eigen::all, columns);
    MatrixXd gram = x.transpose() * weights.asDiagonal() * x;
    gram.diagonal().array() += 1e-9 * (1 + weights.sum());
    MatrixXd inverse = symmetric_solutions(gram, MatrixXd::Identity(gram.rows(), gram.cols()));
    const VectorXd residual = rows.y.col(i) - rows.phi * theta.col(i);
    const double free = std::max(1.0, weights.sum() - static_cast<double>(columns.size()));
    const double variance = (residual.array().square() * weights.array()).sum() / free;
    std::vector<double>& errors = out.std_error.emplace_back();
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double scale = coefficient_scale(rows, i, columns[c]);
      const double error = std::abs(scale) * std::sqrt(variance * inverse(c, c));
      if (c + 1 < columns.size()) {
        errors.push_back(error);
      } else {
        out.constant.push_back(error);
      }
      inverse.row(static_cast<Index>(c)) *= scale;
      inverse.col(static_cast<Index>(c)) *= scale;
    }
    out.curvature.push_back({std::move(inverse), 1 / std::max(variance, 1e-300)});
  }
  return out;
}

// Standard errors, stability, and the sizes of residuals after it.
void finish_modes(const SwitchedRows& rows, const SwitchedOptions& options, const RefinedModes& found,
                  SwitchedFit& fit) {
  for (std::size_t k = 0; k < fit.model.modes.size(); ++k) {
    const VectorXd weights = found.weights.col(static_cast<Index>(k));
    ModeErrors errors = errors_of(rows, found.modes.theta[k], weights);
    ArxMode& mode = fit.model.modes[k];
    mode.std_error = std::move(errors.std_error);
    fit.summary.constant_std_error.push_back(std::move(errors.constant));
    ArxModel arx = mode_model(fit.model, k);
    const bool unstable = spectral_radius(arx) >= 1;
    if (unstable) {
      make_stable(arx, errors.curvature, 1 - options.stability_margin);
      mode.theta = arx.theta;
      mode.constant = arx.constant;
    }
    fit.summary.mode_changed.push_back(unstable);
    fit.summary.mode_radius.push_back(spectral_radius(arx));
  }
  if (std::none_of(fit.summary.mode_changed.begin(), fit.summary.mode_changed.end(), [](bool c) { return c; })) return;
  ScaledModes changed = scaled_modes(fit.model, rows);
  const std::vector<int> mode = likeliest_modes(changed, rows);
  for (int k = 0; k < changed.modes(); ++k) {
    VectorXd own(rows.rows());
    for (Index t = 0; t < rows.rows(); ++t) own(t) = mode[static_cast<std::size_t>(t)] == k ? 1 : 0;
    if (own.sum() > 0)
      changed.factor[k] = residual_factor(rows.y - rows.phi * changed.theta[k], own, min_variance(rows));
  }
  const SwitchedArxModel again = model_of(changed, rows);
  for (std::size_t k = 0; k < again.modes.size(); ++k) fit.model.modes[k].shock = again.modes[k].shock;
}

// Fits over all recordings: 100 (1 − ‖y − ŷ‖/‖y − ȳ‖), by the sums of each.
std::vector<double> fit_percent(const SwitchedArxModel& model, std::span<const Recording> recordings,
                                const ChannelChoice& channels, int steps) {
  std::vector<double> error(channels.outputs.size(), 0.0), spread(error), percent;
  for (const Recording& recording : recordings) {
    const auto figures = switched_figures(model, recording, channels, {steps});
    if (!figures) continue;
    for (std::size_t i = 0; i < error.size(); ++i) {
      const double rows = static_cast<double>(figures->front().rows), square = figures->front().mean_square[i];
      const double share = 1 - figures->front().fit_percent[i] / 100;
      error[i] += rows * square;
      if (share > 0) spread[i] += rows * square / (share * share);
    }
  }
  for (std::size_t i = 0; i < error.size(); ++i) {
    percent.push_back(spread[i] > 0 ? 100 * (1 - std::sqrt(error[i] / spread[i])) : 0);
  }
  return percent;
}

Usable verdict_of(const SwitchedFit& fit, const Judged& judged) {
  const auto& modes = fit.summary.mode_rows;
  const auto& differences = fit.summary.differences;
  const double few = 1.5 * fit.model.orders.row_size(0) + 3;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    if (static_cast<double>(modes[k]) < few) {
      return {false, "mode " + std::to_string(k) + " acts in " + std::to_string(modes[k]) +
                         " rows, too few for its coefficients; ask for fewer modes"};
    }
  }
  if (modes.size() == 1)
    return {false, "further modes predict rows held out no better than one does: use an ARX model"};
  if (!(judged.gain > kSureGain * judged.gain_std_error)) {
    return {false, "a single ARX model predicts rows held out as well: use that, or other orders"};
  }
  for (double percent : fit.summary.fit_percent) {
    if (percent < kUsableFit) return {false, "an output is hardly predicted one step ahead; try other orders"};
  }
  if (std::all_of(differences.begin(), differences.end(), [](const auto& pair) { return pair.same_coefficients(); })) {
    return {true,
            "makes rows held out likelier than a single ARX model does, by the size of its noise alone: its modes "
            "have the same coefficients, and an ARX model moves alike"};
  }
  return {true, "predicts rows held out better than a single ARX model does"};
}

}  // namespace

Result<SwitchedFit> fit_switched(std::span<const Recording> recordings, const ChannelChoice& channels,
                                 const SwitchedOptions& options, const Progress& progress) {
  if (auto ok = check_options(options); !ok) return ok.error();
  if (auto ok = check_switched_data(recordings, channels, options.orders); !ok) return ok.error();
  auto rows =
      make_switched_rows(recordings, channels, options.orders, scales_of(recordings, channels, options.subtract_means));
  if (!rows) return rows.error();
  const double needed = min_rows(*rows) * std::max(1, options.modes) / (1 - options.holdout);
  if (static_cast<double>(rows->rows()) < needed) {
    return Error{"the recordings have " + std::to_string(rows->rows()) + " usable rows, expected at least " +
                 std::to_string(static_cast<long>(std::ceil(needed))) + ": choose fewer modes or smaller orders"};
  }
  const auto judged = judge(*rows, options, progress);
  if (!judged) return judged.error();
  const auto found = best_of_starts(*rows, judged->chosen, options, progress);
  if (!found) return found.error();
  SwitchedFit fit{model_of(found->modes, *rows), {}, {}};
  fit.summary.candidates = judged->candidates;
  fit.summary.samples_used = static_cast<std::size_t>(rows->rows());
  fit.summary.held_out = static_cast<std::size_t>(share_of(*rows, 1 - options.holdout, 1).rows());
  finish_modes(*rows, options, *found, fit);
  fit.model.lyapunov = find_common_lyapunov(fit.model);
  const std::vector<int> modes = likeliest_modes(scaled_modes(fit.model, *rows), *rows);
  for (const Recording& recording : recordings) fit.modes.emplace_back(recording.rows(), -1);
  fit.summary.mode_rows.assign(fit.model.modes.size(), 0);
  for (std::size_t r = 0; r < modes.size(); ++r) {
    fit.modes[rows->places[r].recording][rows->places[r].row] = modes[r];
    ++fit.summary.mode_rows[static_cast<std::size_t>(modes[r])];
  }
  fit.summary.fit_percent = fit_percent(fit.model, recordings, channels, 1);
  if (!channels.inputs.empty())
    fit.summary.free_run_fit_percent = fit_percent(fit.model, recordings, channels, kFreeRun);
  for (std::size_t k = 0; k < fit.summary.mode_changed.size(); ++k) {
    if (fit.summary.mode_changed[k]) fit.summary.warnings.push_back("mode " + std::to_string(k) + " was made stable");
  }
  fit.summary.differences = mode_differences(fit.model, fit.summary.constant_std_error);
  fit.summary.usable = verdict_of(fit, *judged);
  return fit;
}

}  // namespace wisp
