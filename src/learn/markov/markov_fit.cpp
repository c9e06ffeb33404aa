#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

#include "base/statistics.hpp"
#include "learn/markov/markov_rows.hpp"
#include "learn/numeric/decompositions.hpp"

namespace wisp::markov {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMaxTried = 6;             // maximum number of modes that is tried where the recipe states none
constexpr int kStarts = 12;              // random starts for each number of modes
constexpr int kFirstRounds = 25;         // iterations of expectation–maximisation of every start
constexpr int kMaxRounds = 300;          // iterations of the best start
constexpr double kHoldout = 0.3;         // share at the end of every stretch that is held out
constexpr double kSureGain = 2;          // minimum gain of a further mode on held-out rows, in standard errors
constexpr double kSmallResidual = 0.01;  // minimum RMS residual of a mode, as a share of the single model's
constexpr double kGain = 1e-6;           // nats per row: iterations end at the first with a smaller gain
constexpr double kUnseenSteps = 0.1;     // added to counts of initial modes and transitions, so that none is impossible
constexpr double kMaxRadius = 0.9999;    // maximum spectral radius of a mode after stabilisation
constexpr double kUsableFit = 10;        // minimum fit one step ahead of a usable model, percent
constexpr double kDifferent = 3;  // standard errors by which coefficients of modes must differ; by chance 1 in 370

struct State {
  Chain chain;
  MatrixXd weights;  // rows × modes
  double log_likelihood = -1e300;
};

int row_size(const Rows& rows) {
  std::size_t most = 0;
  for (const auto& group : rows.design.groups) most = std::max(most, group.columns.size());
  return static_cast<int>(most);
}

// Minimum number of rows for the coefficients of one mode.
double min_rows(const Rows& rows) { return 1.5 * row_size(rows) + 3; }

VectorXd min_variance(const Rows& rows) {
  const VectorXd all = VectorXd::Ones(rows.rows()), none = VectorXd::Zero(rows.outputs());
  const MatrixXd factor = fit_mode(rows, all, none).factor;
  return (factor.rowwise().squaredNorm() * kSmallResidual * kSmallResidual).cwiseMax(1e-300);
}

void maximise(const Rows& rows, const VectorXd& least, const MatrixXd& steps, State& state) {
  state.chain.modes.clear();
  for (Index k = 0; k < state.weights.cols(); ++k) {
    state.chain.modes.push_back(fit_mode(rows, state.weights.col(k), least));
  }
  state.chain.initial = state.weights.colwise().sum().transpose().array() + kUnseenSteps;
  state.chain.initial /= state.chain.initial.sum();
  state.chain.transitions = steps.array() + kUnseenSteps;
  for (Index k = 0; k < steps.rows(); ++k) state.chain.transitions.row(k) /= state.chain.transitions.row(k).sum();
}

// Iterates until the likelihood settles; a single mode settles at once. Returns false where the caller stops the work.
bool alternate(const Rows& rows, const VectorXd& least, int rounds, const Progress& progress, State& state) {
  for (int round = 0;; ++round) {
    const double share = static_cast<double>(round) / rounds;
    if (state.weights.cols() > 1 && !go_on(progress, "settling modes", share)) return false;
    Belief belief = believe(state.chain, rows);
    state.weights = std::move(belief.given_all);
    const double before = std::exchange(state.log_likelihood, belief.log_likelihood.sum());
    const bool settled = round > 2 && state.log_likelihood - before < kGain * static_cast<double>(rows.rows());
    if (settled || round == rounds) return true;
    maximise(rows, least, belief.steps, state);
  }
}

// A random start: fits models to randomly drawn stretches of consecutive rows, then assigns every row to the model that
// fits it best.
State drawn_start(const Rows& rows, const VectorXd& least, int modes, Index near, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  MatrixXd error(rows.rows(), modes);
  for (int k = 0; k < modes; ++k) {
    const auto centre = static_cast<Index>(random() % static_cast<std::uint64_t>(rows.rows()));
    const auto run = std::find_if(rows.runs.begin(), rows.runs.end(), [&](const auto& r) { return centre < r.end; });
    const Index first = std::max(run->begin, std::min(centre - near / 2, run->end - near));
    VectorXd weights = VectorXd::Zero(rows.rows());
    weights.segment(first, std::min(near, run->end - first)).setOnes();
    const MatrixXd residual = rows.y - rows.phi * fit_mode(rows, weights, least).theta;
    error.col(k) = residual.array().square().matrix() * least.cwiseInverse();
  }
  State state{{}, MatrixXd::Zero(rows.rows(), modes)};
  for (Index t = 0; t < rows.rows(); ++t) {
    Index best = 0;
    error.row(t).minCoeff(&best);
    state.weights(t, best) = 1;
  }
  MatrixXd steps = MatrixXd::Zero(modes, modes);
  for (const auto& run : rows.runs) {
    for (Index t = run.begin + 1; t < run.end; ++t)
      steps += state.weights.row(t - 1).transpose() * state.weights.row(t);
  }
  maximise(rows, least, steps, state);
  return state;
}

Result<State> best_of_starts(const Rows& rows, int modes, std::uint64_t seed, const Progress& progress) {
  const VectorXd least = min_variance(rows);
  const int starts = modes == 1 ? 1 : kStarts;
  State best;
  for (int start = 0; start < starts; ++start) {
    const std::string stage = "trying " + std::to_string(modes) + (modes == 1 ? " mode" : " modes");
    if (!go_on(progress, stage, static_cast<double>(start) / starts)) return Error{std::string(kStopped)};
    const Index near = Index{3} * row_size(rows) << (start % 2);
    State found = drawn_start(rows, least, modes, near, seed * 1000 + static_cast<std::uint64_t>(start));
    alternate(rows, least, kFirstRounds, {}, found);
    if (found.log_likelihood > best.log_likelihood) best = std::move(found);
  }
  if (!alternate(rows, least, kMaxRounds, progress, best)) return Error{std::string(kStopped)};
  return best;
}

// Sorts modes by the share of rows in which they act, largest first.
void sort_modes(State& state) {
  std::vector<Index> order(state.chain.modes.size());
  std::iota(order.begin(), order.end(), Index{0});
  const VectorXd share = state.weights.colwise().sum().transpose();
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return share(a) > share(b); });
  const Chain from = state.chain;
  for (std::size_t k = 0; k < order.size(); ++k) state.chain.modes[k] = from.modes[static_cast<std::size_t>(order[k])];
  state.chain.initial = from.initial(order);
  state.chain.transitions = from.transitions(order, order);
  state.weights = MatrixXd(state.weights(Eigen::all, order));
}

