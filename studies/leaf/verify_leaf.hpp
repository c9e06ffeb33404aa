#pragma once
// What the parts of the leaf's long check share: ensembles of falls and their statistics.

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "simulate/leaf/leaf_flight.hpp"
#include "studies/verify_bounds.hpp"

namespace wisp::verify {

/// Mean and its standard error.
class Estimate {
 public:
  void add(double value) { sum_ += value, squares_ += value * value, ++count_; }
  double mean() const { return sum_ / count_; }
  double spread() const { return std::sqrt(std::max(0.0, squares_ / count_ - mean() * mean())); }
  double error() const { return count_ > 1 ? spread() / std::sqrt(count_ - 1.0) : 0; }
  int count() const { return count_; }

 private:
  double sum_ = 0, squares_ = 0;
  int count_ = 0;
};

/// How an ensemble of falls goes, each figure an estimate over its falls.
struct FallFigures {
  Estimate descent;                ///< m/s
  Estimate flips;                  ///< a second: the upper side comes up or goes under by more than 6°
  Estimate stalls;                 ///< a second
  Estimate drift;                  ///< horizontal distance over time, m/s
  Estimate rising;                 ///< % of the time
  Estimate rising_at_stalls;       ///< % of the rising time within 50 ms of a stall
  Estimate swing;                  ///< root mean square of the vertical speed, m/s
  Estimate spin;                   ///< likewise of the rate of turning, rad/s
  double frames = 0, seconds = 0;  ///< rows of 1/60 s, processor time
};

struct Ensemble {
  Leaf leaf{};
  double longest_step = 1.0 / 60;
  int falls = 200;
  double seconds = 20;
  double settle = 2;
};

/// Falls from random starts.
FallFigures figures_of(const Ensemble& ensemble);

/// A random start as the recordings have it.
LeafState random_start(std::uint64_t seed, std::uint64_t fall);

/// The parts of the check.
void plate(Bounds& bounds);
void integrators(Bounds& bounds);
void energy(Bounds& bounds);
void regimes(Bounds& bounds);
void discs(Bounds& bounds);
void gusts(Bounds& bounds);

}  // namespace wisp::verify
