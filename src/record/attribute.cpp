#include <algorithm>
#include <cmath>

#include "record/number_text.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

std::optional<std::string_view> find_attribute(const Recording& recording, std::string_view name) {
  for (const Attribute& attribute : recording.attributes) {
    if (attribute.name == name) return attribute.value;
  }
  return std::nullopt;
}

Result<std::optional<std::vector<double>>> numbers_attribute(const Recording& recording, std::string_view name) {
  const auto text = find_attribute(recording, name);
  if (!text) return std::optional<std::vector<double>>();
  std::vector<double> values;
  const char* at = text->data();
  const char* const end = at + text->size();
  while (at != end) {
    if (*at == ' ' || *at == '\t') {
      ++at;
      continue;
    }
    double value = 0;
    const auto [next, code] = read_number(at, end, value);
    const bool whole = next == end || *next == ' ' || *next == '\t';
    if (code != std::errc() || !whole || !std::isfinite(value)) {
      return Error{recording.source + ": \"# " + std::string(name) + "\" holds \"" +
                   std::string(at, std::find(at, end, ' ')) + "\", expected numbers separated by blanks"};
    }
    values.push_back(value);
    at = next;
  }
  return std::optional(std::move(values));
}

void set_numbers_attribute(Recording& recording, std::string_view name, std::span<const double> values) {
  std::string text;
  for (double value : values) text += (text.empty() ? "" : " ") + number_text(value);
  for (Attribute& attribute : recording.attributes) {
    if (attribute.name == name) {
      attribute.value = std::move(text);
      return;
    }
  }
  recording.attributes.push_back({std::string(name), std::move(text)});
}

}  // namespace wisp
