#include "learn/judge/arx_verdict.hpp"

#include <algorithm>
#include <cmath>

#include "learn/fit/arx_report.hpp"
#include "learn/numeric/constants.hpp"
#include "record/number_text.hpp"

namespace wisp::arx {
namespace {

constexpr double kMinSimulationFit = 40;     // percent of fit in free simulation, for models with inputs
constexpr double kMinSkill = 5;              // minimum percent by which the squared error is below those of
                                             // persistence and of the mean, for models without inputs
constexpr double kMinRowsACoefficient = 10;  // rows per coefficient of an output
constexpr double kMaxMoved = 10;             // maximum standard errors by which stabilisation moves a coefficient
constexpr double kSameSample = 0.25;         // correlation above which an input counts as acting without delay
constexpr double kTrace = 1e-4;              // share of the output's variance below which an effect may be rounding
constexpr double kSetByOutput = 95;  // percent of an input explained by an output, above which its response is in doubt
constexpr double kMaxLostInPlay = 1;  // percentage points of fit that single precision may lose

// Above this multiple of its 95 % bound, a residual's correlation with the input of the same sample counts.
constexpr double kTimesBound = 2.5;

std::string too_few_rows(const VerdictEvidence&, const ArxSummary& summary) {
  const auto& numbers = summary.effective;
  const int most = numbers.empty() ? 0 : int(std::ceil(*std::max_element(numbers.begin(), numbers.end()) - 1e-9));
  const auto rows = static_cast<double>(summary.rows);
  if (most == 0 || rows >= kMinRowsACoefficient * most) return "";
  return std::to_string(summary.rows) + " rows are too few for " + std::to_string(most) +
         " coefficients an output: fewer than " + number_text(kMinRowsACoefficient, 3) +
         " a coefficient; record more, or lower the orders";
}

std::string repaired_far(const VerdictEvidence&, const ArxSummary& summary) {
  if (!summary.stable.changed || summary.stable.moved <= kMaxMoved) return "";
  return "to make the estimate stable a coefficient was moved by " + number_text(summary.stable.moved, 3) +
         " standard errors: the model is not what the data say; try other orders, or fewer coupled outputs";
}

std::string acts_at_once(const VerdictEvidence& evidence, const ArxSummary& summary) {
  if (!evidence.least_squares) return "";
  for (int i = 0; i < evidence.orders.outputs(); ++i) {
    for (int k = 0; k < evidence.orders.inputs(); ++k) {
      if (evidence.orders.nk(i, k) == 0 || evidence.orders.nb(i, k) == 0) continue;
      const Independence& pair = evidence.least_squares->independence[std::size_t(i)][std::size_t(k)];
      const double own = std::abs(pair.correlation[pair.correlation.size() / 2]);
      if (own < kSameSample || own < kTimesBound * pair.bound) continue;
      const double left = 1 - summary.fit_percent[std::size_t(i)] / 100;
      if (own * own * left * left < kTrace) continue;
      return "input '" + evidence.channels.inputs[std::size_t(k)] + "' acts on '" +
             evidence.channels.outputs[std::size_t(i)] +
             "' in the same sample (the residual's correlation with it is " + number_text(own, 2) + "): try --nk 0";
    }
  }
  return "";
}

// Whether a remark explains a poor simulation. It does not where the model's lags or integrators already cover it.
bool explains(const Remark& remark, const VerdictEvidence& evidence) {
  if (remark.kind >= RemarkKind::kClock) return false;
  const auto place = [&](const std::vector<std::string>& names) {
    return int(std::find(names.begin(), names.end(), remark.channel) - names.begin());
  };
  if (remark.kind == RemarkKind::kIntegrates) {
    const auto i = std::size_t(place(evidence.channels.outputs));
    return i >= evidence.integrators.size() || evidence.integrators[i] == 0;
  }
  if (remark.kind == RemarkKind::kDelay) {
    const int k = place(evidence.channels.inputs);
    for (int i = 0; i < evidence.orders.outputs(); ++i) {
      if (evidence.orders.nk(i, k) + evidence.orders.nb(i, k) > remark.size) return false;
    }
  }
  return true;
}

// Text of the first remark that explains a poor simulation, with its remedy.
std::string cause_in(const VerdictEvidence& evidence) {
  if (!evidence.remarks) return "; look for the cause with wisp info, or try other orders or inputs";
  for (const Remark& one : evidence.remarks()) {
    if (explains(one, evidence)) return ": " + one.cause + "; " + one.cure;
  }
  return "; the recording shows no cause (wisp info): try --focus auto, which tries many lags, or other inputs";
}

std::string simulates_badly(const VerdictEvidence& evidence, const ArxSummary& summary) {
  const bool held_out = !evidence.held_out.empty();
  const std::vector<double>& fits = held_out ? evidence.held_out : summary.free_run_fit_percent;
  std::string failing;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (fits[i] >= kMinSimulationFit) continue;
    failing += (failing.empty() ? "" : ", ") + ("'" + evidence.channels.outputs[i] + "' " + fit_text(fits[i]));
  }
  if (failing.empty()) return "";
  return "free simulation " + std::string(held_out ? "of held-out rows " : "from the input ") + "fits " + failing +
         ", and at least " + number_text(kMinSimulationFit, 3) + " % is needed" + cause_in(evidence);
}

// Finds an output whose fit falls in single precision, in which the model is played: large coefficients cancel.
std::string plays_otherwise(const VerdictEvidence& evidence, const ArxSummary& summary) {
  for (std::size_t i = 0; i < summary.played_fit_percent.size(); ++i) {
    const double lost = summary.free_run_fit_percent[i] - summary.played_fit_percent[i];
    if (summary.free_run_fit_percent[i] < kMinSimulationFit || lost <= kMaxLostInPlay) continue;
    return "played in single precision, as the model is stored, '" + evidence.channels.outputs[i] + "' fits " +
           fit_text(summary.played_fit_percent[i]) + " and not " + fit_text(summary.free_run_fit_percent[i]) +
           ": large coefficients cancel, or it moves far from 0" + cause_in(evidence);
  }
  return "";
}

// Reports redundant inputs: least squares divides coefficients arbitrarily between them, however well the model fits.
std::string is_redundant(const VerdictEvidence& evidence, const ArxSummary&) {
  return evidence.redundant.empty() ? "" : evidence.redundant.front().cause + "; " + evidence.redundant.front().cure;
}

// Where an input is set by the output (feedback), or both merely drift alike, the recording does not determine the
// response, however well the model fits.
std::string is_doubtful(const VerdictEvidence& evidence, const ArxSummary&) {
  if (!evidence.doubts) return "";
  for (const Remark& one : evidence.doubts())
    if (one.kind != RemarkKind::kFeedback || one.size >= kSetByOutput) return one.cause + "; " + one.cure;
  return "";
}

std::string has_no_skill(const VerdictEvidence& evidence, const ArxSummary& summary) {
  if (!summary.free_run_fit_percent.empty() || evidence.orders.inputs() > 0) return "";
  for (std::size_t i = 0; i < summary.fit_percent.size(); ++i) {
    const double left = 1 - summary.fit_percent[i] / 100;
    const double against_mean = 100 * (1 - left * left);
    double skill = against_mean;
    if (i < evidence.persistence.size() && evidence.persistence[i] > 0) {
      skill = std::min(skill, 100 * (1 - summary.loss[i] / evidence.persistence[i]));
    }
    if (skill >= kMinSkill) continue;
    return "output '" + evidence.channels.outputs[i] + "' is predicted no better than by its " +
           (skill < against_mean ? "last sample" : "mean") + ": its squared error is less by " +
           number_text(std::max(skill, 0.0), 2) + " %, and at least " + number_text(kMinSkill, 2) + " % is needed";
  }
  return "";
}

}  // namespace

