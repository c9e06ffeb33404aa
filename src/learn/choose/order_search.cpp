#include "learn/choose/order_search.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "learn/choose/search_fit.hpp"
#include "learn/fit/arx_report.hpp"
#include "learn/judge/prediction.hpp"
#include "learn/rows/arx_rows.hpp"

namespace wisp {
namespace {

constexpr int kMaxOrder = 4096;
constexpr std::size_t kMaxCandidates = 1'000'000;

std::size_t length(const OrderRange& range) { return static_cast<std::size_t>(range.last - range.first) + 1; }

Result<std::vector<OrderCandidate>> list_candidates(const ChannelChoice& channels, const SearchOptions& options) {
  for (const auto& [range, name] : {std::pair(options.na, "na"), {options.nb, "nb"}, {options.nk, "nk"}}) {
    if (range.first >= 0 && range.first <= range.last && range.last <= kMaxOrder) continue;
    return Error{std::string("the range of ") + name + " is " + std::to_string(range.first) + ":" +
                 std::to_string(range.last) + ", expected first <= last, both 0 to 4096"};
  }
  if (length(options.na) * length(options.nb) * length(options.nk) > kMaxCandidates) {
    return Error{"the grid has more than a million candidates; search it in parts"};
  }
  std::vector<OrderCandidate> list;
  UniformOrders uniform{.outputs = static_cast<int>(channels.outputs.size()),
                        .inputs = static_cast<int>(channels.inputs.size()),
                        .coupling = options.coupling};
  const OrderRange nb = channels.inputs.empty() ? OrderRange{0, 0} : options.nb;
  const OrderRange nk = channels.inputs.empty() ? OrderRange{0, 0} : options.nk;
  for (uniform.nk = nk.first; uniform.nk <= nk.last; ++uniform.nk) {
    for (uniform.na = options.na.first; uniform.na <= options.na.last; ++uniform.na) {
      for (uniform.nb = nb.first; uniform.nb <= nb.last; ++uniform.nb) {
        list.push_back({{}, make_orders(uniform), uniform.na, uniform.nb, uniform.nk});
      }
    }
  }
  return list;
}

double row_size(const OrderCandidate& candidate, int i, ArxOffset offset) {
  return candidate.orders.row_size(i) + (offset == ArxOffset::kEstimate ? 1 : 0);
}

// Fits and judges candidates on one set of columns.
class Search {
 public:
  Search(const Signals& signals, const Signals* validation, const SearchOptions& options,
         const std::vector<OrderCandidate>& candidates)
      : signals_(signals), validation_signals_(validation), options_(options), layout_(layout()) {
    int earliest = kMaxOrder * 2, latest = 0;
    for (const OrderCandidate& candidate : candidates) {
      latest = std::max(latest, candidate.orders.history());
      earliest = std::min(earliest, candidate.orders.history());
    }
    windows_.emplace(signals, layout_, earliest, latest);
    if (validation != nullptr && options.steps == 1) validation_.emplace(*validation, layout_, earliest, latest);
  }

  Result<void> judge(OrderCandidate& candidate) {
    const int first = candidate.orders.history();
    const std::vector<SharedRows> rows = shared_rows(candidate.orders, options_.offset, layout_);
    std::size_t most = 0;
    for (const SharedRows& part : rows) most = std::max(most, part.columns.size());
    candidate.rows = windows_->rows(first);
    if (candidate.rows <= most) return too_few(candidate, most);
    const CandidateFit fit = fit_candidate(*windows_, first, layout_, rows);
    candidate.determined = fit.determined;
    candidate.loss = losses(fit.residual_gram, candidate.rows);
    write_criteria(candidate, fit.residual_gram);
    if (validation_signals_ == nullptr) return {};
    if (options_.steps != 1) return judge_steps(candidate, fit.annihilator, first);
    const std::size_t validation_rows = validation_->rows(first);
    if (validation_rows == 0) return no_validation(candidate);
    candidate.loss_validation = losses(residual_gram_over(*validation_, first, fit.annihilator), validation_rows);
    return {};
  }

