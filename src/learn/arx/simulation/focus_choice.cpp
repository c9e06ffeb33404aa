#include "learn/arx/simulation/focus_choice.hpp"

#include "learn/arx/simulation/held_out.hpp"

namespace wisp::arx {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kAsGood = 1.05;      // a root mean square within this factor of the least is as good
constexpr double kSure = 1;           // standard errors by which parts must be better than least squares'
constexpr double kSurelyMany = 2;     // the same for many lags, which cost more to play
constexpr double kMaxRmsRatio = 1.2;  // no fold may have a larger root mean square than least squares by this factor

// By how many standard errors the errors of one row are below those of another.
double sureness(const MatrixXd& squares, std::size_t one, const MatrixXd& others, std::size_t other) {
  return standard_errors_below(squares.row(Index(one)).transpose(), others.row(Index(other)).transpose());
}

double mean_square(const Unit& unit, std::size_t candidate) { return unit.squares.row(Index(candidate)).mean(); }

bool loses_a_fold(const Unit& unit, std::size_t candidate) {
  for (Index first = 0; first < unit.squares.cols(); first += kParts) {
    const auto fold = unit.squares.middleCols(first, kParts);
    if (fold.row(Index(candidate)).mean() > kMaxRmsRatio * kMaxRmsRatio * fold.row(0).mean()) return true;
  }
  return false;
}

// Many lags start better from measured samples than few, whatever they describe, since they average those: they have to
// be surely better from the best initial state too.
bool only_starts_better(const Unit& unit, std::size_t candidate) {
  const auto many = [](const FocusCandidate& one) { return one.kernel || one.states > 0; };
  if (!many(unit.candidates[candidate])) return false;
  std::size_t best = 0;
  for (std::size_t w = 0; w < unit.candidates.size(); ++w) {
    const auto error = [&](std::size_t one) { return unit.estimated.row(Index(one)).mean(); };
    if (!many(unit.candidates[w]) && error(w) < error(best)) best = w;
  }
  return sureness(unit.estimated, candidate, unit.estimated, best) < kSurelyMany;
}

}  // namespace

void Unit::pick(bool leave_least_squares) {
  const std::size_t first = leave_least_squares && candidates.size() > 1 ? 1 : 0;
  std::vector<std::size_t> open;
  for (std::size_t w = first; w < candidates.size(); ++w) {
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
  if (apart.empty()) return;
  MatrixXd own;
  for (Unit& unit : apart) {
    if (unit.candidates.empty()) return;
    unit.pick(leave_least_squares);
    const MatrixXd share = unit.squares.row(Index(unit.picked)) / static_cast<double>(apart.size());
    own = own.size() == 0 ? share : MatrixXd(own + share);
  }
  if (together.candidates.empty() || own.cols() != together.squares.cols()) return;
  decoupled = own.mean() * kAsGood * kAsGood < mean_square(together, together.picked) &&
              sureness(own, 0, together.squares, together.picked) >= kSure;
}

}  // namespace wisp::arx
