#include "studies/flame/flame_fidelity.hpp"

#include <algorithm>
#include <cmath>

#include "learn/fidelity/fidelity_distance.hpp"
#include "learn/outline/outline_shape.hpp"
#include "learn/outline/outline_units.hpp"
#include "studies/value_or_abort.hpp"

namespace wisp::verify {
namespace {

constexpr std::size_t kSeenPoints = 8;
constexpr double kWindowSeconds = 0.5;
constexpr std::size_t kMaxWindows = 500;

}  // namespace

Recording as_seen(const Recording& recording, const std::vector<double>& knots) {
  const OutlineLayout layout = value_or_abort(outline_layout(recording));
  const OutlineCurve curve(knots);
  Recording out{.source = recording.source, .rate_hz = recording.rate_hz};
  for (const std::string& name : outline_outputs(kSeenPoints)) out.channels.push_back({name, "", Role::kOutput, {}});
  std::vector<double> control(layout.outputs.size());
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    for (std::size_t k = 0; k < control.size(); ++k) control[k] = recording.channels[layout.outputs[k]].samples[row];
    const bool whole = std::none_of(control.begin(), control.end(), [](double x) { return std::isnan(x); });
    const auto points =
        at_equal_lengths(curve.polyline(whole ? control : std::vector(control.size(), 0.0)), kSeenPoints);
    for (std::size_t k = 0; k < 2 * kSeenPoints; ++k) {
      out.channels[k].samples.push_back(whole ? points[k / 2][k % 2] : std::nan(""));
    }
  }
  return out;
}

void write_windows(std::ostream& out, const std::string& side, std::size_t clip, const Recording& seen) {
  const auto stretches = value_or_abort(stretches_of(seen, outline_outputs(kSeenPoints)));
  const auto rows = static_cast<std::size_t>(std::lround(kWindowSeconds * seen.rate_hz));
  const std::size_t hop = std::max<std::size_t>(1, total_rows(stretches) / kMaxWindows);
  const FeatureWindows windows = thinned(motion_windows(stretches, rows, hop), kMaxWindows);
  for (std::size_t k = 0; k < windows.size(); ++k) {
    constexpr std::size_t kBlockWindows = 4;  // windows in a row that are too alike to be learned from and judged on
    out << side << ',' << clip << ',' << k * hop / (kBlockWindows * rows);
    for (double value : windows.window(k)) out << ',' << value;
    out << '\n';
  }
}

}  // namespace wisp::verify