 private:
  // Layout of a model with the smallest delay and every lag up to the largest: it has the columns of all candidates.
  LagLayout layout() const {
    const int lags = options_.nb.last > 0 ? options_.nb.last + options_.nk.last - options_.nk.first : 0;
    return layout_of(make_orders({.outputs = signals_.outputs,
                                  .inputs = signals_.inputs,
                                  .na = options_.na.last,
                                  .nb = lags,
                                  .nk = options_.nk.first,
                                  .coupling = options_.coupling}));
  }

  std::vector<double> losses(const Eigen::MatrixXd& gram, std::size_t rows) const {
    std::vector<double> out(signals_.outputs);
    for (int i = 0; i < signals_.outputs; ++i) {
      out[i] = gram(i, i) / (static_cast<double>(rows) * signals_.scale[i] * signals_.scale[i]);
    }
    return out;
  }

  void write_criteria(OrderCandidate& candidate, const Eigen::MatrixXd& gram) const {
    std::vector<double> covariance;
    for (int i = 0; i < signals_.outputs; ++i) {
      for (int j = 0; j < signals_.outputs; ++j) {
        covariance.push_back(gram(i, j) /
                             (static_cast<double>(candidate.rows) * signals_.scale[i] * signals_.scale[j]));
      }
    }
    double coefficients = 0;
    for (int i = 0; i < signals_.outputs; ++i) coefficients += row_size(candidate, i, options_.offset);
    static_cast<Criteria&>(candidate) =
        criteria_of(covariance, signals_.outputs, static_cast<double>(candidate.rows), coefficients);
  }

  // The model in the data's units, about the operating point of the validation recordings.
  ArxModel model_of(const ArxOrders& orders, const Eigen::MatrixXd& annihilator) const {
    ArxModel model;
    model.orders = orders;
    model.theta.resize(signals_.outputs);
    model.constant.assign(signals_.outputs, 0.0);
    for (int i = 0; i < signals_.outputs; ++i) {
      for (const LaggedChannel& column : row_regressors(orders, i, options_.offset)) {
        const double weight = annihilator(layout_.find(column), i) / signals_.scale[i];
        if (column.channel == kConstantChannel) {
          model.constant[i] = -weight;
        } else {
          model.theta[i].push_back(-sign_of(column, signals_.outputs) * weight * signals_.scale[column.channel]);
        }
      }
    }
    const auto& offset = validation_signals_->offset;
    model.output_mean.assign(offset.begin(), offset.begin() + signals_.outputs);
    model.input_mean.assign(offset.begin() + signals_.outputs, offset.end());
    return model;
  }

  Result<void> judge_steps(OrderCandidate& candidate, const Eigen::MatrixXd& annihilator, int first) const {
    const ArxModel model = model_of(candidate.orders, annihilator);
    Signals in_units = *validation_signals_;
    std::fill(in_units.scale.begin(), in_units.scale.end(), 1.0);
    FigureOptions figures;
    figures.steps = {options_.steps};
    figures.first_sample = first;
    const auto result = figures_of(model, in_units, figures);
    if (!result) return no_validation(candidate);
    candidate.loss_validation = result->front().mean_square;
    return {};
  }

  static std::string name(const OrderCandidate& candidate) {
    return "candidate na " + std::to_string(candidate.na) + ", nb " + std::to_string(candidate.nb) + ", nk " +
           std::to_string(candidate.nk);
  }

  static Error too_few(const OrderCandidate& candidate, std::size_t most) {
    return Error{name(candidate) + " has " + std::to_string(most) + " coefficients an output and only " +
                 std::to_string(candidate.rows) + " rows to learn them from; search lower orders"};
  }

  static Error no_validation(const OrderCandidate& candidate) {
    return Error{name(candidate) +
                 " cannot predict a single row of the validation recordings; give it more of them with --validate"};
  }

