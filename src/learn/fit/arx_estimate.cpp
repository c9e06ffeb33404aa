#include "learn/fit/arx_estimate.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Householder>
#include <algorithm>
#include <cmath>

#include "learn/numeric/decompositions.hpp"
#include "learn/numeric/stream_kernels.hpp"
#include "learn/rows/lag_gram.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

// Maximum condition number for the Gram matrix. Standard errors keep nine digits: condition² · 2.2e-16 = 1e-9.
constexpr double kMaxConditionForGram = 2e3;

// A column of norm 1 counts as dependent if less than this remains after projecting out the columns before it: data are
// accurate to 1e-16, and rounding over the rows loses some digits.
constexpr double kNothingLeft = 1e-12;

// Minimum weight (columns have norm 1) of a column that is named as a cause of a dependent column.
constexpr double kPartOfDependence = 1e-6;

DependentColumn describe(const Eigen::MatrixXd& reduced, const std::vector<int>& kept, int column) {
  DependentColumn dependent{column, {}};
  const auto count = static_cast<Eigen::Index>(kept.size());
  const Eigen::MatrixXd factor = reduced(Eigen::seqN(0, count), kept);
  if (reduced.col(column).head(count).norm() <= kNothingLeft) return dependent;
  const Eigen::VectorXd weights = factor.triangularView<Eigen::Upper>().solve(reduced.col(column).head(count));
  for (Eigen::Index k = 0; k < count; ++k) {
    if (std::abs(weights[k]) > kPartOfDependence) dependent.of.push_back(kept[k]);
  }
  return dependent;
}

// Condition number, from eigenvalues of the Gram matrix if accurate, else from singular values (slower).
double condition_number(const Eigen::MatrixXd& matrix) {
  if (matrix.cols() == 0) return 1;
  const Eigen::MatrixXd gram = matrix.transpose() * matrix;
  const Eigen::VectorXd squares = symmetric_eigenvalues(gram);
  constexpr double kMaxSquare = 1e8;
  const double square = squares[squares.size() - 1] / squares[0];
  if (square > 0 && square < kMaxSquare) return std::sqrt(square);
  const Eigen::VectorXd values = singular_values(matrix);
  return values[0] / values[values.size() - 1];
}

// Computes the solution from the triangular factor of the kept columns, whose norms were scaled to 1.
SharedSolution finish(const SharedProblem& problem, const Eigen::MatrixXd& factor, const Eigen::MatrixXd& rotated,
                      const std::vector<int>& kept, const Eigen::VectorXd& norm) {
  const auto d = static_cast<Eigen::Index>(problem.columns.size());
  const auto count = static_cast<Eigen::Index>(kept.size());
  const auto upper = factor.triangularView<Eigen::Upper>();
  const Eigen::MatrixXd theta = upper.solve(rotated);
  const Eigen::MatrixXd root = upper.solve(Eigen::MatrixXd::Identity(count, count));
  const Eigen::MatrixXd inverse = root * root.transpose();
  SharedSolution solution;
  solution.theta = Eigen::MatrixXd::Zero(d, theta.cols());
  solution.inverse = Eigen::MatrixXd::Zero(d, d);
  Eigen::MatrixXd in_units = factor;
  for (Eigen::Index k = 0; k < count; ++k) {
    const int j = kept[k];
    solution.theta.row(j) = theta.row(k) / norm[j];
    in_units.col(k) *= norm[j] * problem.unit[j];
    for (Eigen::Index l = 0; l < count; ++l) solution.inverse(j, kept[l]) = inverse(k, l) / (norm[j] * norm[kept[l]]);
  }
  solution.scaled_condition = condition_number(factor);
  solution.condition = condition_number(in_units);
  return solution;
}

// Householder reduction, column by column, so that a dependent column depends only on earlier ones and can be named.
struct Reduction {
  Eigen::MatrixXd matrix;
  std::vector<int> kept;
  std::vector<DependentColumn> dependent;
};