std::vector<double> persistence_errors(std::span<const Recording> recordings, const ChannelChoice& channels) {
  std::vector<double> out;
  for (const std::string& name : channels.outputs) {
    double sum = 0, rows = 0;
    for (const Recording& recording : recordings) {
      const auto& samples = recording.channels[*find_channel(recording, name)].samples;
      for (const Episode& episode : episodes(recording)) {
        for (std::size_t t = episode.begin + 1; t < episode.end; ++t) {
          const double change = samples[t] - samples[t - 1];
          if (!std::isnan(change)) sum += change * change, ++rows;
        }
      }
    }
    out.push_back(rows > 0 ? sum / rows : kMissing);
  }
  return out;
}

void judge_use(const VerdictEvidence& evidence, ArxSummary& summary) {
  if (!summary.usable.verdict) return;
  for (const auto finds_fault : {is_redundant, too_few_rows, repaired_far, plays_otherwise, acts_at_once,
                                 simulates_badly, has_no_skill, is_doubtful}) {
    std::string reason = finds_fault(evidence, summary);
    if (reason.empty()) continue;
    summary.usable = {false, std::move(reason)};
    return;
  }
  if (summary.free_run_fit_percent.empty()) return;
  const bool held_out = !evidence.held_out.empty();
  const auto& fits = held_out ? evidence.held_out : summary.free_run_fit_percent;
  summary.usable.reason +=
      std::string(", and free simulation ") + (held_out ? "of held-out rows " : "of the rows learned from ") + "fits " +
      number_text(*std::min_element(fits.begin(), fits.end()), 3) + (fits.size() > 1 ? " % or more" : " %");
}

}  // namespace wisp::arx
