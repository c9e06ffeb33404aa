#include "wisp/learn/recipe_fields.hpp"

#include <algorithm>

#include "record/number_text.hpp"
#include "wisp/learn/chain_recipe.hpp"

namespace wisp {

std::string range_text(double lowest, double highest) {
  const std::string from = number_text(lowest, 6);
  return std::isfinite(highest) ? from + " to " + number_text(highest, 10) : from + " or more";
}

Result<void> check_number(std::string_view name, double value, const FieldTraits& traits) {
  if (std::isfinite(value) && value >= traits.lowest && value <= traits.highest) return {};
  if (value == 0 && traits.unset) return {};
  return Error{std::string(name) + " is " + number_text(value, 6) + ", expected " +
               range_text(traits.lowest, traits.highest)};
}

Result<EventSpec> parse_event(std::string_view text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const auto kind = value_of<EventKind>(text.substr(0, colon));
  if (kind && colon + 1 < text.size()) return EventSpec{*kind, std::string(text.substr(colon + 1))};
  return Error{"the event is \"" + std::string(text) +
               "\", expected zero:SIGNAL, min:SIGNAL or max:SIGNAL, such as min:horizontal_speed"};
}

std::string word_of(const EventSpec& event) { return std::string(word_of(event.kind)) + ":" + event.signal; }

}  // namespace wisp
