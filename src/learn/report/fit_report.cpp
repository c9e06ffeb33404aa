#include "learn/report/fit_report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "learn/judge/response.hpp"
#include "learn/report/report_values.hpp"
#include "record/number_text.hpp"

namespace wisp::arx {
namespace {

constexpr int kMaxStates = 256;         // above this, computing eigenvalues takes too long for a description
constexpr int kMaxStatesForZeros = 48;  // limit for zeros, which are computed for every pair of channels
constexpr int kMaxStatesTold = 12;
constexpr int kMaxCoefficientsTold = 60;

int states_of(const ArxModel& model) {
  int longest = 0;
  for (int order : model.orders.na.values()) longest = std::max(longest, order);
  return longest * model.orders.outputs();
}

ReportList places(const std::vector<std::complex<double>>& values) {
  ReportList list;
  for (const auto& value : values) list.push_back(ReportList{value.real(), value.imag()});
  return list;
}

std::string pole_text(std::complex<double> pole, double rate_hz) {
  const double radius = std::abs(pole);
  const std::string place = "|z| " + number_text(radius, 4);
  if (radius == 0) return "a pure delay (z = 0)";
  const std::complex<double> s = std::log(pole) * rate_hz;
  if (pole.imag() == 0 && pole.real() > 0) {
    return s.real() < 0 ? place + ": time constant " + number_text(-1 / s.real(), 3) + " s"
                        : place + ": does not decay";
  }
  const double natural = std::abs(s);
  return place + ": " + number_text(std::abs(s.imag()) / (2 * std::numbers::pi), 3) + " Hz, damping ratio " +
         number_text(-s.real() / natural, 2);
}

// Adds the coefficients of one output's equation, named by their terms: y(t-1), u(t-3).
void tell_row(const ArxModel& model, const Model& of, int i, ReportSection& section) {
  std::size_t at = 0;
  const auto tell_one = [&](const char* matrix, const std::string& channel, int lag) {
    const double error = model.std_error.empty() ? 0 : model.std_error[i][at];
    add_line(section, std::string(matrix) + "  " + channel + "(t-" + std::to_string(lag) + ")", model.theta[i][at],
             model.std_error.empty() ? "" : "± " + number_text(error, 3));
    ++at;
  };
  for (int j = 0; j < model.orders.outputs(); ++j) {
    for (int lag = 1; lag <= model.orders.na(i, j); ++lag) tell_one("A", of.outputs[j].name, lag);
  }
  for (int k = 0; k < model.orders.inputs(); ++k) {
    for (int l = 0; l < model.orders.nb(i, k); ++l) tell_one("B", of.inputs[k].name, model.orders.nk(i, k) + l);
  }
}

void add_quality(const ArxSummary& summary, std::size_t outputs, ReportSection& section) {
  add(section, "fit_percent.1", summary.fit_percent, "fit one step ahead", "%", "100 is perfect, 0 is the mean");
  if (!summary.free_run_fit_percent.empty()) {
    add(section, "fit_percent.inf", summary.free_run_fit_percent, "fit of free simulation", "%",
        "from the input alone: how it will play");
  }
  add(section, "V", summary.loss, "residual variance V");
  add(section, "noise_covariance", matrix_of(summary.noise_covariance, outputs));
  add(section, "fpe", summary.fpe, "FPE", "",
      "expected variance on unseen rows: of models of the same data, less is better");
  add(section, "fpe_total", summary.fpe_total);
  add(section, "aic", summary.aic, "AIC");
  add(section, "aicc", summary.aicc);
  add(section, "bic", summary.bic, "BIC");
  add(section, "row_fpe", summary.row_fpe);
}

void add_data(const ArxSummary& summary, ReportSection& section) {
  add(section, "samples_used", summary.rows, "rows learned from");
  add_all(section, "", "first_sample", summary.first_sample, "episodes.used", summary.episodes_used, "episodes.skipped",
          summary.episodes_skipped, "rows_left_out", summary.rows_left_out);
  add(section, "condition", *std::max_element(summary.condition.begin(), summary.condition.end()), "condition", "",
      "of the regressors, in the data's units");
  add_all(section, "", "row_condition", summary.condition, "effective_coefficients", summary.effective, "method",
          summary.method);
}

void add_stability(const ArxStability& stable, ReportSection& section) {
  add(section, "stable.radius", stable.radius, "spectral radius", "", stable.changed ? "made stable" : "");
  add_all(section, "stable.", "changed", stable.changed, "estimated_radius", stable.estimated, "loss_factor",
          stable.loss_factor, "moved_std_errors", stable.moved);
}

ReportTable rank_problems(const std::vector<RankProblem>& problems) {
  ReportTable table{"undetermined", "", {{"row", ""}, {"channel", ""}, {"lag", ""}, {"reason", ""}}, {}};
  for (const RankProblem& problem : problems) {
    table.rows.push_back({problem.row, problem.channel, problem.lag, problem.reason});
  }
  return table;
}

// Figures of a candidate, as entries; their ids and labels also head the columns of the tables.
std::vector<ReportEntry> figures_of(const OrderCandidate& one) {
  return {{"na", one.na, "na", ""},
          {"nb", one.nb, "nb", ""},
          {"nk", one.nk, "nk", ""},
          {"V", one.loss, "V", ""},
          {"fpe", one.fpe, "FPE", ""},
          {"aic", one.aic, "AIC", ""},
          {"aicc", one.aicc, "", ""},
          {"bic", one.bic, "BIC", ""},
          {"samples_used", one.rows, "rows", ""},
          {"determined", one.determined, "", ""},
          {"V_validation", list_or_none(one.loss_validation), "V on validation rows", ""}};
}

void add_row(const OrderCandidate& one, ReportTable& table) {
  auto& row = table.rows.emplace_back();
  for (ReportEntry& figure : figures_of(one)) row.push_back(std::move(figure.value));
}

constexpr std::size_t kMaxTold = 10;  // maximum number of orders shown to people

std::string orders_text(const OrderCandidate& candidate) {
  return "na " + std::to_string(candidate.na) + ", nb " + std::to_string(candidate.nb) + ", nk " +
         std::to_string(candidate.nk);
}

std::string p_text(double p) { return p < 0.0001 ? "p < 0.0001" : "p " + number_text(p, 2); }

// Adds one series of correlations, and its bound under chance.
void add_correlations(const std::string& id, const std::string& label, const std::vector<double>& values, int first_lag,
                      double bound, ReportSection& section) {
  ReportSeries series{id, label, "lag, samples", "correlation", {}, values};
  for (std::size_t k = 0; k < values.size(); ++k) series.x.push_back(first_lag + static_cast<double>(k));
  const std::vector<double> ends{series.x.front(), series.x.back()};
  section.series.push_back(std::move(series));
  section.series.push_back(
      {id + ".bound", "95 % lie within by chance", "lag, samples", "correlation", ends, {bound, bound}});
}

}  // namespace

void describe(const ArxModel& model, const std::string& prefix, ReportSection& section) {
  CoefficientLists theta = lists_of(model.orders, model.theta);
  add_all(section, prefix, "A", std::move(theta.a), "B", std::move(theta.b));
  if (!model.std_error.empty()) {
    CoefficientLists errors = lists_of(model.orders, model.std_error);
    add_all(section, prefix + "std_error.", "A", std::move(errors.a), "B", std::move(errors.b));
  }
  const int states = states_of(model);
  add(section, prefix + "poles", states <= kMaxStates ? ReportValue(places(poles(model))) : ReportValue());
  add(section, prefix + "zeros",
      states <= kMaxStatesForZeros && model.orders.history() <= kMaxStates
          ? ReportValue(per_pair(model.orders, [&](int i, int k) { return places(zeros(model, i, k)); }))
          : ReportValue());
  const std::vector<double> rest{0.0};
  add(section, prefix + "static_gain",
      per_pair(model.orders, [&](int i, int k) { return frequency_response(model, i, k, rest).value.front().real(); }));
}

void tell_poles(const ArxModel& model, double rate_hz, Report& report) {
  if (states_of(model) > kMaxStatesTold) return;
  ReportSection& section = report.add("Poles");
  for (const auto& pole : poles(model)) {
    if (pole.imag() >= 0) add_line(section, "pole", pole_text(pole, rate_hz));  // one of each conjugate pair
  }
}

void tell(const ArxModel& model, const Model& of, Report& report) {
  int count = 0;
  for (int i = 0; i < model.orders.outputs(); ++i) count += model.orders.row_size(i);
  for (int i = 0; count <= kMaxCoefficientsTold && i < model.orders.outputs(); ++i) {
    tell_row(model, of, i, report.add("Coefficients of " + of.outputs[i].name + ", ± standard error"));
  }
  if (count > kMaxCoefficientsTold) add_line(report.add("Coefficients"), "number", count, "too many to show here");
  tell_poles(model, of.rate_hz, report);
}

void add_fit(const ArxFit& fit, const Model& model, Report& report) {
  const ArxSummary& summary = fit.summary;
  report.verdict = ReportVerdict{summary.usable.verdict, summary.usable.reason};
  report.warnings.insert(report.warnings.end(), summary.warnings.begin(), summary.warnings.end());
  tell(fit.model, model, report);
  ReportSection& section = report.add("Fit");
  add_orders(fit.model.orders, "", section);
  describe(fit.model, "", section);
  add_all(section, "", "constant", fit.model.constant, "operating_point.outputs", fit.model.output_mean,
          "operating_point.inputs", fit.model.input_mean);
  add_quality(summary, model.outputs.size(), section);
  add_data(summary, section);
  add_stability(summary.stable, section);
  section.tables.push_back(rank_problems(summary.rank_problems));
}

void add_search(const OrderSearch& search, const std::vector<std::string>& outputs, OrderCriterion by, Report& report) {
  ReportSection& section = report.add("Orders");
  const OrderCandidate& best = search.candidates[search.best];
  add_line(section, "best of " + std::to_string(search.candidates.size()), orders_text(best));
  ReportTable all{"candidates", "", {}, {}};  // too long for a screen, so for programs only
  for (const ReportEntry& figure : figures_of(best)) {
    add(section, "best." + figure.id, figure.value);
    all.columns.push_back({figure.id, figure.label});
  }
  add(section, "best.index", search.best);
  ReportTable first{"", "the best and its runners-up", all.columns, {}};
  for (const OrderCandidate& one : search.candidates) add_row(one, all);
  for (std::size_t c : best_candidates(search, by, kMaxTold)) add_row(search.candidates[c], first);
  section.tables.push_back(std::move(all));
  section.tables.push_back(std::move(first));
  ReportTable rows{"best_of_output",
                   outputs.size() > 1 ? "best for every output alone" : "",
                   {{"name", "output"}, {"na", "na"}, {"nb", "nb"}, {"nk", "nk"}, {"index", ""}},
                   {}};
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const OrderCandidate& own = search.candidates[search.best_of_row[i]];
    rows.rows.push_back({outputs[i], own.na, own.nb, own.nk, search.best_of_row[i]});
  }
  section.tables.push_back(std::move(rows));
}