  const Signals& signals_;
  const Signals* validation_signals_;
  const SearchOptions& options_;
  LagLayout layout_;
  std::optional<SearchWindows> windows_;
  std::optional<SearchWindows> validation_;
};

// Criteria that are sums over rows are divided by the number of rows, which may differ between candidates.
double value_of(const Criteria& criteria, OrderCriterion by, std::size_t rows) {
  constexpr double Criteria::*kFigures[] = {&Criteria::log_fpe, &Criteria::aic, &Criteria::aicc, &Criteria::bic};
  const double value = criteria.*kFigures[static_cast<std::size_t>(by)];
  return by == OrderCriterion::kFpe ? value : value / static_cast<double>(rows);
}

double value_of(const OrderCandidate& candidate, OrderCriterion by) {
  if (by != OrderCriterion::kValidation) return value_of(candidate, by, candidate.rows);
  double value = 0;
  for (double loss : candidate.loss_validation) value += std::log(loss);
  return value;
}

double value_of_row(const OrderCandidate& candidate, OrderCriterion by, int i, double d) {
  if (by == OrderCriterion::kValidation) return candidate.loss_validation[i];
  return value_of(criteria_of({&candidate.loss[i], 1}, 1, static_cast<double>(candidate.rows), d), by, candidate.rows);
}

template <class Value>
std::size_t least(const std::vector<OrderCandidate>& candidates, Value value) {
  std::size_t best = 0;
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const double at = value(candidates[c]);
    if (at < lowest) lowest = at, best = c;
  }
  return best;
}

void choose(const SearchOptions& options, int outputs, OrderSearch& search) {
  const auto& candidates = search.candidates;
  search.best = least(candidates, [&](const OrderCandidate& candidate) { return value_of(candidate, options.by); });
  for (int i = 0; i < outputs; ++i) {
    search.best_of_row.push_back(least(candidates, [&](const OrderCandidate& candidate) {
      return value_of_row(candidate, options.by, i, row_size(candidate, i, options.offset));
    }));
  }
}

// Validation recordings in the estimation's scaled units. kMean uses their own means, other offsets are shared.
Result<Signals> validation_signals(std::span<const Recording> recordings, const ChannelChoice& channels,
                                   const Signals& estimation, ArxOffset offset) {
  auto signals = gather_signals(recordings, channels, offset);
  if (!signals) return signals;
  signals->scale = estimation.scale;
  if (offset != ArxOffset::kMean) signals->offset = estimation.offset;
  return signals;
}

}  // namespace

Result<OrderSearch> search_orders(std::span<const Recording> estimation, std::span<const Recording> validation,
                                  const ChannelChoice& channels, const SearchOptions& options,
                                  const Progress& progress) {
  if (options.by == OrderCriterion::kValidation && validation.empty()) {
    return Error{"the best candidate by validation was requested without validation recordings"};
  }
  if (auto ok = check_steps({&options.steps, 1}); !ok) return ok.error();
  auto candidates = list_candidates(channels, options);
  if (!candidates) return candidates.error();
  const auto signals = gather_signals(estimation, channels, options.offset);
  if (!signals) return signals.error();
  for (int c = 0; c < signals->channels(); ++c) {
    if (signals->scale[c] == 0) return Error{"channel '" + signals->names[c] + "' never changes: leave it out"};
  }
  std::optional<Signals> other;
  if (!validation.empty()) {
    if (std::abs(validation.front().rate_hz / estimation.front().rate_hz - 1) > 1e-3)
      return Error{validation.front().source + ": has another rate than the recordings to learn from; resample it"};
    auto gathered = validation_signals(validation, channels, *signals, options.offset);
    if (!gathered) return gathered.error();
    other = std::move(*gathered);
  }
  Search judge(*signals, other ? &*other : nullptr, options, *candidates);
  for (std::size_t c = 0; c < candidates->size(); ++c) {
    const double share = static_cast<double>(c) / static_cast<double>(candidates->size());
    if (!go_on(progress, "searching orders", share)) return Error{std::string(kStopped)};
    if (auto ok = judge.judge((*candidates)[c]); !ok) return ok.error();
  }
  OrderSearch search;
  search.candidates = std::move(*candidates);
  choose(options, signals->outputs, search);
  return search;
}

std::vector<std::size_t> best_candidates(const OrderSearch& search, OrderCriterion by, std::size_t count) {
  std::vector<std::size_t> places(search.candidates.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::stable_sort(places.begin(), places.end(), [&](std::size_t a, std::size_t b) {
    return value_of(search.candidates[a], by) < value_of(search.candidates[b], by);
  });
  places.resize(std::min(count, places.size()));
  return places;
}

}  // namespace wisp
