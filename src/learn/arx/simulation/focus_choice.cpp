#include "learn/arx/simulation/focus_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "learn/arx/simulation/held_out.hpp"

namespace wisp::arx {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kAsGood = 1.05;      // a root mean square within this factor of the least is as good
constexpr double kSure = 1;           // standard errors by which parts must be better than least squares'
constexpr double kSurelyMany = 2;     // the same for many lags, which cost more to play
constexpr double kEveryOutput = 1.1;  // states lessen every output's root mean square by this factor
constexpr double kSlight = 0.01;      // a squared error below this share of what states have to beat does not matter
constexpr double kMaxRmsRatio = 1.2;  // no fold may have a larger root mean square than least squares by this factor,
constexpr double kSmallLoss = 0.05;   // unless, of what is refined, by less than this share of the outputs' own

// By how many standard errors the errors of one row are below those of another.
double sureness(const MatrixXd& squares, std::size_t one, const MatrixXd& others, std::size_t other) {
  return standard_errors_below(squares.row(Index(one)).transpose(), others.row(Index(other)).transpose());
}

double mean_square(const Unit& unit, std::size_t candidate) { return unit.squares.row(Index(candidate)).mean(); }

// Both are one row. `small` is a root mean square by which any fold may lose, of both kinds of starts, or nothing.
bool loses_a_fold(const MatrixXd& squares, const MatrixXd& others, const std::vector<double>& small = {}) {
  for (Index fold = 0; fold * kParts < squares.cols(); ++fold) {
    const double own = std::sqrt(squares.middleCols(fold * kParts, kParts).mean());
    const double other = std::sqrt(others.middleCols(fold * kParts, kParts).mean());
    const double allowed = small.empty() ? 0 : small[std::size_t(fold)];
    if (own > std::max(kMaxRmsRatio * other, other + allowed)) return true;
  }
  return false;
}

// A fifth more of a small error is no loss where coefficients are as few as before.
bool loses_a_fold(const Unit& unit, std::size_t candidate) {
  std::vector<double> small;
  if (unit.candidates[candidate].one_step_weight) {
    for (double size : unit.sizes) small.push_back(kSmallLoss * std::sqrt(2 * size));
  }
  return loses_a_fold(unit.squares.row(Index(candidate)), unit.squares.row(0), small);
}

// Many lags start better from measured samples than few, whatever they describe, since they average those: they have to
// be surely better from the best initial state too, and by more than a state with many lags gains by its own size.
bool only_starts_better(const Unit& unit, std::size_t candidate) {
  if (unit.candidates[candidate].kernel_lags == 0) return false;
  const auto error = [&](std::size_t one) { return unit.estimated.row(Index(one)).mean(); };
  std::size_t best = 0;
  for (std::size_t w = 1; w < unit.candidates.size(); ++w) {
    if (unit.candidates[w].kernel_lags > 0 || unit.candidates[w].states > 0 || loses_a_fold(unit, w)) continue;
    if (error(w) < error(best)) best = w;
  }
  return error(candidate) * kAsGood * kAsGood > error(best) ||
         sureness(unit.estimated, candidate, unit.estimated, best) < kSurelyMany;
}

}  // namespace

void Unit::pick(bool leave_least_squares) {
  const std::size_t first = leave_least_squares && candidates.size() > 1 ? 1 : 0;
  std::vector<std::size_t> open;
  for (std::size_t w = first; w < candidates.size(); ++w) {
    if (candidates[w].states > 0) continue;
    if (first == 1 || w == 0 || !(loses_a_fold(*this, w) || only_starts_better(*this, w))) open.push_back(w);
  }
  std::size_t best = open.front();
  for (std::size_t w : open) {
    if (mean_square(*this, w) < mean_square(*this, best)) best = w;
  }
  picked = best;
  if (first == 1) return;
  for (std::size_t w : open) {
    picked = w;
    if (mean_square(*this, w) <= kAsGood * kAsGood * mean_square(*this, best)) break;
  }
  if (picked > 0 && sureness(squares, picked, squares, 0) < kSure) picked = 0;
}

std::vector<Unit*> Block::chosen() {
  std::vector<Unit*> units;
  if (!decoupled) return {&together};
  for (Unit& unit : apart) units.push_back(&unit);
  return units;
}

void Block::pick(bool leave_least_squares) {
  if (!together.candidates.empty()) together.pick(leave_least_squares);
  MatrixXd own;
  bool comparable = !apart.empty();
  for (Unit& unit : apart) {
    comparable &= !unit.candidates.empty();
    if (unit.candidates.empty()) continue;
    unit.pick(leave_least_squares);
    const MatrixXd share = unit.squares.row(Index(unit.picked)) / static_cast<double>(apart.size());
    own = own.size() == 0 ? share : MatrixXd(own + share);
  }
  if (together.candidates.empty()) return;
  decoupled = comparable && own.cols() == together.squares.cols() &&
              own.mean() * kAsGood * kAsGood < mean_square(together, together.picked) &&
              sureness(own, 0, together.squares, together.picked) >= kSure;
  if (!leave_least_squares) pick_states();
}

void Block::pick_states() {
  // What states have to beat: one row of errors of both starts, one of the best states', one of each output's.
  MatrixXd squares = together.squares.row(Index(together.picked));
  MatrixXd estimated = together.estimated.row(Index(together.picked));
  MatrixXd by_output = together.by_output.row(Index(together.picked));
  if (decoupled) {
    squares.setZero(), estimated.setZero();
    for (std::size_t i = 0; i < apart.size(); ++i) {
      const Unit& unit = apart[i];
      squares += unit.squares.row(Index(unit.picked)) / static_cast<double>(apart.size());
      estimated += unit.estimated.row(Index(unit.picked)) / static_cast<double>(apart.size());
      by_output(0, Index(i)) = unit.by_output(Index(unit.picked), 0);
    }
  }
  const double slight = kSlight * squares.mean();
  squares.array() += slight, estimated.array() += slight;
  std::vector<std::size_t> open;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t w = 0; w < together.candidates.size(); ++w) {
    if (together.candidates[w].states == 0) continue;
    const Eigen::ArrayXXd ratio = together.by_output.row(Index(w)).array() / by_output.row(0).array().max(1e-300);
    if ((ratio * kEveryOutput * kEveryOutput > 1).any()) continue;
    const MatrixXd own = together.squares.row(Index(w)).array() + slight;
    const MatrixXd own_estimated = together.estimated.row(Index(w)).array() + slight;
    if (loses_a_fold(own, squares) || sureness(own, 0, squares, 0) < kSurelyMany) continue;
    if (sureness(own_estimated, 0, estimated, 0) < kSurelyMany) continue;
    open.push_back(w);
    least = std::min(least, mean_square(together, w));
  }
  for (std::size_t w : open) {
    if (mean_square(together, w) > kAsGood * kAsGood * least) continue;
    together.picked = w;
    decoupled = false;
    return;
  }
}

}  // namespace wisp::arx
