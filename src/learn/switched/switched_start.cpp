#include "learn/switched/switched_start.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "learn/numeric/clustering.hpp"
#include "learn/numeric/decompositions.hpp"

namespace wisp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRidge = 1e-9;     // of scaled regressors, so that a column that a mode never sees is 0
constexpr Index kMaxLocals = 800;   // local models; clusters need no more
constexpr double kSureShare = 0.7;  // of local models that vote: others lie across a boundary
constexpr double kPlaceWeight = 2;  // of a local model's place, against its coefficients in standard errors

struct LocalModel {
  Index centre = 0;
  MatrixXd theta;
  MatrixXd variance;  // of theta's entries
  double unsure = 0;  // mean ln variance of its residuals
};

// The rows that belong together with row `centre`: near in the space of regressors, or in time.
std::vector<Index> rows_near(const SwitchedRows& rows, Switching switching, Index centre, Index count) {
  std::vector<Index> near;
  if (switching == Switching::kMarkov) {
    const auto run = std::find_if(rows.runs.begin(), rows.runs.end(), [&](const auto& r) { return centre < r.end; });
    const Index first = std::max(run->begin, std::min(centre - count / 2, run->end - count));
    for (Index t = first; t < std::min(first + count, run->end); ++t) near.push_back(t);
    return near;
  }
  const VectorXd distance = (rows.phi.rowwise() - rows.phi.row(centre)).rowwise().squaredNorm();
  near.resize(static_cast<std::size_t>(rows.rows()));
  std::iota(near.begin(), near.end(), Index{0});
  std::nth_element(near.begin(), near.begin() + count - 1, near.end(),
                   [&](Index a, Index b) { return distance(a) < distance(b); });
  near.resize(static_cast<std::size_t>(count));
  return near;
}

LocalModel local_model(const SwitchedRows& rows, Switching switching, Index centre, Index count) {
  const auto near = rows_near(rows, switching, centre, std::min(count, rows.rows()));
  LocalModel local{centre, MatrixXd::Zero(rows.phi.cols(), rows.outputs()),
                   MatrixXd::Zero(rows.phi.cols(), rows.outputs())};
  for (int i = 0; i < rows.outputs(); ++i) {
    const auto& columns = rows.columns[i];
    const MatrixXd x = rows.phi(near, columns);
    const VectorXd y = rows.y(near, i);
    MatrixXd gram = x.transpose() * x;
    gram.diagonal().array() += 1e-6 * static_cast<double>(near.size());
    const VectorXd theta = symmetric_solution(gram, x.transpose() * y);
    const double free = std::max<double>(1, static_cast<double>(near.size()) - static_cast<double>(columns.size()));
    const double variance = (y - x * theta).squaredNorm() / free + 1e-12;
    const VectorXd spread = symmetric_solutions(gram, MatrixXd::Identity(gram.rows(), gram.cols())).diagonal();
    for (std::size_t c = 0; c < columns.size(); ++c) {
      local.theta(columns[c], i) = theta(static_cast<Index>(c));
      local.variance(columns[c], i) = variance * spread(static_cast<Index>(c));
    }
    local.unsure += std::log(variance) / rows.outputs();
  }
  return local;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// One row of features a local model: coefficients in units of their typical standard error and, for regions, its place.
std::vector<double> features_of(const SwitchedRows& rows, Switching switching, const std::vector<LocalModel>& locals,
                                std::size_t& columns) {
  std::vector<std::vector<double>> by_column;
  for (int i = 0; i < rows.outputs(); ++i) {
    for (int c : rows.columns[i]) {
      std::vector<double> errors, values;
      for (const LocalModel& local : locals) {
        errors.push_back(std::sqrt(local.variance(c, i)));
        values.push_back(local.theta(c, i));
      }
      const double unit = std::max(median(errors), 1e-9);
      for (double& value : values) value /= unit;
      by_column.push_back(std::move(values));
    }
  }
  if (switching == Switching::kRegions) {
    for (Index c = 1; c < rows.phi.cols(); ++c) {
      std::vector<double>& values = by_column.emplace_back();
      for (const LocalModel& local : locals) values.push_back(kPlaceWeight * rows.phi(local.centre, c));
    }
  }
  columns = by_column.size();
  std::vector<double> features;
  for (std::size_t r = 0; r < locals.size(); ++r) {
    for (const auto& column : by_column) features.push_back(column[r]);
  }
  return features;
}

// Every row's nearest among some rows: by regressors, or in time.
std::vector<int> nearest_label(const SwitchedRows& rows, Switching switching, const std::vector<LocalModel>& locals,
                               const std::vector<std::uint16_t>& label) {
  std::vector<int> out;
  for (Index t = 0; t < rows.rows(); ++t) {
    double least = 1e300;
    std::size_t best = 0;
    for (std::size_t l = 0; l < locals.size(); ++l) {
      const Index centre = locals[l].centre;
      const double distance = switching == Switching::kMarkov ? std::abs(static_cast<double>(t - centre))
                                                              : (rows.phi.row(t) - rows.phi.row(centre)).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      best = l;
    }
    out.push_back(label[best]);
  }
  return out;
}

}  // namespace