double gain_error(const std::vector<double>& better, const std::vector<double>& worse) {
  std::vector<double> gain(better.size());
  std::transform(better.begin(), better.end(), worse.begin(), gain.begin(), std::minus<>());
  return deviation(gain) / std::sqrt(static_cast<double>(std::max<std::size_t>(1, gain.size())));
}

std::vector<std::size_t> rows_of_modes(const std::vector<int>& modes, std::size_t count) {
  std::vector<std::size_t> rows(count, 0);
  for (const int mode : modes) ++rows[static_cast<std::size_t>(mode)];
  return rows;
}

struct Choice {
  std::vector<Candidate> candidates;
  int modes = 1;
  double gain = 0;  // log likelihood per held-out row, minus a single mode's
  double gain_std_error = 0;
};

// Fits each number of modes on the first part of each stretch and judges it on the rest. A number is taken where its
// gain over the last one taken is significant, or where the options request it.
Result<Choice> choose(const Rows& rows, const FitOptions& options, const Progress& progress) {
  const Rows learned = share_of(rows, 0, 1 - kHoldout), unseen = share_of(rows, 1 - kHoldout, 1);
  Choice out;
  std::vector<int> counts{1};
  if (options.modes > 1) counts.push_back(options.modes);
  for (int k = 2; options.modes == 0 && k <= kMaxTried; ++k) counts.push_back(k);
  std::vector<double> single, last, chosen;
  for (const int count : counts) {
    const bool few = static_cast<double>(learned.rows()) < count * min_rows(rows);
    if (few && count == options.modes) return Error{"too few rows come before the held-out ends for this many modes"};
    if (few) break;
    const auto found = best_of_starts(learned, count, options.seed, progress);
    if (!found) return found.error();
    const VectorXd each = believe(found->chain, unseen).log_likelihood;
    const std::vector<double> row(each.begin(), each.end());
    const auto acted = rows_of_modes(believe(found->chain, learned).likeliest(), static_cast<std::size_t>(count));
    Candidate candidate{count, found->log_likelihood / static_cast<double>(learned.rows()), mean(row)};
    candidate.determined = static_cast<double>(*std::min_element(acted.begin(), acted.end())) >= min_rows(rows);
    if (!last.empty()) candidate.gain_std_error = gain_error(row, last);
    out.candidates.push_back(candidate);
    last = row;
    if (single.empty()) single = chosen = row;
    const bool sure = mean(row) - mean(chosen) > kSureGain * gain_error(row, chosen);
    if (options.modes == count || (candidate.determined && sure)) {
      chosen = row;
      out.modes = count;
    }
  }
  out.gain = mean(chosen) - mean(single);
  out.gain_std_error = gain_error(chosen, single);
  return out;
}

