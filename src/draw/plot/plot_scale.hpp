#pragma once
// From data to positions on an axis, and the ticks between.

#include <string>
#include <vector>

namespace wisp::drawing {

/// A stretch of data on a stretch of the sheet.
struct Scale {
  double low = 0;  ///< data at `from`
  double high = 1;
  double from = 0;  ///< points
  double to = 1;
  bool logarithmic = false;

  double operator()(double value) const;

  /// Whether the value has a place: finite, and positive on a logarithmic axis.
  bool shows(double value) const;
};

/// The ticks of an axis. Labels are short: a power of ten that they share stands apart.
struct Ticks {
  std::vector<double> at;
  std::vector<std::string> labels;  ///< as many
  std::vector<double> between;      ///< unlabelled ticks of a logarithmic axis
  std::string shared;               ///< such as "×10⁻³"; empty: none
};

/// Round values over the scale, about `wanted` of them (2 … 20).
Ticks make_ticks(const Scale& scale, int wanted, bool whole_numbers);

/// Collects the range of data.
class Extent {
 public:
  /// Takes a value that has a place on the axis; others are passed over.
  void take(double value, bool logarithmic);
  bool empty() const { return !(low_ <= high_); }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  double low_ = 1;
  double high_ = 0;
};

}  // namespace wisp::drawing