Eigen::MatrixXd weighted_theta(const SwitchedRows& rows, const Eigen::VectorXd& weights) {
  MatrixXd gram = rows.phi.transpose() * weights.asDiagonal() * rows.phi;
  const MatrixXd right = rows.phi.transpose() * weights.asDiagonal() * rows.y;
  gram.diagonal().array() += kRidge * (1 + weights.sum());
  MatrixXd theta = MatrixXd::Zero(rows.phi.cols(), rows.outputs());
  for (int i = 0; i < rows.outputs(); ++i) {
    const auto& columns = rows.columns[i];
    const MatrixXd own = gram(columns, columns);
    const VectorXd solved = symmetric_solution(own, right(columns, i));
    for (std::size_t c = 0; c < columns.size(); ++c) theta(columns[c], i) = solved(static_cast<Index>(c));
  }
  return theta;
}

std::vector<int> clustered_start(const SwitchedRows& rows, Switching switching, int modes, int neighbours,
                                 std::uint64_t seed) {
  const Index count = std::min<Index>(kMaxLocals, rows.rows());
  std::vector<LocalModel> locals;
  for (Index k = 0; k < count; ++k) {
    locals.push_back(local_model(rows, switching, k * rows.rows() / count, neighbours));
  }
  const auto sure = std::max<std::size_t>(static_cast<std::size_t>(modes),
                                          static_cast<std::size_t>(kSureShare * static_cast<double>(locals.size())));
  std::sort(locals.begin(), locals.end(), [](const auto& a, const auto& b) { return a.unsure < b.unsure; });
  locals.resize(std::min(sure, locals.size()));
  std::size_t columns = 0;
  const auto features = features_of(rows, switching, locals, columns);
  const auto found = k_means(features, columns, {.clusters = modes, .restarts = 3, .threads = 1, .seed = seed});
  if (!found) return drawn_start(rows, switching, modes, neighbours, seed);
  return nearest_label(rows, switching, locals, found->cluster);
}

std::vector<int> drawn_start(const SwitchedRows& rows, Switching switching, int modes, int neighbours,
                             std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::vector<int> out(static_cast<std::size_t>(rows.rows()), 0);
  VectorXd least = VectorXd::Constant(rows.rows(), 1e300);
  for (int k = 0; k < modes; ++k) {
    const auto centre = static_cast<Index>(generator() % static_cast<std::uint64_t>(rows.rows()));
    const LocalModel local = local_model(rows, switching, centre, neighbours);
    const VectorXd error = (rows.y - rows.phi * local.theta).rowwise().squaredNorm();
    for (Index t = 0; t < rows.rows(); ++t) {
      if (error(t) >= least(t)) continue;
      least(t) = error(t);
      out[static_cast<std::size_t>(t)] = k;
    }
  }
  return out;
}

}  // namespace wisp
