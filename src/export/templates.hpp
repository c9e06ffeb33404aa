#pragma once
// Text templates with placeholders. Each is a file NAME.in of this folder, converted to a string constant by the build.

#include <string>
#include <utility>
#include <vector>

namespace wisp::exporting {

extern const char *const lamp_h, *const lamp_c, *const plant_h, *const plant_c, *const plant_m, *const plant_py;

/// Replaces every @KEY@ in a text by the key's word.
inline std::string filled(std::string text, const std::vector<std::pair<std::string, std::string>>& words) {
  for (const auto& [key, word] : words) {
    const std::string mark = "@" + key + "@";
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + word.size())) {
      text.replace(at, mark.size(), word);
    }
  }
  return text;
}

/// Returns whether the text is an identifier: letters, digits and _, no digit first. Keywords are not excluded.
bool is_name(std::string_view name);

/// Removes characters that would end a comment, a quotation or a line: * " and control characters.
std::string comment_text(std::string text);

}  // namespace wisp::exporting