ReportSection focus_section(const FocusOutcome& focused, const std::vector<std::string>& outputs) {
  ReportSection section{"Focus"};
  add(section, "focus.chosen", focused.changed ? "simulation" : "prediction", "focus", "", focused.reason);
  add(section, "focus.reason", focused.reason);
  ReportTable table{
      "focus.outputs",
      focused.choices.empty() ? "" : "free runs over held-out rows, error as a share of the output's size",
      {{"outputs", "outputs"},
       {"chosen", "chosen"},
       {"error", "from fitted states", "%"},
       {"error_measured", "from measured ones", "%"},
       {"error_least_squares", "least squares, fitted", "%"},
       {"error_least_squares_measured", "measured", "%"}},
      {}};
  for (const FocusChoice& choice : focused.choices) {
    if (choice.candidates.empty()) continue;
    const bool all = outputs.size() > 1 && choice.outputs.size() == outputs.size();
    std::string names = all ? "all" : "";
    for (int output : all ? std::vector<int>{} : choice.outputs)
      names += (names.empty() ? "" : ", ") + outputs[std::size_t(output)];
    const FocusCandidate &own = choice.candidates[choice.chosen], &squares = choice.candidates.front();
    std::string word = own.kernel_lags > 0 ? std::to_string(own.kernel_lags) + " lags under a kernel" : "least squares";
    if (own.decoupled) word += ", on its own";
    table.rows.push_back({names, word, 100 * own.estimated_error, 100 * own.measured_error,
                          100 * squares.estimated_error, 100 * squares.measured_error});
  }
  section.tables.push_back(std::move(table));
  return section;
}

