#include "learn/arx/simulation/refine.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "learn/arx/rows/arx_design.hpp"
#include "learn/numeric/decompositions.hpp"
#include "learn/numeric/lag_gram.hpp"

namespace wisp::arx {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMaxRadius = 0.9999;  // of any step

}  // namespace

double OneStepLoss::value(const VectorXd& theta) const {
  double sum = 0;
  Index at = 0;
  for (std::size_t r = 0; r < products.size(); ++r) {
    const Index size = products[r].rows();
    const VectorXd moved = (theta - best).segment(at, size);
    sum += 1 + (least[r] > 0 ? moved.dot(products[r] * moved) / least[r] : 0);
    at += size;
  }
  return sum;
}

void OneStepLoss::add_to(const VectorXd& theta, double weight, GaussNewton& out) const {
  Index at = 0;
  for (std::size_t r = 0; r < products.size(); ++r) {
    const Index size = products[r].rows();
    const double share = least[r] > 0 ? weight / least[r] : 0;
    out.curvature.block(at, at, size, size) += share * products[r];
    out.gradient.segment(at, size) -= share * (products[r] * (theta - best).segment(at, size));
    at += size;
  }
}

MatrixXd OneStepLoss::batch_gradients(const VectorXd& theta, double weight, int batches) const {
  MatrixXd out = MatrixXd::Zero(theta.size(), batches);
  std::vector<RowPlan> parts(static_cast<std::size_t>(batches));
  const std::size_t share = (plan.rows + parts.size() - 1) / parts.size();
  std::size_t before = 0;
  for (const RowRun& run : plan.runs) {
    for (std::size_t begin = run.begin, next = 0; begin < run.end; begin = next) {
      const std::size_t batch = (before + begin - run.begin) / share;
      next = std::min(run.end, run.begin + (batch + 1) * share - before);
      parts[batch].runs.push_back({run.recording, begin, next});
    }
    before += run.end - run.begin;
  }
  for (std::size_t b = 0; b < parts.size(); ++b) {
    if (parts[b].runs.empty()) continue;
    const MatrixXd gram = lag_gram(signals, parts[b], design.layout, wanted_pairs(design));
    Index at = 0;
    for (std::size_t r = 0; r < columns.size(); ++r) {
      const auto size = Index(columns[r].size());
      const double scale = least[r] > 0 ? weight / least[r] : 0;
      const MatrixXd own = gram(columns[r], columns[r]);
      const VectorXd moment = gram.col(targets[r])(columns[r]);
      out.col(Index(b)).segment(at, size) += scale * (moment - own * theta.segment(at, size));
      at += size;
    }
  }
  return out;
}

OneStepLoss one_step_loss(const Signals& signals, const SimulationBlock& block, const OneStepOptions& options) {
  const ArxDesign design = make_design(options.orders, options.offset);
  OneStepLoss loss{signals, design, plan_rows(signals, design.layout, options.first_sample)};
  const MatrixXd gram = lag_gram(signals, loss.plan, design.layout, wanted_pairs(design));
  loss.best = VectorXd::Zero(Index(block.terms().size()));
  Index at = 0;
  for (int output : block.outputs()) {
    std::vector<int>& columns = loss.columns.emplace_back();
    for (const LaggedChannel& column : row_regressors(options.orders, output, options.offset)) {
      columns.push_back(design.layout.find(column));
    }
    const int target = design.layout.target(output);
    loss.targets.push_back(target);
    MatrixXd products = gram(columns, columns);
    products.diagonal() *= 1 + options.ridge;
    const VectorXd moment = gram.col(target)(columns);
    const VectorXd own = shortest_solution(products, moment);
    loss.best.segment(at, own.size()) = own;
    loss.least.push_back(std::max(gram(target, target) - own.dot(2 * moment - products * own), 0.0));
    at += own.size();
    loss.products.push_back(std::move(products));
  }
  return loss;
}

VectorXd drawn_in(const SimulationBlock& block, VectorXd theta, double most) {
  const double radius = block.radius(theta);
  if (!(radius > most)) return theta;
  for (std::size_t p = 0; p < block.terms().size(); ++p) {
    const BlockTerm& term = block.terms()[p];
    if (term.channel < block.size()) theta[Index(p)] *= std::pow(most / radius, term.lag);
  }
  return theta;
}

