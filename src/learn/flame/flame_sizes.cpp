#include "learn/flame/extinction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/outline/outline_dynamics.hpp"
#include "learn/outline/outline_shape.hpp"
#include "learn/outline/outline_units.hpp"
#include "learn/outline/resampled_residuals.hpp"

namespace wisp {
namespace {

constexpr double kDyingSeen = 0.3;  // maximum seconds of decay before extinction; earlier changes belong to the gust
constexpr double kShrinks = 0.97;   // share of the size before the decay, below which the flame counts as decaying
constexpr double kDim = 0.05;       // seconds of glow appended after the outline disappears
constexpr double kMaxCatching = 0.75, kMinCatching = 0.25;  // seconds stored of a re-ignition; shorter ones are dropped
constexpr std::size_t kMaxEvents = 8;

using Sizes = std::vector<double>;

double size_of(const Recording& recording, const OutlineLayout& layout, std::size_t row) {
  const auto at = [&](std::size_t k) { return recording.channels[layout.outputs[k]].samples[row]; };
  std::vector<OutlinePoint> points;
  for (std::size_t p = 0; p < layout.points; ++p) points.push_back({at(2 * p), at(2 * p + 1)});
  return std::sqrt(enclosed_area(points));
}

// Sizes of consecutive rows and, where shapes are stored, the shapes' components.
struct Event {
  Sizes sizes;
  std::vector<double> shapes{};  // sizes × components
};

// Projects a recording's outlines on the components of a model's shape; does nothing if the shape is empty.
class Shapes {
 public:
  Shapes(const ExtinctionEvidence& evidence, const OutlineView& view) : shape_(view.shape) {
    if (shape_.empty()) return;
    const Recording& recording = *evidence.recording;
    layout_ = *outline_layout(recording);
    const OutlineInput wind{.name = evidence.input, .scale = evidence.scale};
    const Recording burning = without_blow_outs(recording, evidence.blow_outs);
    const double given = evidence.pixels_per_unit;
    units_ =
        to_model_units(layout_.knots == view.knots ? recording : with_knots(recording, layout_, view.knots).recording,
                       layout_, given > 0 ? given : resting_height_pixels(burning, layout_, {&wind, 1}));
  }

  // Appends the components of a row's outline, enlarged to full size. Without an outline repeats the last ones, or 0.
  void add(std::size_t row, double size, std::vector<double>& to) const {
    if (shape_.empty()) return;
    std::vector<double> outline = whole_row(units_, layout_, row);
    for (double& value : outline) value /= std::min(size, 1.0);
    std::vector<double> components(shape_.count());
    if (!outline.empty() && size > 0)
      components = components_of(shape_, shape_coordinates(outline));
    else if (!to.empty())
      components.assign(to.end() - std::ssize(components), to.end());
    to.insert(to.end(), components.begin(), components.end());
  }

 private:
  const ShapeComponents& shape_;
  Recording units_;
  OutlineLayout layout_;
};

// Sizes during the visible decay that ends at row `gone`, relative to the size before it. Rows before `lit` are unused.
Event seen_dying(const Sizes& sizes, std::size_t lit, std::size_t gone, double rate_hz) {
  const std::size_t rows = rows_of(kDyingSeen, rate_hz), first = std::max(lit + rows, gone) - rows;
  const auto at = [&](std::size_t row) { return sizes.begin() + static_cast<std::ptrdiff_t>(row); };
  const Sizes before = present({at(std::max(lit + rows, first) - rows), at(first)});
  const double whole = before.empty() ? 1 : median(before);
  std::size_t begin = gone;
  while (begin > first && sizes[begin - 1] < kShrinks * whole) --begin;
  Event out;
  for (std::size_t row = begin; row < gone; ++row) out.sizes.push_back(sizes[row] / whole);
  return out;
}

void glow_on(Sizes& dying, double rate_hz) {
  const std::size_t rows = rows_of(kDim, rate_hz);
  const double last = dying.empty() ? 1 : dying.back();
  for (std::size_t k = rows; k > 0; --k) dying.push_back(last * static_cast<double>(k) / static_cast<double>(rows + 1));
}

Event seen_catching(const Sizes& sizes, const Shapes& shapes, std::size_t back, std::size_t next, double rate_hz) {
  const std::size_t end = std::min(next, back + rows_of(kMaxCatching, rate_hz));
  if (end < back + rows_of(kMinCatching, rate_hz)) return {};
  Event out;
  for (std::size_t row = back; row < end; ++row) {
    out.sizes.push_back(!std::isnan(sizes[row]) ? sizes[row] : out.sizes.empty() ? 0 : out.sizes.back());
    shapes.add(row, sizes[row], out.shapes);
  }
  return out;
}

FlameEvents stored_events(const std::vector<Event>& events, std::size_t components) {
  FlameEvents out;
  out.scale.resize(components);
  const std::size_t count = std::min(events.size(), kMaxEvents);
  const auto kept = [&](std::size_t k) -> const Event& { return events[k * events.size() / count]; };
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < kept(k).shapes.size(); ++i)
      out.scale[i % components] = std::max(out.scale[i % components], std::abs(kept(k).shapes[i]) / kLargestStored);
  }
  for (std::size_t k = 0; k < count; ++k) {
    for (const double size : kept(k).sizes) {
      out.sizes.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(size, 0.0, 1.0))));
    }
    for (std::size_t i = 0; i < kept(k).shapes.size(); ++i) {
      out.shapes.push_back(static_cast<std::int8_t>(stored(kept(k).shapes[i], out.scale[i % components])));
    }
    out.ends.push_back(static_cast<std::uint32_t>(out.sizes.size()));
  }
  return out;
}

