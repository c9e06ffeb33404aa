#pragma once
// An ARX model learned while it runs: recursive least squares with forgetting, stable at every step.
//
// Source: L. Ljung, System Identification (2nd ed.), sections 11.2 (recursive least squares, forgetting) and 11.7
// (square-root updates by rotations). Departures: information that forgetting would take away and no input brings back
// is held at a floor around the present estimate, so that long calm does not wind the estimate up; and the model that
// is handed out has its poles pulled inside the unit circle whenever the estimate's are not.

#include <memory>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

/// How to learn while running.
struct RecursiveOptions {
  ArxOrders orders;           ///< see make_orders
  double forgetting = 0.998;  ///< (0, 1]: weight of a sample relative to the next; remembers about 1/(1 − this) samples
  bool estimate_constant = false;    ///< a constant term beside the other coefficients: an operating point that drifts
  double trust = 1e-3;               ///< > 0, in samples' worth: how firmly the start is believed
  double floor = 1;                  ///< >= 0, in samples' worth: information kept where the data brings none
  double stability_margin = 1e-3;    ///< in (0, 1): the model's spectral radius is at most 1 − this
  std::vector<double> output_scale;  ///< typical size of each output's deviation, > 0; empty: 1
  std::vector<double> input_scale;   ///< likewise of each input
};

/// Learns from one sample at a time. A sample costs some 3 d² operations for d coefficients an output.
class RecursiveArx {
 public:
  /// Starts from `start` (its coefficients, constant and means), or from zeros about zero where it is null.
  /// Errors: options out of range, order matrices that do not fit each other, a start with other orders.
  static Result<RecursiveArx> create(const RecursiveOptions& options, const ArxModel* start = nullptr);

  RecursiveArx(RecursiveArx&&) noexcept;
  RecursiveArx& operator=(RecursiveArx&&) noexcept;
  ~RecursiveArx();

  /// Takes in the next sample of all outputs and inputs, NaN where one is missing: what a missing sample enters is not
  /// learned from. Returns whether it learned.
  ///
  /// Preconditions: as many values as outputs and inputs.
  bool update(std::span<const double> outputs, std::span<const double> inputs);

  /// One-step prediction errors of the last update that learned, before it learned; zeros before the first.
  std::span<const double> errors() const;

  /// Forgets the history, not what was learned: the next sample begins a new episode.
  void restart();

  /// The model as of now: always stable, also in single precision. Its noise is the errors' weighted root mean square.
  const ArxModel& model() const;

  /// Whether the present estimate had to be pulled inside the unit circle.
  bool held() const;

 private:
  struct State;
  explicit RecursiveArx(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace wisp