Refined refine(const SimulationBlock& block, const OneStepLoss& loss, const VectorXd& start,
               const RefineOptions& options) {
  constexpr double kMaxDamping = 1e12;
  const auto value_of = [&](const BlockSimulation& at) {
    return at.cost + (options.one_step_weight > 0 ? options.one_step_weight * loss.value(at.theta) : 0);
  };
  Refined now{simulate_block(block, drawn_in(block, start, kStartRadius)), 0, options.one_step_weight};
  now.value = value_of(now.simulation);
  double damping = 1e-3;
  for (int step = 0; step < options.steps && std::isfinite(now.value); ++step) {
    if (options.go_on && !options.go_on()) break;
    GaussNewton model = gauss_newton(block, now.simulation);
    if (options.one_step_weight > 0) loss.add_to(now.simulation.theta, options.one_step_weight, model);
    const VectorXd size = model.curvature.diagonal();
    if (!size.allFinite()) break;
    double gain = -1;
    for (; damping < kMaxDamping; damping *= 4) {
      MatrixXd damped = model.curvature;
      damped.diagonal() += damping * (size.array() + 1e-12 * size.maxCoeff()).matrix();
      const VectorXd theta = now.simulation.theta + symmetric_solution(damped, model.gradient);
      if (!theta.allFinite() || !(block.radius(theta) < kMaxRadius)) continue;
      BlockSimulation next = simulate_block(block, theta);
      const double value = value_of(next);
      if (!(value < now.value)) continue;
      gain = (now.value - value) / now.value;
      now = {std::move(next), value, options.one_step_weight};
      break;
    }
    damping = std::max(damping / 8, 1e-9);
    if (!(gain > options.tolerance)) break;
  }
  return now;
}

std::vector<Refined> drive_path(const SimulationBlock& block, const OneStepLoss& loss, const VectorXd& start,
                                std::span<const double> weights) {
  std::vector<Index> places;
  std::vector<BlockTerm> drive;
  for (std::size_t p = 0; p < block.terms().size(); ++p) {
    if (block.terms()[p].channel < block.size()) continue;
    places.push_back(Index(p));
    drive.push_back(block.terms()[p]);
  }
  const GaussNewton free = gauss_newton(block, simulate_block(block, start), drive);
  GaussNewton one_step{MatrixXd::Zero(start.size(), start.size()), VectorXd::Zero(start.size())};
  loss.add_to(start, 1, one_step);
  const MatrixXd curvature = one_step.curvature(places, places);
  const VectorXd gradient = one_step.gradient(places);
  const auto best_for = [&](double weight) {
    VectorXd theta = start;
    theta(places) += shortest_solution(free.curvature + weight * curvature, free.gradient + weight * gradient);
    return simulate_block(block, theta);
  };
  const double unit = best_for(0).cost / static_cast<double>(block.size());
  std::vector<Refined> path;
  for (double weight : weights) {
    Refined one{best_for(weight * unit), 0, weight * unit};
    one.value = one.simulation.cost + one.one_step_weight * loss.value(one.simulation.theta);
    path.push_back(std::move(one));
  }
  return path;
}

std::vector<Refined> refined_path(const SimulationBlock& block, const OneStepLoss& loss,
                                  const std::vector<VectorXd>& starts, std::span<const double> weights,
                                  const RefineOptions& options) {
  Refined free;
  free.value = std::numeric_limits<double>::infinity();
  for (const VectorXd& start : starts) {
    Refined one = refine(block, loss, start, options);
    if (one.value < free.value) free = std::move(one);
  }
  const double unit = free.value / static_cast<double>(block.size());  // of the error one step ahead
  const auto refined_from = [&](const VectorXd& from, double weight) {
    RefineOptions own = options;
    own.one_step_weight = weight * unit;
    return refine(block, loss, from, own);
  };
  std::vector<Refined> path(weights.size());
  VectorXd from = starts.front();
  for (std::size_t w = 0; w < weights.size(); ++w) {
    path[w] = weights[w] > 0 ? refined_from(from, weights[w]) : free;
    from = path[w].simulation.theta;
  }
  from = free.simulation.theta;
  for (std::size_t w = weights.size(); w-- > 0;) {
    if (weights[w] == 0) continue;
    Refined back = refined_from(from, weights[w]);
    from = back.simulation.theta;
    if (back.value < path[w].value) path[w] = std::move(back);
  }
  return path;
}

}  // namespace wisp::arx
