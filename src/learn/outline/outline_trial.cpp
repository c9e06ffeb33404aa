#include "learn/outline/outline_trial.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.hpp"
#include "learn/outline/outline_shape.hpp"
#include "learn/outline/outline_synthesis.hpp"

namespace wisp {
namespace {

constexpr std::size_t kWindows = 120;       // a side: the distance is known to 0.01 then, for a hundredth of a second
constexpr double kPlayed = 30;              // seconds at least
constexpr std::size_t kMaxRecorded = 2000;  // outlines that others are compared with
constexpr std::size_t kMaxPlayed = 500;
constexpr std::size_t kPlaces = 12;  // along an outline

const std::vector<double>& channel_samples(const Recording& recording, const std::string& name) {
  return recording.channels[*find_channel(recording, name)].samples;
}

// Samples that are not missing.
std::vector<double> seen(const std::vector<double>& all) {
  std::vector<double> out;
  std::copy_if(all.begin(), all.end(), std::back_inserter(out), [](double value) { return !std::isnan(value); });
  return out;
}

double unsteadiness(const PreparedOutlines& prepared) {
  double neighbours = 0, any = 0;
  for (const Recording& recording : prepared.recordings) {
    for (const std::string& name : prepared.channels.outputs) {
      const std::vector<double>& all = channel_samples(recording, name);
      std::vector<double> steps;
      for (std::size_t k = 1; k < all.size(); ++k) {
        if (!std::isnan(all[k] - all[k - 1])) steps.push_back((all[k] - all[k - 1]) * (all[k] - all[k - 1]));
      }
      neighbours += mean(steps);
      any += 2 * std::pow(deviation(seen(all)), 2);
    }
  }
  return any > 0 ? neighbours / any : 0;
}

// A calm recording among others does not show the effect of the inputs.
std::size_t liveliest(const PreparedOutlines& prepared) {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t r = 0; r < prepared.recordings.size(); ++r) {
    double sum = 0;
    for (const std::string& name : prepared.channels.outputs)
      sum += deviation(seen(channel_samples(prepared.recordings[r], name)));
    if (sum > most) best = r, most = sum;
  }
  return best;
}

using Outline = std::vector<OutlinePoint>;

// Outlines of at most so many rows, evenly spread, as points at equal steps of their length; and how many of them cross
// themselves.
std::vector<Outline> outlines(std::span<const Recording> recordings, const PreparedOutlines& prepared, std::size_t most,
                              double* crossed = nullptr) {
  const OutlineCurve curve(prepared.layout.knots, 100);
  std::size_t rows = 0, crossings = 0;
  for (const Recording& recording : recordings) rows += recording.rows();
  std::vector<Outline> out;
  const std::size_t stride = 1 + rows / most;
  for (const Recording& recording : recordings) {
    const auto layout = outline_layout(recording);
    for (std::size_t row = 0; row < recording.rows(); row += stride) {
      const std::vector<double> control = whole_row(recording, *layout, row);
      if (control.empty()) continue;
      const auto polyline = curve.polyline(control);
      if (crossed) crossings += crosses_itself(polyline) ? 1 : 0;
      out.push_back(at_equal_lengths(polyline, kPlaces));
    }
  }
  if (crossed && !out.empty()) *crossed = static_cast<double>(crossings) / static_cast<double>(out.size());
  return out;
}

// Mean square distance from the nearest of the others.
double nearest(const Outline& one, std::span<const Outline> others) {
  double best = std::numeric_limits<double>::infinity();
  for (const Outline& other : others) {
    double sum = 0;
    for (std::size_t k = 0; k < one.size() && sum < best; ++k) {
      sum += std::pow(one[k][0] - other[k][0], 2) + std::pow(one[k][1] - other[k][1], 2);
    }
    best = std::min(best, sum);
  }
  return best;
}

double outside_share(std::span<const Outline> recorded, std::span<const Outline> played) {
  const std::size_t cut = recorded.size() * 3 / 5;
  if (cut == 0 || cut == recorded.size() || played.empty()) return 0;
  std::vector<double> own;
  for (const Outline& one : recorded.subspan(cut)) own.push_back(nearest(one, recorded.first(cut)));
  const double bound = quantile(own, 0.99);
  double count = 0;
  for (const Outline& one : played) count += nearest(one, recorded) > bound ? 1 : 0;
  return count / static_cast<double>(played.size());
}

}  // namespace

Result<OutlineTrial> try_outline(const Model& model, const PreparedOutlines& prepared,
                                 std::span<const Recording> original, std::uint64_t seed) {
  OutlineTrial out;
  out.unsteadiness = unsteadiness(prepared);
  const std::size_t which = liveliest(prepared);
  const Recording& real = prepared.recordings[which];
  const Recording driving = with_regressors(original[which], prepared.inputs, {});
  const std::size_t rows = std::max(real.rows(), static_cast<std::size_t>(kPlayed * model.rate_hz));
  const auto play = synthesize(model, {.rows = rows, .seed = seed, .input = &driving});
  if (!play) return play.error();
  out.held_share = play->held_share;
  for (const std::string& name : prepared.channels.outputs) {
    const double recorded = deviation(seen(channel_samples(real, name)));
    out.sd_ratio.push_back(recorded > 0 ? deviation(channel_samples(play->recording, name)) / recorded : 1);
  }
  out.outside = outside_share(outlines(prepared.recordings, prepared, kMaxRecorded, &out.crossed_recorded),
                              outlines({&play->recording, 1}, prepared, kMaxPlayed, &out.crossed));
  const FidelityOptions how{.channels = prepared.channels.outputs, .max_windows = kWindows};
  if (const auto found = fidelity({&real, 1}, {&play->recording, 1}, how)) {
    out.half_second = found->energy_distance;
    out.two_seconds = found->long_motion;
  }
  return out;
}

}  // namespace wisp
