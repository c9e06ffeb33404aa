#include "learn/arx/curve/curve_fit.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "learn/arx/curve/curve_gram.hpp"
#include "learn/numeric/decompositions.hpp"

namespace wisp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRidge = 1e-12;    // of a regressor's own product
constexpr double kSettled = 1e-11;  // of the loss: what a further pass must gain
constexpr double kMinLoss = 1e-12;  // of an output's own square: less is rounding

// The rises of all curves, one after the other.
struct Rises {
  std::vector<Index> first;  // per curve
  std::vector<double> span;  // per curve: what its rises add up to
  VectorXd value;

  Index count(std::size_t curve) const {
    return (curve + 1 < first.size() ? first[curve + 1] : value.size()) - first[curve];
  }
  auto of(std::size_t curve) { return value.segment(first[curve], count(curve)); }
  auto of(std::size_t curve) const { return value.segment(first[curve], count(curve)); }
};

// Each knot's distance from the first, to a power: the input itself, or its square.
Rises power_rises(const std::vector<std::vector<double>>& knots, int power) {
  Rises rises;
  std::vector<double> all;
  for (const std::vector<double>& at : knots) {
    rises.first.push_back(static_cast<Index>(all.size()));
    rises.span.push_back(at.back() - at.front());
    const auto share = [&](double x) { return std::pow((x - at.front()) / rises.span.back(), power); };
    for (std::size_t k = 1; k < at.size(); ++k) all.push_back(rises.span.back() * (share(at[k]) - share(at[k - 1])));
  }
  rises.value = Eigen::Map<const VectorXd>(all.data(), static_cast<Index>(all.size()));
  return rises;
}

VectorXd solved(MatrixXd gram, const VectorXd& right) {
  gram.diagonal() *= 1 + kRidge;
  gram.diagonal().array() += (gram.diagonal().array() == 0).cast<double>();
  return symmetric_solution(gram, right);
}

// arg min x'Gx/2 − r'x over x ≥ 0, from a point where that holds: solve on the free ones, stop where one would fall
// below 0, and free the one that gains most, until none does.
VectorXd solved_above_zero(const MatrixXd& gram, const VectorXd& right, VectorXd x) {
  std::vector<Index> open;
  for (Index k = 0; k < x.size(); ++k) {
    if (x[k] > 0) open.push_back(k);
  }
  for (Index pass = 0; pass < 20 * x.size(); ++pass) {
    const VectorXd best = solved(gram(open, open), right(open));
    double length = 1;
    Index stop = -1;
    for (Index k = 0; k < best.size(); ++k) {
      const double now = x[open[static_cast<std::size_t>(k)]];
      if (best[k] > 0 || now - best[k] <= 0) continue;
      if (now / (now - best[k]) < length) length = now / (now - best[k]), stop = k;
    }
    for (Index k = 0; k < best.size(); ++k) x[open[static_cast<std::size_t>(k)]] *= 1 - length;
    for (Index k = 0; k < best.size(); ++k) x[open[static_cast<std::size_t>(k)]] += length * best[k];
    if (stop >= 0) {
      x[open[static_cast<std::size_t>(stop)]] = 0;
      open.erase(open.begin() + stop);
      continue;
    }
    const VectorXd slope = right - gram * x;
    Index steepest = 0;
    for (Index k = 0; k < x.size(); ++k) {
      const bool is_open = std::find(open.begin(), open.end(), k) != open.end();
      if (!is_open && (x[steepest] > 0 || slope[k] > slope[steepest])) steepest = k;
    }
    const double noticeable = 1e-12 * right.cwiseAbs().maxCoeff();
    if (std::find(open.begin(), open.end(), steepest) != open.end() || slope[steepest] <= noticeable) break;
    open.push_back(steepest);
  }
  return x.cwiseMax(0);
}

// One output row: what it says for given rises or given coefficients of B.
class Row {
 public:
  Row(const CurveRow& data, std::size_t samples)
      : data_(data), pieces_(data.gram.rows() - 1), samples_(static_cast<double>(samples)) {}

