#include "learn/outline/outline_units.hpp"

#include <algorithm>
#include <cmath>

#include "learn/outline/outline_shape.hpp"
#include "model/bspline.hpp"

namespace wisp {
namespace {

constexpr std::size_t kMinPoints = kSplineDegree + 1;
constexpr std::string_view kUnitAttribute = "pixels_per_unit";

Result<std::vector<double>> knots_of(const Recording& recording, std::size_t points) {
  auto found = numbers_attribute(recording, "knots");
  if (!found) return found.error();
  if (!*found) return uniform_knots(static_cast<int>(points));
  std::vector<double>& knots = **found;
  if (knots.size() != points + kMinPoints) {
    return Error{recording.source + ": has " + std::to_string(knots.size()) + " knots, expected " +
                 std::to_string(points + kMinPoints) + " for " + std::to_string(points) + " control points"};
  }
  if (!valid_knots(knots)) {
    return Error{recording.source + ": its knots are not ascending from 0 to 1 with multiplicity 4 at both ends"};
  }
  return std::move(knots);
}

// Frame of one row, with its origin midway between the first and the last control point. NaN where one is missing.
OutlineFrame frame_of(const Recording& recording, const OutlineLayout& layout, std::size_t row,
                      double pixels_per_unit) {
  const auto sample = [&](std::size_t k) { return recording.channels[layout.outputs[k]].samples[row]; };
  const std::size_t last = layout.outputs.size() - 2;
  return {(sample(0) + sample(last)) / 2, (sample(1) + sample(last + 1)) / 2, pixels_per_unit};
}

std::vector<double> row_of(const Recording& recording, const OutlineLayout& layout, std::size_t row) {
  std::vector<double> control;
  for (std::size_t c : layout.outputs) control.push_back(recording.channels[c].samples[row]);
  return control;
}

void set_row(Recording& recording, const OutlineLayout& layout, std::size_t row, std::span<const double> control) {
  for (std::size_t k = 0; k < control.size(); ++k) recording.channels[layout.outputs[k]].samples[row] = control[k];
}

// Returns the index of a channel for the base's motion; adds the channel if it is missing.
std::size_t motion(Recording& recording, const std::string& name) {
  if (const auto index = find_channel(recording, name)) return *index;
  recording.channels.push_back({name, "px", Role::kMotion, std::vector<double>(recording.rows())});
  return recording.channels.size() - 1;
}

}  // namespace

std::vector<std::string> outline_outputs(std::size_t points) {
  std::vector<std::string> names;
  for (std::size_t p = 0; p < points; ++p) {
    names.push_back("p" + std::to_string(p) + ".x");
    names.push_back("p" + std::to_string(p) + ".y");
  }
  return names;
}

std::vector<std::string> input_names(const Recording& recording) {
  std::vector<std::string> names;
  for (std::size_t c : channels_with_role(recording, Role::kInput)) names.push_back(recording.channels[c].name);
  return names;
}

const std::vector<double>& samples_of(const Recording& recording, const std::string& name) {
  return recording.channels[*find_channel(recording, name)].samples;
}

Result<OutlineLayout> outline_layout(const Recording& recording) {
  OutlineLayout layout;
  for (;; ++layout.points) {
    const std::string name = "p" + std::to_string(layout.points);
    const auto x = find_channel(recording, name + ".x");
    const auto y = find_channel(recording, name + ".y");
    if (!x && !y) break;
    if (!x || !y) return Error{recording.source + ": control point " + name + " has no " + (x ? "y" : "x")};
    layout.outputs.insert(layout.outputs.end(), {*x, *y});
  }
  if (layout.points < kMinPoints) {
    return Error{recording.source + ": has " + std::to_string(layout.points) +
                 " control points (p0.x, p0.y, …), expected at least 4: is it a recording of an outline?"};
  }
  auto knots = knots_of(recording, layout.points);
  if (!knots) return knots.error();
  layout.knots = *std::move(knots);
  return layout;
}

Result<OutlineLayout> common_layout(std::span<const Recording> recordings) {
  if (recordings.empty()) return Error{"there is no recording to learn from"};
  auto first = outline_layout(recordings.front());
  if (!first) return first;
  for (const Recording& recording : recordings.subspan(1)) {
    const auto layout = outline_layout(recording);
    if (!layout) return layout.error();
    if (layout->points != first->points) {
      return Error{recording.source + ": has " + std::to_string(layout->points) + " control points, but " +
                   recordings.front().source + " has " + std::to_string(first->points) +
                   "; capture both with the same --points"};
    }
  }
  return first;
}

std::vector<double> to_model_units(std::span<const double> pixels, const OutlineFrame& frame) {
  std::vector<double> units(pixels.size());
  for (std::size_t k = 0; k + 1 < pixels.size(); k += 2) {
    units[k] = (pixels[k] - frame.base_x) / frame.pixels_per_unit;
    units[k + 1] = (frame.base_y - pixels[k + 1]) / frame.pixels_per_unit;
  }
  return units;
}

std::vector<double> to_pixels(std::span<const double> units, const OutlineFrame& frame) {
  std::vector<double> pixels(units.size());
  for (std::size_t k = 0; k + 1 < units.size(); k += 2) {
    pixels[k] = frame.base_x + units[k] * frame.pixels_per_unit;
    pixels[k + 1] = frame.base_y - units[k + 1] * frame.pixels_per_unit;
  }
  return pixels;
}

std::vector<double> whole_row(const Recording& recording, const OutlineLayout& layout, std::size_t row) {
  std::vector<double> control = row_of(recording, layout, row);
  const bool missing = std::any_of(control.begin(), control.end(), [](double value) { return std::isnan(value); });
  return missing ? std::vector<double>() : control;
}

std::optional<bool> follows_underside(const Recording& recording) {
  const auto text = find_attribute(recording, "underside");
  if (!text || (*text != "0" && *text != "1")) return std::nullopt;
  return *text == "1";
}

std::vector<double> heights_pixels(const Recording& recording, const OutlineLayout& layout,
                                   std::span<const std::uint8_t> rows) {
  const OutlineCurve curve(layout.knots);
  std::vector<double> out;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    if (!rows.empty() && rows[row] == 0) continue;
    const std::vector<double> control = whole_row(recording, layout, row);
    if (!control.empty()) out.push_back(height_of(curve.polyline(control)));
  }
  return out;
}