void add_test_series(const ResidualTests& tests, const ChannelChoice& channels, ReportSection& section) {
  for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
    const std::string id = "residual." + std::to_string(i) + ".";
    const Whiteness& white = tests.whiteness[i];
    add_correlations(id + "white", "Residual of " + channels.outputs[i] + ", white? " + p_text(white.p),
                     white.correlation, 1, white.bound, section);
    for (std::size_t k = 0; k < channels.inputs.size(); ++k) {
      const Independence& pair = tests.independence[i][k];
      add_correlations(id + std::to_string(k), "… independent of " + channels.inputs[k] + "? " + p_text(pair.p),
                       pair.correlation, -static_cast<int>(pair.correlation.size() / 2), pair.bound, section);
    }
  }
}

void add_tests(const ResidualTests& tests, const ChannelChoice& channels, Report& report) {
  constexpr double kSurprise = 0.05;
  ReportSection& section = report.add("Residuals");
  ReportList white, independent;
  bool all_above = true, independent_of_all = true;
  for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
    white.emplace_back(tests.whiteness[i].p);
    all_above = all_above && tests.whiteness[i].p >= kSurprise;
    ReportList row;
    for (const Independence& pair : tests.independence[i]) {
      row.emplace_back(pair.p);
      independent_of_all = independent_of_all && pair.p >= kSurprise;
    }
    independent.push_back(std::move(row));
  }
  add(section, "whiteness_p", std::move(white), "white, p", "",
      all_above ? "as white noise would be" : "below 0.05: the model leaves something to learn");
  add(section, "independence_p", std::move(independent), channels.inputs.empty() ? "" : "independent of the inputs, p",
      "", independent_of_all ? "as unrelated series would be" : "below 0.05: the inputs do more than the model says");
  add_test_series(tests, channels, section);
}

}  // namespace wisp::arx
