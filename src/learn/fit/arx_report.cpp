#include "learn/fit/arx_report.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "learn/numeric/chi_squared.hpp"
#include "learn/numeric/decompositions.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

// ln det computed from correlations, so that the channels' units cause no overflow or underflow. The pivot of an output
// that depends on others is a rounding error: with a floor such determinants can be compared.
double log_determinant(std::span<const double> covariance, int outputs) {
  constexpr double kRoundingPivot = 1e-12;
  const auto at = [&](int i, int j) { return covariance[static_cast<std::size_t>(i) * outputs + j]; };
  if (outputs == 1) return std::log(at(0, 0));
  Eigen::MatrixXd correlation(outputs, outputs);
  double log = 0;
  for (int i = 0; i < outputs; ++i) {
    log += std::log(at(i, i));
    for (int j = 0; j < outputs; ++j) {
      const double size = std::sqrt(at(i, i)) * std::sqrt(at(j, j));
      correlation(i, j) = size > 0 ? at(i, j) / size : 0;
    }
  }
  return log + Eigen::LDLT<Eigen::MatrixXd>(correlation).vectorD().array().max(kRoundingPivot).log().sum();
}

// Inverse of a channel's scale; 0 for the scale 0 of a constant channel.
double inverse_or_zero(double value) { return value == 0 ? 0.0 : 1.0 / value; }

double scale_of(const FitFacts& facts, const LaggedChannel& column) {
  return column.channel == kConstantChannel ? 1.0 : facts.scale[column.channel];
}

// The model in scaled units, without means.
ArxModel scaled_model(const FitFacts& facts, const ArxDesign& design, const ArxEstimate& estimate) {
  ArxModel model;
  model.orders = facts.options.orders;
  model.theta.resize(facts.outputs);
  model.constant.assign(facts.outputs, 0.0);
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    const SharedRows& rows = design.groups[g];
    for (std::size_t k = 0; k < rows.outputs.size(); ++k) {
      for (std::size_t p = 0; p < rows.columns.size(); ++p) {
        const LaggedChannel column = design.layout[rows.columns[p]];
        const double theta = estimate.groups[g].theta(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(k));
        if (column.channel == kConstantChannel) {
          model.constant[rows.outputs[k]] = theta;
        } else {
          model.theta[rows.outputs[k]].push_back(sign_of(column, facts.outputs) * theta);
        }
      }
    }
  }
  return model;
}

GroupThetas thetas_of(const FitFacts& facts, const ArxDesign& design, const ArxModel& scaled) {
  GroupThetas all;
  for (const SharedRows& rows : design.groups) {
    Eigen::MatrixXd& theta = all.emplace_back(rows.columns.size(), rows.outputs.size());
    for (std::size_t k = 0; k < rows.outputs.size(); ++k) {
      for (std::size_t p = 0; p < rows.columns.size(); ++p) {
        const LaggedChannel column = design.layout[rows.columns[p]];
        theta(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(k)) =
            column.channel == kConstantChannel ? scaled.constant[rows.outputs[k]]
                                               : sign_of(column, facts.outputs) * scaled.theta[rows.outputs[k]][p];
      }
    }
  }
  return all;
}

// (XᵀX)⁻¹ of every output row, for coefficients with the signs of the model.
std::vector<Eigen::MatrixXd> inverses(const FitFacts& facts, const ArxDesign& design, const ArxEstimate& estimate) {
  std::vector<Eigen::MatrixXd> all(facts.outputs);
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    const SharedRows& rows = design.groups[g];
    Eigen::VectorXd sign(static_cast<Eigen::Index>(rows.columns.size()));
    for (std::size_t p = 0; p < rows.columns.size(); ++p) {
      sign[static_cast<Eigen::Index>(p)] = sign_of(design.layout[rows.columns[p]], facts.outputs);
    }
    for (int output : rows.outputs) {
      all[output] = sign.asDiagonal() * estimate.groups[g].inverse * sign.asDiagonal();
    }
  }
  return all;
}

