#include "wisp/model/extinction.hpp"

#include <string>

namespace wisp {
namespace {

struct Range {
  const char* name;
  double value;
  double lowest;
  double highest;
};

}  // namespace

Result<void> check(const Extinction& rule, std::size_t inputs) {
  if (rule.input >= inputs) {
    return Error{"the extinction rule listens to input " + std::to_string(rule.input) + ", the model has " +
                 std::to_string(inputs)};
  }
  for (const Range& range : {Range{"level", rule.level, 1e-6, 1e6}, Range{"seconds", rule.seconds, 1e-3, 3600},
                             Range{"haste", rule.haste, 0, 100}, Range{"recovery", rule.recovery, 1e-3, 3600},
                             Range{"dying", rule.decay, 0, 60}, Range{"catching", rule.re_ignition, 0, 60}}) {
    if (range.value >= range.lowest && range.value <= range.highest) continue;
    return Error{std::string("the extinction rule's ") + range.name + " is " + std::to_string(range.value) +
                 ", expected " + std::to_string(range.lowest) + " to " + std::to_string(range.highest)};
  }
  return {};
}

}  // namespace wisp
