#include "learn/flame/flame_sizes.hpp"

#include <algorithm>
#include <cmath>

#include "base/statistics.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/outline/outline_shape.hpp"
#include "learn/outline/outline_units.hpp"

namespace wisp {
namespace {

constexpr double kDyingSeen = 0.3;  // maximum seconds of decay before extinction; earlier changes belong to the gust
constexpr double kShrinks = 0.97;   // share of the previous size below which decay has begun
constexpr double kDim = 0.05;       // seconds of glow without an outline
constexpr double kMaxCatching = 1, kMinCatching = 0.25;  // seconds of re-ignition after the flame is visible
constexpr double kFading = 0.3;                          // share of re-ignition, at its end, that fades to full size
constexpr std::size_t kMaxEvents = 8;

using Sizes = std::vector<double>;

double size_of(const Recording& recording, const OutlineLayout& layout, std::size_t row) {
  const auto at = [&](std::size_t k) { return recording.channels[layout.outputs[k]].samples[row]; };
  std::vector<OutlinePoint> points;
  for (std::size_t p = 0; p < layout.points; ++p) points.push_back({at(2 * p), at(2 * p + 1)});
  return std::sqrt(enclosed_area(points));
}

// Sizes during visible decay, relative to the size before: rows from `lit` on.
Sizes seen_dying(const Sizes& sizes, std::size_t lit, std::size_t gone, double rate_hz) {
  const std::size_t rows = rows_of(kDyingSeen, rate_hz), first = std::max(lit + rows, gone) - rows;
  Sizes before;
  for (std::size_t row = std::max(lit + rows, first) - rows; row < first; ++row) {
    if (!std::isnan(sizes[row])) before.push_back(sizes[row]);
  }
  const double whole = before.empty() ? 1 : median(std::move(before));
  std::size_t begin = gone;
  while (begin > first && sizes[begin - 1] < kShrinks * whole) --begin;
  Sizes out;
  for (std::size_t row = begin; row < gone; ++row) out.push_back(sizes[row] / whole);
  return out;
}

void glow_on(Sizes& dying, double rate_hz) {
  const std::size_t rows = rows_of(kDim, rate_hz);
  const double last = dying.empty() ? 1 : dying.back();
  for (std::size_t k = rows; k > 0; --k) {
    dying.push_back(last * static_cast<double>(k) / static_cast<double>(rows + 1));
  }
}

Sizes seen_catching(const Sizes& sizes, std::size_t back, std::size_t next, double rate_hz) {
  const std::size_t end = std::min(next, back + rows_of(kMaxCatching, rate_hz));
  if (end < back + rows_of(kMinCatching, rate_hz)) return {};
  Sizes out;
  const auto rows = static_cast<double>(end - back);
  for (std::size_t row = back; row < end; ++row) {
    const double size = std::isnan(sizes[row]) ? out.empty() ? 0 : out.back() : sizes[row];
    const double fading = std::max(0.0, 1 - (1 - static_cast<double>(row - back) / rows) / kFading);
    out.push_back(size + fading * (1 - size));
  }
  return out;
}

SizeEvents stored(const std::vector<Sizes>& events) {
  SizeEvents out;
  const std::size_t count = std::min(events.size(), kMaxEvents);
  for (std::size_t k = 0; k < count; ++k) {
    for (const double size : events[k * events.size() / count]) {
      out.sizes.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(size, 0.0, 1.0))));
    }
    out.ends.push_back(static_cast<std::uint32_t>(out.sizes.size()));
  }
  return out;
}

}  // namespace

Result<std::vector<double>> flame_sizes(const Recording& recording, std::span<const BlowOut> blow_outs) {
  const auto layout = outline_layout(recording);
  if (!layout) return layout.error();
  const Recording undisturbed = without_blow_outs(recording, blow_outs);
  std::vector<double> sizes, burning;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    sizes.push_back(size_of(recording, *layout, row));
    const double size = size_of(undisturbed, *layout, row);
    if (!std::isnan(size)) burning.push_back(size);
  }
  const double usual = burning.empty() ? kMissing : median(std::move(burning));
  for (double& size : sizes) size /= usual;
  return sizes;
}

Result<RecordedEvents> recorded_events(std::span<const ExtinctionEvidence> evidence) {
  std::vector<Sizes> dying, catching;
  std::vector<double> vanishing;
  for (const ExtinctionEvidence& each : evidence) {
    const double rate_hz = each.recording->rate_hz;
    const auto sizes = flame_sizes(*each.recording, each.blow_outs);
    if (!sizes) return sizes.error();
    std::size_t lit = 0;
    for (std::size_t k = 0; k < each.blow_outs.size(); ++k) {
      const BlowOut& one = each.blow_outs[k];
      const std::size_t next = k + 1 < each.blow_outs.size() ? each.blow_outs[k + 1].gone : sizes->size();
      if (one.blown) {
        dying.push_back(seen_dying(*sizes, lit, one.gone, rate_hz));
        vanishing.push_back(static_cast<double>(dying.back().size()) / rate_hz);
        glow_on(dying.back(), rate_hz);
        Sizes caught = seen_catching(*sizes, one.back, next, rate_hz);
        if (!caught.empty()) catching.push_back(std::move(caught));
      }
      lit = one.back;
    }
  }
  return RecordedEvents{stored(dying), stored(catching), vanishing.empty() ? 0 : median(std::move(vanishing))};
}

}  // namespace wisp