// Converts the model from scaled units to the data's units.
void to_units(const FitFacts& facts, const ArxDesign& design, ArxModel& model) {
  for (const SharedRows& rows : design.groups) {
    for (int output : rows.outputs) {
      const double own = inverse_or_zero(facts.scale[output]);
      model.constant[output] *= own;
      for (std::size_t p = 0; p < model.theta[output].size(); ++p) {
        model.theta[output][p] *= own * scale_of(facts, design.layout[rows.columns[p]]);
      }
    }
  }
  model.output_mean.assign(facts.offset.begin(), facts.offset.begin() + facts.outputs);
  model.input_mean.assign(facts.offset.begin() + facts.outputs, facts.offset.end());
}

// Scaled standard error of a coefficient in the unconstrained estimate: the square root of its element of s² (XᵀX)⁻¹,
// s² = Σr²/(n − d).
double scaled_error(const FitFacts& facts, const ArxEstimate& estimate, std::size_t group, int output, std::size_t p) {
  const auto index = static_cast<Eigen::Index>(p);
  const double freedom = static_cast<double>(facts.rows) - estimate.effective[group];
  return std::sqrt(estimate.residual_gram(output, output) / freedom * estimate.groups[group].inverse(index, index));
}

void write_std_errors(const FitFacts& facts, const ArxDesign& design, const ArxEstimate& estimate, ArxModel& model) {
  model.std_error.resize(facts.outputs);
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    const SharedRows& rows = design.groups[g];
    for (int output : rows.outputs) {
      const double own = inverse_or_zero(facts.scale[output]);
      for (std::size_t p = 0; p < rows.columns.size(); ++p) {
        const LaggedChannel column = design.layout[rows.columns[p]];
        if (column.channel == kConstantChannel) continue;
        model.std_error[output].push_back(scaled_error(facts, estimate, g, output, p) * own * scale_of(facts, column));
      }
    }
  }
}

void write_effective(const ArxDesign& design, const ArxEstimate& estimate, ArxSummary& summary) {
  summary.effective.resize(std::size_t(design.layout.outputs()));
  summary.condition.resize(summary.effective.size());
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    for (int output : design.groups[g].outputs) {
      summary.effective[std::size_t(output)] = estimate.effective[g];
      summary.condition[std::size_t(output)] = estimate.groups[g].condition;
    }
  }
}

void write_criteria(const FitFacts& facts, ArxSummary& summary) {
  const double n = static_cast<double>(facts.rows);
  double coefficients = 0;
  for (int i = 0; i < facts.outputs; ++i) {
    const double d = summary.effective[std::size_t(i)];
    coefficients += d;
    summary.row_fpe.push_back(summary.loss[i] * (1 + d / n) / (1 - d / n));
  }
  static_cast<Criteria&>(summary) = criteria_of(summary.noise_covariance, facts.outputs, n, coefficients);
}

void write_loss(const FitFacts& facts, const ArxEstimate& estimate, const Eigen::MatrixXd& residual_gram,
                ArxSummary& summary) {
  const double n = static_cast<double>(facts.rows);
  for (int i = 0; i < facts.outputs; ++i) {
    const double own = inverse_or_zero(facts.scale[i]);
    for (int j = 0; j < facts.outputs; ++j) {
      summary.noise_covariance.push_back(residual_gram(i, j) / n * own * inverse_or_zero(facts.scale[j]));
    }
    summary.loss.push_back(residual_gram(i, i) / n * own * own);
    const double explained = std::sqrt(residual_gram(i, i) / estimate.target_square[i]);
    summary.fit_percent.push_back(estimate.target_square[i] > 0 ? 100 * (1 - explained) : 0);
  }
}

void write_noise(const FitFacts& facts, const ArxSummary& summary, ArxModel& model) {
  for (int i = 0; i < facts.outputs; ++i) {
    const double freedom = static_cast<double>(facts.rows) - summary.effective[std::size_t(i)];
    const double sd = std::sqrt(summary.loss[i] * static_cast<double>(facts.rows) / freedom);
    model.noise.sd.push_back(sd);
    model.noise.sd_ci95.push_back({sd * std::sqrt(freedom / chi_squared_quantile(0.975, freedom)),
                                   sd * std::sqrt(freedom / chi_squared_quantile(0.025, freedom))});
  }
}

