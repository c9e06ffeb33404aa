#pragma once
// Conversion of data to positions on an axis, and its ticks.

#include <string>
#include <vector>

namespace wisp::drawing {

/// Linear or logarithmic mapping from a data range to an interval of the sheet.
struct Scale {
  double low = 0;  ///< data value at `from`
  double high = 1;
  double from = 0;  ///< points
  double to = 1;
  bool logarithmic = false;

  double operator()(double value) const;

  /// Returns whether a value can be drawn: finite, and positive on a logarithmic axis.
  bool shows(double value) const;
};

/// The ticks of an axis. A common power of ten is factored out of the labels.
struct Ticks {
  std::vector<double> at;
  std::vector<std::string> labels;  ///< one per labelled tick
  std::vector<double> between;      ///< unlabelled ticks of a logarithmic axis
  std::string shared;               ///< common factor, such as "×10⁻³"; empty: none
};

/// Returns ticks at round values over the scale, about `wanted` (clamped to 2 … 20).
Ticks make_ticks(const Scale& scale, int wanted, bool whole_numbers);

class Extent {
 public:
  /// Includes a value in the range, unless the axis cannot show it.
  void take(double value, bool logarithmic);
  bool empty() const { return !(low_ <= high_); }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  double low_ = 1;
  double high_ = 0;
};

}  // namespace wisp::drawing
