#include "wisp/model/extinction.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
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

// Sizes of the simulated candle at 60 rows per second: a clip of --wind puffs.
constexpr double kBorrowedHz = 60;
constexpr std::uint8_t kDying[] = {191, 128, 64, 237, 178, 119, 59, 242, 161, 121, 81, 40, 230, 173, 115, 58};
constexpr std::uint32_t kDyingEnds[] = {3, 7, 12, 16};
constexpr std::uint8_t kCatching[] = {
    167, 222, 255, 255, 197, 197, 207, 220, 228, 231, 234, 237, 240, 244, 246, 243, 241, 242, 246, 249, 250,
    250, 249, 251, 251, 253, 253, 253, 254, 254, 254, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    167, 219, 255, 255, 199, 197, 207, 219, 227, 231, 235, 237, 239, 243, 246, 243, 241, 241, 245, 249, 250,
    249, 249, 249, 251, 252, 253, 253, 253, 254, 254, 254, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    165, 220, 254, 255, 199, 197, 207, 219, 228, 231, 235, 237, 240, 243, 246, 244, 241, 241, 244, 249, 249,
    249, 249, 250, 251, 253, 253, 252, 253, 254, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255};
constexpr std::uint32_t kCatchingEnds[] = {42, 84, 126};

// Returns the events at another rate, with interpolated sizes.
SizeEvents borrowed(std::span<const std::uint8_t> sizes, std::span<const std::uint32_t> ends, double rate_hz) {
  SizeEvents out;
  std::size_t begin = 0;
  for (const std::uint32_t end : ends) {
    const auto rows = static_cast<double>(end - begin);
    const auto steps = std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(rows * rate_hz / kBorrowedHz)), 1,
                                               SizeEvents::kMaxSizes / SizeEvents::kMaxEvents);
    for (std::size_t k = 0; k < steps; ++k) {
      const double at = std::min(rows - 1, static_cast<double>(k) * kBorrowedHz / rate_hz), share = at - std::floor(at);
      const std::size_t row = begin + static_cast<std::size_t>(at);
      out.sizes.push_back(static_cast<std::uint8_t>(
          std::lround((1 - share) * sizes[row] + share * sizes[std::min<std::size_t>(row + 1, end - 1)])));
    }
    out.ends.push_back(static_cast<std::uint32_t>(out.sizes.size()));
    begin = end;
  }
  return out;
}

Result<void> check(const SizeEvents& events, const std::string& what) {
  const bool counted =
      events.ends.size() <= SizeEvents::kMaxEvents && events.sizes.size() <= SizeEvents::kMaxSizes &&
      (events.empty() ? 0 : events.ends.back()) == events.sizes.size() && (events.empty() || events.ends.front() > 0) &&
      std::adjacent_find(events.ends.begin(), events.ends.end(), std::greater_equal<>()) == events.ends.end();
  if (counted) return {};
  return Error{"the extinction rule's events of " + what + " are " + std::to_string(events.ends.size()) + " with " +
               std::to_string(events.sizes.size()) +
               " sizes, expected at most 64, one after the other, each with some"};
}

}  // namespace

SizeEvents dying_of(const Extinction& rule, double rate_hz) {
  return rule.dying.empty() ? borrowed(kDying, kDyingEnds, rate_hz) : rule.dying;
}

SizeEvents catching_of(const Extinction& rule, double rate_hz) {
  return rule.catching.empty() ? borrowed(kCatching, kCatchingEnds, rate_hz) : rule.catching;
}

Result<void> check(const Extinction& rule, std::size_t inputs) {
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
  if (auto ok = check(rule.dying, "dying"); !ok) return ok;
  return check(rule.catching, "catching");
}

}  // namespace wisp