// Factors that convert coefficients in scaled units, with prediction signs, to the model's coefficients.
Eigen::VectorXd factors(const FitFacts& facts, const ArxDesign& design, const SharedRows& rows, int output,
                        Eigen::Index size) {
  Eigen::VectorXd out(size);
  for (Eigen::Index p = 0; p < size; ++p) {
    const LaggedChannel column = design.layout[rows.columns[p]];
    out[p] = sign_of(column, facts.outputs) * scale_of(facts, column) * inverse_or_zero(facts.scale[output]);
  }
  return out;
}

// cov(θ_i, θ_j) = s_ij P_i X_iᵀX_j P_j with P = (XᵀX)⁻¹ and s the noise covariance. Under a kernel a row's own block is
// the posterior covariance s_ii P_i, which includes the bias of the prior.
std::vector<double> joint_covariance(const FitFacts& facts, const ArxDesign& design, const ArxEstimate& estimate,
                                     const ArxModel& model) {
  const auto starts = row_starts(model);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> joint(starts.back(), starts.back());
  for (const SharedRows& left : design.groups) {
    for (const SharedRows& right : design.groups) {
      const bool after = facts.options.kernel != ArxKernel::kNone && &left == &right;
      const Eigen::MatrixXd& p = estimate.groups[&left - design.groups.data()].inverse;
      const Eigen::MatrixXd& q = estimate.groups[&right - design.groups.data()].inverse;
      const Eigen::MatrixXd between = after ? p : p * estimate.gram(left.columns, right.columns) * q;
      const double mean_size = 0.5 * (estimate.effective[std::size_t(&left - design.groups.data())] +
                                      estimate.effective[std::size_t(&right - design.groups.data())]);
      for (int i : left.outputs) {
        for (int j : right.outputs) {
          const Eigen::Index rows = starts[i + 1] - starts[i];
          const Eigen::Index columns = starts[j + 1] - starts[j];
          const double noise = estimate.residual_gram(i, j) / (static_cast<double>(facts.rows) - mean_size);
          joint.block(starts[i], starts[j], rows, columns) =
              noise * (factors(facts, design, left, i, rows).asDiagonal() * between.topLeftCorner(rows, columns) *
                       factors(facts, design, right, j, columns).asDiagonal());
        }
      }
    }
  }
  return {joint.data(), joint.data() + joint.size()};
}

std::string lag_text(const FitFacts& facts, const LaggedChannel& column) {
  if (column.channel == kConstantChannel) return "the constant";
  return "'" + facts.names[column.channel] + "' at lag " + std::to_string(column.lag);
}

std::string dependence(const FitFacts& facts, const ArxDesign& design, const SharedRows& rows,
                       const DependentColumn& dependent) {
  const std::string what = lag_text(facts, design.layout[rows.columns[dependent.column]]);
  if (dependent.of.empty()) return what + " never changes: it does not excite the system";
  constexpr std::size_t kMaxNamed = 6;
  std::string list;
  for (std::size_t k = 0; k < std::min(dependent.of.size(), kMaxNamed); ++k) {
    list += (k ? ", " : "") + lag_text(facts, design.layout[rows.columns[dependent.of[k]]]);
  }
  if (dependent.of.size() > kMaxNamed) list += " and " + std::to_string(dependent.of.size() - kMaxNamed) + " more";
  return what + (dependent.of.size() == 1 ? " tells the same as " : " is a combination of ") + list;
}

void name_rank_problems(const FitFacts& facts, const ArxDesign& design, const ArxEstimate& estimate,
                        ArxSummary& summary) {
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    const SharedRows& rows = design.groups[g];
    for (const DependentColumn& dependent : estimate.groups[g].dependent) {
      const LaggedChannel column = design.layout[rows.columns[dependent.column]];
      for (int output : rows.outputs) {
        summary.rank_problems.push_back({output,
                                         column.channel == kConstantChannel ? "constant" : facts.names[column.channel],
                                         column.lag, dependence(facts, design, rows, dependent)});
      }
    }
  }
}