// Standard errors of one mode's coefficients; the constant's is last.
std::vector<std::vector<double>> errors_of(const Rows& rows, const MatrixXd& theta, const VectorXd& weights) {
  std::vector<std::vector<double>> out;
  for (int i = 0; i < rows.outputs(); ++i) {
    const auto& columns = rows.design.groups[i].columns;
    const MatrixXd x = rows.phi(Eigen::all, columns);
    MatrixXd gram = x.transpose() * weights.asDiagonal() * x;
    const VectorXd scale = gram.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    gram = scale.asDiagonal() * gram * scale.asDiagonal();
    gram.diagonal().array() += 1e-9;
    const VectorXd inverse = symmetric_solutions(gram, MatrixXd::Identity(gram.rows(), gram.cols())).diagonal();
    const VectorXd residual = rows.y.col(i) - rows.phi * theta.col(i);
    const double free = std::max(1.0, weights.sum() - static_cast<double>(columns.size()));
    const double variance = (residual.array().square() * weights.array()).sum() / free;
    const VectorXd error = scale.cwiseProduct((variance * inverse).cwiseMax(0).cwiseSqrt());
    out.emplace_back(error.begin(), error.end());
  }
  return out;
}

using ModeErrors = std::vector<std::vector<std::vector<double>>>;  // [mode][output][coefficient]

// Whether no coefficient differs between any two modes by more than kDifferent standard errors. The assignment of rows
// to modes is taken as known, so the errors are slightly too small.
bool same_coefficients(const SwitchedArxModel& model, const ModeErrors& errors) {
  for (std::size_t b = 1; b < errors.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      for (std::size_t i = 0; i < errors[a].size(); ++i) {
        for (std::size_t c = 0; c < errors[a][i].size(); ++c) {
          const auto value = [&](const ArxMode& m) { return c < m.theta[i].size() ? m.theta[i][c] : m.constant[i]; };
          const double apart = std::abs(value(model.modes[a]) - value(model.modes[b]));
          if (apart > kDifferent * std::hypot(errors[a][i][c], errors[b][i][c])) return false;
        }
      }
    }
  }
  return true;
}