Reduction reduce(Eigen::MatrixXd matrix, int regressors) {
  Reduction out;
  Eigen::VectorXd work(matrix.cols());
  for (int j = 0; j < regressors; ++j) {
    const auto row = static_cast<Eigen::Index>(out.kept.size());
    const Eigen::Index left = matrix.rows() - row;
    if (left == 0 || matrix.col(j).tail(left).norm() <= kNothingLeft) {
      out.dependent.push_back(describe(matrix, out.kept, j));
      continue;
    }
    double tau = 0;
    double beta = 0;
    Eigen::VectorXd essential(left - 1);
    matrix.col(j).tail(left).makeHouseholder(essential, tau, beta);
    matrix.bottomRightCorner(left, matrix.cols() - j).applyHouseholderOnTheLeft(essential, tau, work.data());
    matrix.col(j).tail(left - 1).setZero();
    out.kept.push_back(j);
  }
  out.matrix = std::move(matrix);
  return out;
}

// Solves with the Gram matrix of the whole regression. Returns nothing where the scaled condition number is too large
// or the matrix is not positive definite.
std::optional<SharedSolution> solve_with_gram(const Eigen::MatrixXd& gram, const SharedProblem& problem) {
  const auto d = static_cast<Eigen::Index>(problem.columns.size());
  Eigen::VectorXd norm(d);
  std::vector<int> all(problem.columns.size());
  for (Eigen::Index j = 0; j < d; ++j) {
    norm[j] = std::sqrt(gram(problem.columns[j], problem.columns[j]));
    if (!(norm[j] > 0)) return std::nullopt;
    all[j] = static_cast<int>(j);
  }
  Eigen::MatrixXd scaled = gram(problem.columns, problem.columns);
  scaled = norm.cwiseInverse().asDiagonal() * scaled * norm.cwiseInverse().asDiagonal();
  if (problem.prior.size() > 0) {
    const Eigen::MatrixXd prior = problem.prior * norm.cwiseInverse().asDiagonal();
    scaled += prior.transpose() * prior;
  }
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Upper> cholesky(scaled);
  if (cholesky.info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXd factor = cholesky.matrixU();
  const Eigen::MatrixXd moments = norm.cwiseInverse().asDiagonal() * gram(problem.columns, problem.targets);
  SharedSolution solution = finish(problem, factor, cholesky.matrixL().solve(moments), all, norm);
  if (!(solution.scaled_condition <= kMaxConditionForGram)) return std::nullopt;
  return solution;
}

// Prior precision factor of one output's coefficients; `products` has the products of all columns of the layout.
Eigen::MatrixXd prior_of(const SharedRows& rows, const ArxDesign& design, const Eigen::MatrixXd& products) {
  const int target = design.layout.target(rows.outputs.front());
  std::vector<arx::KernelBlock> blocks;
  int last = kConstantChannel;
  for (std::size_t p = 0; p < rows.columns.size(); ++p) {
    const int channel = design.layout[rows.columns[p]].channel;
    if (channel == kConstantChannel) continue;
    if (channel != last) blocks.push_back({static_cast<int>(p), 0});
    ++blocks.back().size;
    last = channel;
  }
  return arx::kernel_factor(
      {products(rows.columns, rows.columns), products(rows.columns, target), products(target, target), products(0, 0)},
      blocks);
}

bool has_kernel(const SharedRows& rows, const EstimateOptions& options) {
  const std::vector<int>& chosen = options.kernel_outputs;
  if (options.kernel == ArxKernel::kNone) return false;
  return chosen.empty() || std::find(chosen.begin(), chosen.end(), rows.outputs.front()) != chosen.end();
}

SharedProblem problem_of(const SharedRows& rows, const std::vector<double>& scale, const ArxDesign& design,
                         const EstimateOptions& options, const Eigen::MatrixXd& products) {
  SharedProblem problem{rows.columns, {}, Eigen::VectorXd(static_cast<Eigen::Index>(rows.columns.size())), {}};
  if (has_kernel(rows, options)) problem.prior = prior_of(rows, design, products);
  for (int output : rows.outputs) problem.targets.push_back(design.layout.target(output));
  for (std::size_t p = 0; p < rows.columns.size(); ++p) {
    const int channel = design.layout[rows.columns[p]].channel;
    const double factor = channel == kConstantChannel ? 1.0 : scale[channel];
    problem.unit[static_cast<Eigen::Index>(p)] = factor == 0 ? 0.0 : 1.0 / factor;
  }
  return problem;
}

// Effective number of coefficients: trace of (XᵀX + FᵀF)⁻¹ XᵀX, with F = problem.prior; without a prior, all of them.
double effective_number(const SharedProblem& problem, const SharedSolution& solution, const Eigen::MatrixXd& products) {
  const auto size = static_cast<double>(problem.columns.size());
  if (problem.prior.size() == 0) return size;
  return (solution.inverse * products(problem.columns, problem.columns)).trace();
}

// Residuals in the triangle's space: the triangle times [−θ; 1], one column per output.
Eigen::MatrixXd residuals_of(const Eigen::MatrixXd& triangle, const ArxDesign& design, const GroupThetas& theta) {
  Eigen::MatrixXd residuals(triangle.rows(), design.layout.outputs());
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    const SharedRows& rows = design.groups[g];
    for (std::size_t k = 0; k < rows.outputs.size(); ++k) {
      auto residual = residuals.col(rows.outputs[k]);
      residual = triangle.col(design.layout.target(rows.outputs[k]));
      for (std::size_t p = 0; p < rows.columns.size(); ++p) {
        residual -= theta[g](Eigen::Index(p), Eigen::Index(k)) * triangle.col(rows.columns[p]);
      }
    }
  }
  return residuals;
}