Recording to_model_units(const Recording& recording, const OutlineLayout& layout, double pixels_per_unit) {
  Recording out = recording;
  const std::size_t base_x = motion(out, "base.x"), base_y = motion(out, "base.y");
  for (std::size_t row = 0; row < out.rows(); ++row) {
    const OutlineFrame frame = frame_of(recording, layout, row, pixels_per_unit);
    out.channels[base_x].samples[row] = frame.base_x;
    out.channels[base_y].samples[row] = frame.base_y;
    set_row(out, layout, row, to_model_units(row_of(recording, layout, row), frame));
  }
  for (std::size_t c : layout.outputs) out.channels[c].unit.clear();
  set_numbers_attribute(out, kUnitAttribute, {&pixels_per_unit, 1});
  return out;
}

Result<Recording> to_pixels(const Recording& recording) {
  const auto layout = outline_layout(recording);
  if (!layout) return layout.error();
  const auto base_x = find_channel(recording, "base.x");
  const auto base_y = find_channel(recording, "base.y");
  const auto unit = numbers_attribute(recording, kUnitAttribute);
  if (!unit) return unit.error();
  if (!base_x || !base_y || !*unit || (*unit)->size() != 1) {
    return Error{recording.source + ": has no base.x, base.y and pixels_per_unit to go back to pixels by"};
  }
  Recording out = recording;
  for (std::size_t row = 0; row < out.rows(); ++row) {
    const OutlineFrame frame{recording.channels[*base_x].samples[row], recording.channels[*base_y].samples[row],
                             (*unit)->front()};
    set_row(out, *layout, row, to_pixels(row_of(recording, *layout, row), frame));
  }
  for (std::size_t c : layout->outputs) out.channels[c].unit = "px";
  return out;
}

}  // namespace wisp
