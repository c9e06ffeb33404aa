#pragma once
// Flags of `wisp learn` and their conversion to a recipe, from the recipe's table of fields.

#include <algorithm>
#include <concepts>
#include <string>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/learn/chain_recipe.hpp"
#include "wisp/learn/recipe_fields.hpp"

namespace wisp::cli {

template <class Value, class... Others>
concept OneOf = (std::same_as<Value, Others> || ...);

/// Types of fields set by a single flag. Commands define other flags themselves (orders, extinction, a preparation).
template <class Value>
concept FlagValue = std::is_enum_v<Value> || std::is_arithmetic_v<Value> ||
    OneOf<Value, std::string, std::vector<std::string>, std::optional<int>, EventSpec>;

/// Returns the flag of a recipe's field with default `value`.
template <FlagValue Value>
Flag flag_of(const Value& value, const FieldTraits& traits, const char* help) {
  Flag flag{traits.flag, Kind::kText, traits.sign, "", help};
  if constexpr (std::is_enum_v<Value>) {
    flag.kind = Kind::kChoice;
    flag.fallback = word_of(value);
    flag.words.assign(kWordsOf<Value>.begin(), kWordsOf<Value>.end());
  } else if constexpr (std::same_as<Value, bool>) {
    flag.kind = traits.words[1] ? Kind::kChoice : Kind::kSwitch;
    if (traits.words[1]) flag.words.assign(traits.words.begin(), traits.words.end());
    if (traits.words[1]) flag.fallback = traits.words[value];
  } else if constexpr (std::same_as<Value, std::string>) {
    flag.fallback = value;
  } else if constexpr (std::same_as<Value, std::vector<std::string>>) {
    flag.kind = Kind::kNames;
  } else if constexpr (std::same_as<Value, EventSpec>) {
    flag.fallback = word_of(value);
  } else {
    const double number = number_of(value).value_or(0);
    flag.kind = traits.unset ? Kind::kIntegerOrWord : std::same_as<Value, double> ? Kind::kNumber : Kind::kInteger;
    flag.fallback = traits.unset && number == 0 ? traits.unset : shown(number, 10);
    if (traits.unset) flag.words = {traits.unset};
    if (std::isfinite(traits.highest)) return ranged(std::move(flag), traits.lowest, traits.highest);
  }
  return flag;
}

/// Sets a field from its flag. Errors: an event of the wrong form.
template <FlagValue Value>
Result<void> read_flag(const Arguments& arguments, const FieldTraits& traits, Value& value) {
  if (!arguments.has(traits.flag)) return {};
  const std::string& text = arguments.text(traits.flag);
  if constexpr (std::is_enum_v<Value>) {
    value = *value_of<Value>(text);
  } else if constexpr (std::same_as<Value, bool>) {
    value = !traits.words[1] || text == traits.words[1];
  } else if constexpr (std::same_as<Value, std::string>) {
    value = text;
  } else if constexpr (std::same_as<Value, std::vector<std::string>>) {
    value = arguments.names(traits.flag);
  } else if constexpr (std::same_as<Value, EventSpec>) {
    auto event = parse_event(text);
    if (!event) return Error{"--" + std::string(traits.flag) + ": " + event.error().message};
    value = *std::move(event);
  } else if (traits.unset && text == traits.unset) {
    value = {};
  } else if constexpr (std::same_as<Value, double>) {
    value = arguments.number(traits.flag);
  } else {
    value = static_cast<Value>(arguments.integer(traits.flag));
  }
  return {};
}

/// Returns the flags of a recipe's fields, in the order of the table of fields. Defaults are the recipe's.
template <class Recipe>
std::vector<Flag> recipe_flags(const Recipe& defaults) {
  std::vector<Flag> flags;
  for_each_field(defaults, [&](const auto& field) {
    const auto& value = defaults.*(field.member);
    if constexpr (FlagValue<std::remove_cvref_t<decltype(value)>>) {
      if (field.traits.flag) flags.push_back(flag_of(value, field.traits, field.help));
    }
  });
  return flags;
}

inline Flag& flag_named(std::vector<Flag>& flags, std::string_view name) {
  return *std::find_if(flags.begin(), flags.end(), [&](const Flag& flag) { return flag.name == name; });
}

/// Sets all fields that have flags; the parser has checked words and ranges. Errors: as read_flag().
template <class Recipe>
Result<void> read_recipe(const Arguments& arguments, Recipe& recipe) {
  Result<void> all;
  for_each_field(recipe, [&](const auto& field) {
    auto& value = recipe.*(field.member);
    if constexpr (FlagValue<std::remove_cvref_t<decltype(value)>>) {
      if (all && field.traits.flag) all = read_flag(arguments, field.traits, value);
    }
  });
  return all;
}

}  // namespace wisp::cli