struct ResidualProducts {
  Eigen::MatrixXd gram;  // ny × ny: Σ r_i r_j
  GroupThetas gradient;  // Σ x r, laid out like the coefficients
};

// Computes products of the residuals for given coefficients in one pass over the data. Residuals are formed row by row,
// so their products do not suffer from cancellation.
ResidualProducts residual_products(const Signals& signals, const RowPlan& plan, const ArxDesign& design,
                                   const GroupThetas& theta) {
  ResidualProducts products{Eigen::MatrixXd::Zero(signals.outputs, signals.outputs), {}};
  for (const Eigen::MatrixXd& part : theta) {
    products.gradient.push_back(Eigen::MatrixXd::Zero(part.rows(), part.cols()));
  }
  ScaledBlock block(signals, design.layout.history());
  std::vector<std::vector<double>> residuals(std::size_t(signals.outputs), std::vector<double>(kBlockRows));
  const std::vector<double> ones(kBlockRows, 1.0);
  std::vector<const double*> series;
  const auto add = [&](const double* residual, auto sums) {
    Eigen::VectorXd more = Eigen::VectorXd::Zero(sums.size());
    add_products(residual, series, block.rows(), more.data());
    sums += more;
  };
  for_each_block(plan, [&](const RowRun& rows) {
    block.load(rows);
    for (std::size_t g = 0; g < design.groups.size(); ++g) {
      const SharedRows& group = design.groups[g];
      series.clear();
      for (int column : group.columns)
        series.push_back(column == 0 ? ones.data() : block.series(design.layout[column]));
      for (std::size_t k = 0; k < group.outputs.size(); ++k) {
        const Eigen::VectorXd weight = -theta[g].col(Eigen::Index(k));
        double* const residual = residuals[group.outputs[k]].data();
        combine(block.series({group.outputs[k], 0}), series, {weight.data(), series.size()}, block.rows(), residual);
        add(residual, products.gradient[g].col(Eigen::Index(k)));
      }
    }
    series.clear();
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      series.push_back(residuals[i].data());
      add(residuals[i].data(), products.gram.row(Eigen::Index(i)).head(Eigen::Index(i) + 1).transpose());
    }
  });
  products.gram.triangularView<Eigen::StrictlyUpper>() = products.gram.transpose();
  return products;
}