// Scales the poles of one output's A; B and the constant move to their conditional optimum for that A.
void scale_row(const Eigen::MatrixXd& inverse, double factor, int output, ArxModel& model) {
  std::vector<double>& theta = model.theta[output];
  std::vector<double> moved;
  for (int j = 0; j < model.orders.outputs(); ++j) {
    double power = factor;
    for (int lag = 0; lag < model.orders.na(output, j); ++lag, power *= factor) {
      moved.push_back(theta[moved.size()] * (power - 1));
    }
  }
  const auto own = std::ssize(moved);
  const Eigen::VectorXd push =
      ranked_solution(inverse.topLeftCorner(own, own), Eigen::Map<const Eigen::VectorXd>(moved.data(), own)).x;
  const Eigen::VectorXd follow = inverse.bottomLeftCorner(inverse.rows() - own, own) * push;
  for (Eigen::Index k = 0; k < own; ++k) theta[k] += moved[k];
  for (Eigen::Index k = 0; k < follow.size(); ++k) {
    const auto place = static_cast<std::size_t>(own + k);
    (place < theta.size() ? theta[place] : model.constant[output]) += follow[k];
  }
}

// Stability is checked, and restored where needed, on coefficients rounded to single precision, as they are stored.
void settle_stability(const FitFacts& facts, const std::vector<Eigen::MatrixXd>& inverse, ArxModel& scaled,
                      ArxStability& stable) {
  stable.estimated = stable.radius = spectral_radius(scaled);
  const double share = 1 - facts.options.stability_margin;
  for (double most = share; facts.options.stabilise && stable.radius >= 1; most *= share) {
    make_stable(scaled, inverse, most, facts.drawn_in);
    stable.radius = spectral_radius(scaled);
    stable.changed = true;
  }
}

// Largest difference between two models' coefficients, in standard errors, all in scaled units.
double largest_move(const FitFacts& facts, const ArxDesign& design, const ArxEstimate& estimate, const ArxModel& before,
                    const ArxModel& after) {
  double largest = 0;
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    for (int output : design.groups[g].outputs) {
      for (std::size_t p = 0; p < before.theta[output].size(); ++p) {
        const double sd = scaled_error(facts, estimate, g, output, p);
        if (sd > 0) largest = std::max(largest, std::abs(after.theta[output][p] - before.theta[output][p]) / sd);
      }
    }
  }
  return largest;
}

double loss_factor(const Eigen::MatrixXd& with, const Eigen::MatrixXd& without) {
  double log = 0;
  for (Eigen::Index i = 0; i < with.rows(); ++i) {
    if (without(i, i) > 0) log += std::log(with(i, i) / without(i, i)) / static_cast<double>(with.rows());
  }
  return std::exp(log);
}

// Percent: an output with at least kPromise one step ahead, but less than kKept in free simulation, gets a warning.
constexpr double kPromise = 80, kKept = 60;

// Warns of outputs with a good one-step fit but a poor free-run fit, where both are known.
void warn_of_free_run(const std::vector<std::string>& outputs, ArxSummary& summary) {
  for (std::size_t i = 0; i < summary.free_run_fit_percent.size(); ++i) {
    const double one_step = summary.fit_percent[i], free_run = summary.free_run_fit_percent[i];
    if (one_step < kPromise || free_run >= kKept) continue;
    summary.warnings.push_back("output '" + outputs[i] + "': one step ahead the fit is " + fit_text(one_step) +
                               ", but free simulation from the input fits " + (free_run > kDiverges ? "only " : "") +
                               fit_text(free_run) + "; judge this model by simulation, and try other orders or delays");
  }
}

}  // namespace

std::string fit_text(double percent) {
  return percent > kDiverges ? number_text(percent, 3) + " %" : "nothing: it diverges";
}

std::vector<Eigen::Index> row_starts(const ArxModel& model) {
  std::vector<Eigen::Index> starts{0};
  for (const auto& row : model.theta) starts.push_back(starts.back() + static_cast<Eigen::Index>(row.size()));
  return starts;
}

Eigen::MatrixXd companion_of(const ArxModel& model, const std::vector<int>& outputs) {
  int order = 0;
  for (int value : model.orders.na.values()) order = std::max(order, value);
  const Eigen::Index count = std::ssize(outputs), states = count * order;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(states, states);
  for (Eigen::Index r = 0; r < count; ++r) {
    for (Eigen::Index c = 0; c < count; ++c) {
      const auto a = model.a(outputs[r], outputs[c]);
      for (Eigen::Index lag = 0; lag < std::ssize(a); ++lag) companion(r, lag * count + c) = -a[lag];
    }
  }
  for (Eigen::Index r = count; r < states; ++r) companion(r, r - count) = 1;
  return companion;
}