  Index taps() const { return static_cast<Index>(data_.taps.size()); }

  // Columns: the taps of B as combinations of pieces.
  MatrixXd by_tap(const Rises& rises) const {
    MatrixXd map = MatrixXd::Zero(pieces_, taps());
    for (Index t = 0; t < taps(); ++t) {
      const CurvedTap& tap = data_.taps[static_cast<std::size_t>(t)];
      const auto of = rises.of(static_cast<std::size_t>(tap.curve));
      map.col(t).segment(tap.first, of.size()) = of;
    }
    return map;
  }

  // Columns: the rises as combinations of pieces.
  MatrixXd by_rise(const Rises& rises) const {
    MatrixXd map = MatrixXd::Zero(pieces_, rises.value.size());
    for (Index t = 0; t < taps(); ++t) {
      const CurvedTap& tap = data_.taps[static_cast<std::size_t>(t)];
      const auto curve = static_cast<std::size_t>(tap.curve);
      for (Index p = 0; p < rises.count(curve); ++p) map(tap.first + p, rises.first[curve] + p) = b_[t];
    }
    return map;
  }

  auto gram() const { return data_.gram.topLeftCorner(pieces_, pieces_); }
  auto target() const { return data_.gram.col(pieces_).head(pieces_); }

  // The best B for the rises, and what it leaves.
  void take_b(const Rises& rises) {
    const MatrixXd map = by_tap(rises);
    b_ = taps() > 0 ? solved(map.transpose() * gram() * map, map.transpose() * target()) : VectorXd();
    const VectorXd theta = taps() > 0 ? VectorXd(map * b_) : VectorXd::Zero(pieces_);
    const double whole = data_.gram(pieces_, pieces_);
    const double left = whole - 2 * theta.dot(target()) + theta.dot(gram() * theta);
    loss_ = std::max(left, kMinLoss * whole + std::numeric_limits<double>::min()) / samples_;
  }

  double loss() const { return loss_; }
  double loss_in_unit() const { return loss_ * data_.unit * data_.unit; }
  double variance() const {
    const double freedom = samples_ - static_cast<double>(taps()) - data_.own_columns;
    return loss_ * samples_ / std::max(1.0, freedom);
  }

 private:
  const CurveRow& data_;
  Index pieces_;
  double samples_;
  VectorXd b_;
  double loss_ = 0;
};

// The alternation from one start.
class Alternation {
 public:
  Alternation(const CurveGram& data, Rises start) : rises_(std::move(start)) {
    for (const CurveRow& row : data.rows) rows_.emplace_back(row, data.samples);
    for (Row& row : rows_) row.take_b(rises_);
  }

  // Whether it settled.
  bool run(int max_passes) {
    double before = deviance();
    for (passes_ = 1; passes_ <= max_passes; ++passes_) {
      step();
      const double now = deviance();
      if (before - now <= kSettled) return true;
      before = now;
    }
    return false;
  }

  // Σ ln V: minus twice the log-likelihood a row, up to a constant.
  double deviance() const {
    double sum = 0;
    for (const Row& row : rows_) sum += std::log(row.loss());
    return sum;
  }

  // Of the value at every knot: the information of the rises, less what B takes of it, where a curve's rises keep
  // their sum.
  std::vector<std::vector<double>> std_errors() const {
    MatrixXd information = MatrixXd::Zero(rises_.value.size(), rises_.value.size());
    for (const Row& row : rows_) {
      const MatrixXd rise = row.by_rise(rises_), tap = row.by_tap(rises_);
      const MatrixXd shared = tap.transpose() * row.gram() * rise;
      MatrixXd own = tap.transpose() * row.gram() * tap;
      own.diagonal() *= 1 + kRidge;
      own.diagonal().array() += (own.diagonal().array() == 0).cast<double>();
      information += (rise.transpose() * row.gram() * rise - shared.transpose() * symmetric_solutions(own, shared)) /
                     row.variance();
    }
    const MatrixXd free = kept_sums();
    const MatrixXd covariance = free * symmetric_solutions(free.transpose() * information * free, free.transpose());
    std::vector<std::vector<double>> out;
    for (std::size_t c = 0; c < rises_.first.size(); ++c) {
      out.emplace_back(1, 0.0);
      for (Index k = 1; k < rises_.count(c); ++k) {
        out.back().push_back(std::sqrt(std::max(0.0, covariance.block(rises_.first[c], rises_.first[c], k, k).sum())));
      }
      out.back().push_back(0);
    }
    return out;
  }