// Adds the refinement step to the coefficients, and its effect on products of residuals within groups to `products`.
// Returns the step's relative size.
double refine(const ArxDesign& design, const std::vector<SharedProblem>& problems, ResidualProducts& products,
              ArxEstimate& estimate) {
  double largest = 0;
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    SharedSolution& solution = estimate.groups[g];
    Eigen::MatrixXd slope = products.gradient[g];
    const Eigen::MatrixXd& prior = problems[g].prior;
    const bool drawn_in = prior.size() > 0;
    if (drawn_in) slope -= prior.transpose() * (prior * solution.theta);
    const Eigen::MatrixXd step = solution.inverse * slope;
    // (r − Xδ)ᵀ(r − Xδ) = rᵀr − δᵀXᵀr − rᵀXδ + δᵀXᵀXδ. Without a prior XᵀXδ = Xᵀr, and one of the three terms remains;
    // with a prior the last term, which is of second order, is neglected.
    const Eigen::MatrixXd change = step.transpose() * products.gradient[g];
    const std::vector<int>& outputs = design.groups[g].outputs;
    products.gram(outputs, outputs) -= drawn_in ? Eigen::MatrixXd(change + change.transpose()) : change;
    solution.theta += step;
    if (step.size() > 0) {
      largest = std::max(largest, step.cwiseAbs().maxCoeff() / std::max(solution.theta.cwiseAbs().maxCoeff(), 1e-300));
    }
  }
  return largest;
}

// Pairs of channels whose products the design's rows need; with `joint` all pairs.
ChannelPairs wanted_pairs(const ArxDesign& design, bool joint) {
  ChannelPairs wanted = ChannelPairs::Constant(design.layout.channels(), design.layout.channels(), joint);
  for (const SharedRows& group : design.groups) {
    std::vector<int> channels = group.outputs;
    for (int column : group.columns) {
      if (design.layout[column].channel != kConstantChannel) channels.push_back(design.layout[column].channel);
    }
    std::sort(channels.begin(), channels.end());
    channels.erase(std::unique(channels.begin(), channels.end()), channels.end());
    for (int a : channels) {
      for (int b : channels) wanted(a, b) = true;
    }
  }
  return wanted;
}

std::optional<ArxEstimate> try_gram(const Signals& signals, const RowPlan& plan, const ArxDesign& design,
                                    const EstimateOptions& options) {
  Eigen::MatrixXd gram = lag_gram(signals, plan, design.layout, wanted_pairs(design, options.joint));
  ArxEstimate estimate;
  std::vector<SharedProblem> problems;
  double condition = 1;
  for (const SharedRows& rows : design.groups) {
    const SharedProblem& problem = problems.emplace_back(problem_of(rows, signals.scale, design, options, gram));
    auto solution = solve_with_gram(gram, problem);
    if (!solution) return std::nullopt;
    condition = std::max(condition, solution->scaled_condition);
    estimate.effective.push_back(effective_number(problem, *solution, gram));
    estimate.groups.push_back(std::move(*solution));
  }
  // A refinement step reduces the coefficients' relative error to condition⁴ · 1e-32. For rows of different groups
  // there is no update formula for products of residuals, so these are recomputed unless the step is negligible.
  constexpr double kNegligible = 1e-13;
  ResidualProducts products;
  for (int pass = 0; pass < 3; ++pass) {
    products = residual_products(signals, plan, design, estimate.thetas());
    const double step = refine(design, problems, products, estimate);
    if (step < kNegligible || design.groups.size() == 1) break;
  }
  estimate.residual_gram = products.gram;
  estimate.target_square.resize(signals.outputs);
  for (int i = 0; i < signals.outputs; ++i) {
    const int target = design.layout.target(i);
    estimate.target_square[i] = gram(target, target) - gram(0, target) * gram(0, target) / gram(0, 0);
  }
  estimate.method = "normal equations from the lag structure, refined with residuals from the data (condition " +
                    number_text(condition, 2) + ")";
  if (options.joint) estimate.gram = std::move(gram);
  estimate.residual_gram_at = [&](const GroupThetas& theta) {
    return residual_products(signals, plan, design, theta).gram;
  };
  return estimate;
}

}  // namespace

