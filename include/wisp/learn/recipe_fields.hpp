#pragma once
// Names, ranges and meanings of a recipe's fields, in one table per recipe, from which flags, their help and their
// checks, Python's keywords and the studio's settings are generated. The tables stand below the recipes.

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "wisp/base/result.hpp"

namespace wisp {

/// Words of an enumeration's values, in their order; empty by default.
template <class Enumeration>
inline constexpr std::array<std::string_view, 0> kWordsOf{};

/// Returns the word of a value.
template <class Enumeration>
requires(!kWordsOf<Enumeration>.empty()) constexpr std::string_view word_of(Enumeration value) {
  return kWordsOf<Enumeration>[static_cast<std::size_t>(value)];
}

/// Returns the value of a word; nothing for another word.
template <class Enumeration>
constexpr std::optional<Enumeration> value_of(std::string_view wanted) {
  for (std::size_t k = 0; k < kWordsOf<Enumeration>.size(); ++k) {
    if (kWordsOf<Enumeration>[k] == wanted) return static_cast<Enumeration>(k);
  }
  return std::nullopt;
}

/// Optional properties of a field.
struct FieldTraits {
  const char* flag = nullptr;  ///< flag of `wisp learn`, without dashes; null: no flag, or one that the command defines
  const char* sign = "";       ///< name of the value in the flag's help
  double lowest = -std::numeric_limits<double>::infinity();  ///< lower bound of a number, inclusive
  double highest = std::numeric_limits<double>::infinity();  ///< upper bound of a number, inclusive
  const char* unset = nullptr;         ///< word for 0 or an unset value, which leaves the choice to learn()
  std::array<const char*, 2> words{};  ///< words of a flag for false and for true; none: a switch
};

/// One field of a recipe.
template <class Recipe, class Value>
struct RecipeField {
  const char* name;  ///< name in C++, Python and JSON
  Value Recipe::*member;
  const char* help;
  FieldTraits traits;
};

template <class Recipe, class Value>
constexpr RecipeField<Recipe, Value> field(const char* name, Value Recipe::*member, const char* help,
                                           const FieldTraits& traits = {}) {
  return {name, member, help, traits};
}

/// Describes a range: "0 to 0.9", "0 or more".
std::string range_text(double lowest, double highest);

/// Checks that a field's number is in its range, or unset.
/// Errors: a number out of range, with the field's name and range.
Result<void> check_number(std::string_view name, double value, const FieldTraits& traits);

/// Calls `visit` with each field of a recipe.
template <class Recipe, class Visit>
void for_each_field(const Recipe& recipe, Visit&& visit) {
  std::apply([&](const auto&... field) { (visit(field), ...); }, fields_of(recipe));
}

/// Returns the number in a field; nothing if the field is unset or not a number.
template <class Value>
constexpr std::optional<double> number_of(const Value& value) {
  if constexpr (std::is_same_v<Value, std::optional<int>>) {
    if (value) return *value;
  } else if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>) {
    return static_cast<double>(value);
  }
  return std::nullopt;
}

/// Checks that all numbers of a recipe are in their ranges.
/// Errors: the first number out of its range, with the field's name and range.
template <class Recipe>
Result<void> check_fields(const Recipe& recipe) {
  Result<void> all;
  for_each_field(recipe, [&](const auto& field) {
    const auto number = number_of(recipe.*(field.member));
    if (all && number) all = check_number(field.name, *number, field.traits);
  });
  return all;
}

}  // namespace wisp