Usable verdict_of(const Summary& summary, const Choice& choice, double needed, bool noise_alone) {
  for (std::size_t k = 0; k < summary.mode_rows.size(); ++k) {
    if (static_cast<double>(summary.mode_rows[k]) >= needed) continue;
    return {false, "mode " + std::to_string(k) + " acts in " + std::to_string(summary.mode_rows[k]) +
                       " rows, too few for its coefficients; ask for fewer modes"};
  }
  if (summary.mode_rows.size() == 1) {
    return {false, choice.candidates.size() < 2
                       ? "a single mode was fitted and no further ones were tried: use an ARX model, or ask for modes"
                       : "further modes predict held-out rows no better than one does: use an ARX model"};
  }
  if (!(choice.gain > kSureGain * choice.gain_std_error)) {
    return {false, "a single ARX model predicts held-out rows as well: use that, or other orders"};
  }
  for (const double percent : summary.fit_percent) {
    if (percent < kUsableFit) return {false, "an output is hardly predicted one step ahead; try other orders"};
  }
  if (noise_alone) {
    return {true,
            "makes held-out rows likelier than a single ARX model does, by the size of its noise alone: its modes "
            "have the same coefficients, and an ARX model moves alike"};
  }
  return {true, "predicts held-out rows better than a single ARX model does"};
}

Result<void> check_request(const Rows& rows, const FitOptions& options) {
  if (options.modes < 0 || options.modes > static_cast<int>(kMaxArxModes)) {
    return Error{"the number of modes is " + std::to_string(options.modes) + ", expected 1 to 64"};
  }
  const double needed = min_rows(rows) * std::max(1, options.modes) / (1 - kHoldout);
  if (static_cast<double>(rows.rows()) >= needed) return {};
  return Error{"the recordings have " + std::to_string(rows.rows()) + " usable rows, expected at least " +
               std::to_string(static_cast<long>(std::ceil(needed))) + ": choose fewer modes or smaller orders"};
}

}  // namespace

Result<Fitted> fit(std::span<const Recording> recordings, const ChannelChoice& channels, const FitOptions& options,
                   const Progress& progress) {
  const auto rows = make_rows(recordings, channels, options.orders);
  if (!rows) return rows.error();
  if (auto ok = check_request(*rows, options); !ok) return ok.error();
  const auto choice = choose(*rows, options, progress);
  if (!choice) return choice.error();
  auto found = best_of_starts(*rows, choice->modes, options.seed, progress);
  if (!found) return found.error();
  sort_modes(*found);
  Fitted out;
  Summary& summary = out.summary;
  ModeErrors errors;
  for (std::size_t k = 0; k < found->chain.modes.size(); ++k) {
    Mode& mode = found->chain.modes[k];
    const VectorXd weights = found->weights.col(static_cast<Index>(k));
    errors.push_back(errors_of(*rows, mode.theta, weights));
    summary.mode_changed.push_back(limit_radius(kMaxRadius, *rows, weights, min_variance(*rows), mode));
  }
  out.model = model_of(found->chain, *rows);
  const bool noise_alone = same_coefficients(out.model, errors);
  for (std::size_t k = 0; k < errors.size(); ++k) {
    for (auto& row : errors[k]) row.pop_back();
    out.model.modes[k].std_error = std::move(errors[k]);
  }
  summary.mode_rows = rows_of_modes(believe(found->chain, *rows).likeliest(), out.model.modes.size());
  summary.candidates = choice->candidates;
  summary.samples_used = static_cast<std::size_t>(rows->rows());
  summary.held_out = static_cast<std::size_t>(share_of(*rows, 1 - kHoldout, 1).rows());
  std::vector<Recording> judged;  // recordings with a usable row
  for (std::size_t last = recordings.size(); const auto& place : rows->places) {
    if (std::exchange(last, place.recording) != place.recording) judged.push_back(recordings[place.recording]);
  }
  const auto percents = [&](int steps) { return figures(out.model, judged, channels, steps)->fit_percent; };
  summary.fit_percent = percents(1);
  if (!channels.inputs.empty()) summary.free_run_fit_percent = percents(kFreeRun);
  summary.usable = verdict_of(summary, *choice, min_rows(*rows), noise_alone);
  return out;
}

}  // namespace wisp::markov