SharedSolution solve_with_triangle(const Eigen::MatrixXd& triangle, const SharedProblem& problem) {
  const auto d = static_cast<Eigen::Index>(problem.columns.size());
  const auto targets = static_cast<Eigen::Index>(problem.targets.size());
  const Eigen::Index rows = triangle.rows();
  const Eigen::Index prior = problem.prior.rows();
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(rows + prior, d + targets);
  Eigen::VectorXd norm(d);
  for (Eigen::Index j = 0; j < d; ++j) {
    const auto column = triangle.col(problem.columns[j]);
    norm[j] = column.norm();
    if (norm[j] > 0) stacked.col(j).head(rows) = column / norm[j];
    if (prior > 0 && norm[j] > 0) stacked.col(j).tail(prior) = problem.prior.col(j) / norm[j];
  }
  for (Eigen::Index i = 0; i < targets; ++i) stacked.col(d + i).head(rows) = triangle.col(problem.targets[i]);

  Reduction reduction = reduce(std::move(stacked), static_cast<int>(d));
  const auto count = static_cast<Eigen::Index>(reduction.kept.size());
  const Eigen::MatrixXd factor = reduction.matrix(Eigen::seqN(0, count), reduction.kept);
  SharedSolution solution = finish(problem, factor, reduction.matrix.block(0, d, count, targets), reduction.kept, norm);
  solution.dependent = std::move(reduction.dependent);
  return solution;
}

GroupThetas ArxEstimate::thetas() const {
  GroupThetas all;
  for (const SharedSolution& solution : groups) all.push_back(solution.theta);
  return all;
}

ArxEstimate estimate_from_data(const Signals& signals, const RowPlan& plan, const ArxDesign& design,
                               const EstimateOptions& options) {
  if (auto estimate = try_gram(signals, plan, design, options)) return std::move(*estimate);
  return estimate_from_triangle(triangle_by_qr(signals, plan, design.layout), signals.scale, design, options);
}

ArxEstimate estimate_from_triangle(const Eigen::MatrixXd& triangle, const std::vector<double>& scale,
                                   const ArxDesign& design, const EstimateOptions& options) {
  ArxEstimate estimate;
  double condition = 1;
  const Eigen::MatrixXd products = triangle.transpose() * triangle;
  for (const SharedRows& rows : design.groups) {
    const SharedProblem problem = problem_of(rows, scale, design, options, products);
    estimate.groups.push_back(solve_with_triangle(triangle, problem));
    estimate.effective.push_back(effective_number(problem, estimate.groups.back(), products));
    condition = std::max(condition, estimate.groups.back().scaled_condition);
  }
  const Eigen::MatrixXd residuals = residuals_of(triangle, design, estimate.thetas());
  estimate.residual_gram = residuals.transpose() * residuals;
  estimate.target_square.resize(design.layout.outputs());
  const double rows = triangle.col(0).squaredNorm();
  for (int i = 0; i < design.layout.outputs(); ++i) {
    const auto target = triangle.col(design.layout.target(i));
    const double sum = triangle.col(0).dot(target);
    estimate.target_square[i] = target.squaredNorm() - sum * sum / rows;
  }
  if (options.joint) estimate.gram = products;
  estimate.method = "Householder QR by blocks of rows (condition " + number_text(condition, 2) + ")";
  estimate.residual_gram_at = [triangle, &design](const GroupThetas& theta) {
    const Eigen::MatrixXd at = residuals_of(triangle, design, theta);
    return Eigen::MatrixXd(at.transpose() * at);
  };
  return estimate;
}

}  // namespace wisp
