#pragma once
// Settings of a call: JSON, in which any field may be missing.

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#define WISP_STUDIO(name) __attribute__((export_name("studio_" #name)))

namespace wisp::studio {

inline nlohmann::json parsed(const char* text, std::size_t size) {
  return nlohmann::json::parse(text, text + size, nullptr, false);
}

inline std::optional<int> whole(const nlohmann::json& from, const char* name) {
  const auto found = from.find(name);
  if (found == from.end() || !found->is_number()) return std::nullopt;
  return found->get<int>();
}

inline std::vector<std::string> names(const nlohmann::json& from, const char* name) {
  const auto found = from.find(name);
  return found == from.end() || !found->is_array() ? std::vector<std::string>()
                                                   : found->get<std::vector<std::string>>();
}

}  // namespace wisp::studio