  const Rises& rises() const { return rises_; }
  const std::vector<Row>& rows() const { return rows_; }
  int passes() const { return passes_; }

 private:
  void step() {
    MatrixXd gram = MatrixXd::Zero(rises_.value.size(), rises_.value.size());
    VectorXd right = VectorXd::Zero(rises_.value.size());
    for (const Row& row : rows_) {
      const MatrixXd map = row.by_rise(rises_);
      gram += map.transpose() * row.gram() * map / row.loss();
      right += map.transpose() * row.target() / row.loss();
    }
    const VectorXd found = solved_above_zero(gram, right, rises_.value);
    Rises next = rises_;
    next.value = found;
    for (std::size_t c = 0; c < next.first.size(); ++c) {
      const double sum = next.of(c).sum();
      // A curve that nothing follows stays as it was.
      if (sum > 0)
        next.of(c) *= next.span[c] / sum;
      else
        next.of(c) = rises_.of(c);
    }
    rises_ = std::move(next);
    for (Row& row : rows_) row.take_b(rises_);
  }

  // Directions in which no curve's rises change their sum.
  MatrixXd kept_sums() const {
    const auto curves = static_cast<Index>(rises_.first.size());
    MatrixXd free = MatrixXd::Zero(rises_.value.size(), rises_.value.size() - curves);
    Index column = 0;
    for (std::size_t c = 0; c < rises_.first.size(); ++c) {
      for (Index k = 0; k + 1 < rises_.count(c); ++k, ++column) {
        free(rises_.first[c] + k, column) = 1;
        free(rises_.first[c] + k + 1, column) = -1;
      }
    }
    return free;
  }

  Rises rises_;
  std::vector<Row> rows_;
  int passes_ = 0;
};

InputCurve curve_of(const std::vector<double>& at, const VectorXd& rises) {
  InputCurve curve{at, {at.front()}};
  for (Index k = 0; k + 1 < rises.size(); ++k) {
    curve.value.push_back(std::min(curve.value.back() + rises[k], at.back()));
  }
  curve.value.push_back(at.back());
  return curve;
}

}  // namespace

Result<CurveFit> fit_input_curves(std::span<const Recording> recordings, const ChannelChoice& channels,
                                  const CurveFitOptions& options) {
  const auto data = curve_gram(recordings, channels, options);
  if (!data) return data.error();
  Alternation proportional(*data, power_rises(data->knots, 1)), square(*data, power_rises(data->knots, 2));
  const bool settled[] = {proportional.run(options.max_passes), square.run(options.max_passes)};
  const bool bent = square.deviance() < proportional.deviance();
  const Alternation& best = bent ? square : proportional;
  CurveFit out;
  const auto errors = best.std_errors();
  for (std::size_t c = 0; c < data->knots.size(); ++c) {
    out.curves.push_back({curve_of(data->knots[c], best.rises().of(c)), errors[c]});
  }
  for (const Row& row : best.rows()) out.loss.push_back(row.loss_in_unit());
  out.samples_used = data->samples;
  out.passes = best.passes();
  out.converged = settled[bent ? 1 : 0];
  return out;
}

Recording with_curves(Recording recording, std::span<const CurvedInput> inputs, std::span<const InputCurve> curves) {
  for (std::size_t c = 0; c < inputs.size(); ++c) {
    for (const std::string& name : inputs[c].channels) {
      for (double& u : recording.channels[*find_channel(recording, name)].samples) u = value_at(curves[c], u);
    }
  }
  return recording;
}

}  // namespace wisp