void widen(ValueRange& range, double value) { range = {std::min(range.lowest, value), std::max(range.highest, value)}; }

}  // namespace

Result<std::vector<double>> flame_sizes(const Recording& recording, std::span<const BlowOut> blow_outs) {
  const auto layout = outline_layout(recording);
  if (!layout) return layout.error();
  const Recording undisturbed = without_blow_outs(recording, blow_outs);
  std::vector<double> sizes, burning;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    sizes.push_back(size_of(recording, *layout, row));
    burning.push_back(size_of(undisturbed, *layout, row));
  }
  burning = present(std::move(burning));
  const double usual = burning.empty() ? kMissing : median(std::move(burning));
  for (double& size : sizes) size /= usual;
  return sizes;
}

Result<RecordedEvents> recorded_events(std::span<const ExtinctionEvidence> evidence, const OutlineView& view) {
  std::vector<Event> dying, catching;
  std::vector<double> vanishing;
  for (const ExtinctionEvidence& each : evidence) {
    const double rate_hz = each.recording->rate_hz;
    const auto sizes = flame_sizes(*each.recording, each.blow_outs);
    if (!sizes) return sizes.error();
    const Shapes shapes(each, view);
    std::size_t lit = 0;
    for (std::size_t k = 0; k < each.blow_outs.size(); ++k) {
      const BlowOut& one = each.blow_outs[k];
      const std::size_t next = k + 1 < each.blow_outs.size() ? each.blow_outs[k + 1].gone : sizes->size();
      if (one.blown) {
        dying.push_back(seen_dying(*sizes, lit, one.gone, rate_hz));
        vanishing.push_back(static_cast<double>(dying.back().sizes.size()) / rate_hz);
        glow_on(dying.back().sizes, rate_hz);
        Event caught = seen_catching(*sizes, shapes, one.back, next, rate_hz);
        if (!caught.sizes.empty()) catching.push_back(std::move(caught));
      }
      lit = one.back;
    }
  }
  return RecordedEvents{stored_events(dying, 0), stored_events(catching, catching.empty() ? 0 : view.shape.count()),
                        median(std::move(vanishing))};
}

void make_room(const FlameEvents& events, ShapeComponents& shape) {
  ShapeComponents open = shape;
  open.coordinates.assign(shape.coordinates.size(),
                          {-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()});
  std::vector<double> components(events.scale.size());
  for (std::size_t first = 0; first < events.shapes.size(); first += components.size()) {
    for (std::size_t k = 0; k < components.size(); ++k) {
      components[k] = events.scale[k] * events.shapes[first + k];
      widen(shape.components[k], components[k]);
    }
    const std::vector<double> coordinates = shape_coordinates(control_points(open, components));
    for (std::size_t i = 0; i < coordinates.size(); ++i) widen(shape.coordinates[i], coordinates[i]);
  }
}

}  // namespace wisp