void make_stable(ArxModel& model, const std::vector<Eigen::MatrixXd>& inverse, double max_radius, double share) {
  for (const std::vector<int>& outputs : coupled_outputs(model.orders.na)) {
    const Eigen::MatrixXd companion = companion_of(model, outputs);
    const double radius = companion.size() > 0 ? eigenvalues(companion).cwiseAbs().maxCoeff() : 0;
    if (radius <= max_radius) continue;
    for (int output : outputs) scale_row(inverse[output], share * max_radius / radius, output, model);
  }
}

Criteria criteria_of(std::span<const double> covariance, int outputs, double rows, double coefficients) {
  const double log_det = log_determinant(covariance, outputs);
  const double share = coefficients / outputs / rows;
  Criteria out;
  out.fpe = std::exp(log_det) * (1 + share) / (1 - share);
  out.log_fpe = log_det + std::log((1 + share) / (1 - share));
  out.fpe_total = std::exp(log_det) * (1 + coefficients / rows) / std::max(1 - coefficients / rows, 0.0);
  out.aic = rows * log_det + 2 * coefficients;
  const double left = rows - coefficients - 1;
  out.aicc =
      left > 0 ? out.aic + 2 * coefficients * (coefficients + 1) / left : std::numeric_limits<double>::infinity();
  out.bic = rows * log_det + coefficients * std::log(rows);
  return out;
}

ArxFit report_fit(const FitFacts& facts, const ArxDesign& design, ArxEstimate estimate) {
  ArxFit fit;
  ArxSummary& summary = fit.summary;
  fit.model = scaled_model(facts, design, estimate);
  const ArxModel estimated = fit.model;
  settle_stability(facts, inverses(facts, design, estimate), fit.model, summary.stable);
  Eigen::MatrixXd residual_gram = estimate.residual_gram;
  if (summary.stable.changed) {
    residual_gram = estimate.residual_gram_at(thetas_of(facts, design, fit.model));
    summary.stable.loss_factor = loss_factor(residual_gram, estimate.residual_gram);
    summary.stable.moved = largest_move(facts, design, estimate, estimated, fit.model);
  }
  to_units(facts, design, fit.model);
  write_std_errors(facts, design, estimate, fit.model);
  if (facts.options.covariance) fit.covariance = joint_covariance(facts, design, estimate, fit.model);
  write_loss(facts, estimate, residual_gram, summary);
  write_effective(design, estimate, summary);
  write_criteria(facts, summary);
  write_noise(facts, summary, fit.model);
  name_rank_problems(facts, design, estimate, summary);
  static_cast<RowCounts&>(summary) = facts;
  summary.method = std::move(estimate.method);
  return fit;
}

void judge_fit(const FitFacts& facts, ArxSummary& summary) {
  summary.usable = {true, "all coefficients are determined by the data and the model is stable"};
  std::vector<std::string>& warnings = summary.warnings;
  for (const RankProblem& problem : summary.rank_problems) {
    if (std::find(warnings.begin(), warnings.end(), problem.reason) == warnings.end())
      warnings.push_back(problem.reason);
  }
  if (summary.stable.changed) {
    warnings.push_back("the estimate was unstable (spectral radius " + number_text(summary.stable.estimated, 4) +
                       ") and was made stable (" + number_text(summary.stable.radius, 4) +
                       "); the squared one-step error grew by " +
                       number_text(100 * (summary.stable.loss_factor - 1), 2) +
                       " %; stability alone moves no coefficient by more than " + number_text(summary.stable.moved, 2) +
                       " standard errors");
  }
  warn_of_free_run(facts.names, summary);
  for (int i = 0; i < facts.outputs; ++i) {
    if (facts.scale[i] != 0) continue;
    summary.usable = {false, "output '" + facts.names[i] + "' never changes: there is nothing to learn"};
    return;
  }
  if (!summary.rank_problems.empty()) {
    summary.usable = {false, "the data cannot tell all coefficients: " + summary.rank_problems.front().reason};
  } else if (!(summary.stable.radius < 1)) {
    summary.usable = {false, "the model is unstable: spectral radius " + number_text(summary.stable.radius, 4)};
  }
}

}  // namespace wisp
