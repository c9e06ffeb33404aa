#include "wisp/model/extinction.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

namespace wisp {
namespace {

struct Range {
  const char* name;
  double value;
  double lowest;
  double highest;
};

// Sizes of a simulated candle, 60 per second, 255 for full size: four extinctions by puffs of wind, one re-ignition.
constexpr double kBorrowedHz = 60;
constexpr std::uint8_t kDying[] = {191, 128, 64, 237, 178, 119, 59, 242, 161, 121, 81, 40, 230, 173, 115, 58};
constexpr std::uint32_t kDyingEnds[] = {3, 7, 12, 16};
constexpr std::uint8_t kCatching[] = {167, 222, 255, 255, 197, 197, 207, 220, 228, 231, 234, 237, 240, 244,
                                      246, 243, 241, 242, 246, 249, 250, 250, 249, 251, 251, 253, 253, 253,
                                      254, 254, 254, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255};
constexpr std::uint32_t kCatchingEnds[] = {42};

// Converts events from kBorrowedHz to `rate_hz`: each step takes the size at the same share of its event, rounded down.
FlameEvents borrowed(std::span<const std::uint8_t> sizes, std::span<const std::uint32_t> ends, double rate_hz) {
  FlameEvents out;
  std::uint32_t begin = 0;
  for (const std::uint32_t end : ends) {
    const double rows = end - begin, steps = std::clamp(std::round(rows * rate_hz / kBorrowedHz), 1.0, 1024.0);
    for (int k = 0; k < static_cast<int>(steps); ++k) {
      out.sizes.push_back(sizes[begin + static_cast<std::size_t>(k / steps * rows)]);
    }
    out.ends.push_back(static_cast<std::uint32_t>(out.sizes.size()));
    begin = end;
  }
  return out;
}

bool is_scale(double scale) { return scale >= 0 && std::isfinite(scale); }

Result<void> check(const FlameEvents& events, std::size_t components, const std::string& what) {
  const bool counted =
      events.ends.size() <= FlameEvents::kMaxEvents && events.sizes.size() <= FlameEvents::kMaxSizes &&
      (events.empty() ? 0 : events.ends.back()) == events.sizes.size() && (events.empty() || events.ends.front() > 0) &&
      std::adjacent_find(events.ends.begin(), events.ends.end(), std::greater_equal<>()) == events.ends.end();
  const bool shaped = (events.scale.empty() || events.scale.size() == components) &&
                      events.shapes.size() == events.sizes.size() * events.scale.size() &&
                      std::all_of(events.scale.begin(), events.scale.end(), is_scale);
  if (counted && shaped) return {};
  return Error{"the extinction rule's events of " + what + " are " + std::to_string(events.ends.size()) + " with " +
               std::to_string(events.sizes.size()) + " sizes and " + std::to_string(events.shapes.size()) +
               " numbers of shapes, expected at most 64, one after the other, each with some, and no shape or " +
               std::to_string(components) + " numbers a size"};
}

}  // namespace

FlameEvents dying_of(const Extinction& rule, double rate_hz) {
  return rule.dying.empty() ? borrowed(kDying, kDyingEnds, rate_hz) : rule.dying;
}

FlameEvents catching_of(const Extinction& rule, double rate_hz) {
  return rule.catching.empty() ? borrowed(kCatching, kCatchingEnds, rate_hz) : rule.catching;
}

Result<void> check(const Extinction& rule, std::size_t inputs, std::size_t components) {
  if (rule.input >= inputs) {
    return Error{"the extinction rule listens to input " + std::to_string(rule.input) + ", the model has " +
                 std::to_string(inputs)};
  }
  for (const Range& range : {Range{"level", rule.level, 1e-6, 1e6}, Range{"seconds", rule.seconds, 1e-3, 3600},
                             Range{"haste", rule.haste, 0, 100}, Range{"recovery", rule.recovery, 1e-3, 3600}}) {
    if (range.value >= range.lowest && range.value <= range.highest) continue;
    return Error{std::string("the extinction rule's ") + range.name + " is " + std::to_string(range.value) +
                 ", expected " + std::to_string(range.lowest) + " to " + std::to_string(range.highest)};
  }
  if (auto ok = check(rule.dying, 0, "dying"); !ok) return ok;
  return check(rule.catching, components, "catching");
}

}  // namespace wisp
