#pragma once
// Words for the values of an enumeration: one table for parsing, printing and help.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace wisp {

/// The words of an enumeration, each beside its value.
template <class Enum, std::size_t N>
using Words = std::array<std::pair<std::string_view, Enum>, N>;

/// The word of `value`; empty where the table has none.
template <class Enum, std::size_t N>
constexpr std::string_view word_of(const Words<Enum, N>& words, Enum value) {
  for (const auto& [word, named] : words) {
    if (named == value) return word;
  }
  return {};
}

/// The value that `word` names, nothing where the table does not have it.
template <class Enum, std::size_t N>
constexpr std::optional<Enum> value_of(const Words<Enum, N>& words, std::string_view word) {
  for (const auto& [known, value] : words) {
    if (known == word) return value;
  }
  return {};
}

/// All words, "a, b or c", for messages.
template <class Enum, std::size_t N>
std::string list_of(const Words<Enum, N>& words) {
  std::string list;
  for (std::size_t i = 0; i < N; ++i) {
    if (i > 0) list += i + 1 == N ? " or " : ", ";
    list += words[i].first;
  }
  return list;
}

}  // namespace wisp
