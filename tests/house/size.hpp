#pragma once
// How large the house is: lines, public headers, sources in a folder, lines of a function.

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "house/sources.hpp"

namespace wisp::house {

/// `text` with comments and what stands in quotes blanked out: the same lines, and no brace that is none.
inline std::string code_only(const std::string& text) {
  static const std::regex silent(
      "//[^\n]*|/\\*[^*]*\\*+(?:[^/*][^*]*\\*+)*/|\"(?:\\\\.|[^\"\\\\\n])*\"|'(?:\\\\.|[^'\\\\\n])[^'\n]{0,3}'");
  std::string out = text;
  // Raw strings first: nothing in them is escaped.
  for (std::size_t at = out.find("R\""); at != std::string::npos; at = out.find("R\"", at + 1)) {
    const std::size_t open = out.find('(', at);
    if (open == std::string::npos) break;
    const std::string close = ")" + out.substr(at + 2, open - at - 2) + "\"";
    const std::size_t end = std::min(out.find(close, open), out.size() - close.size());
    for (std::size_t i = at; i < end + close.size(); ++i) out[i] = out[i] == '\n' ? '\n' : ' ';
  }
  const std::string escaped = out;
  for (std::sregex_iterator it(escaped.begin(), escaped.end(), silent), last; it != last; ++it) {
    for (std::ptrdiff_t i = it->position(); i < it->position() + it->length(); ++i) {
      if (out[static_cast<std::size_t>(i)] != '\n') out[static_cast<std::size_t>(i)] = ' ';
    }
  }
  return out;
}

struct Function {
  std::string name;
  int line = 0;   ///< where it begins, 1-based
  int lines = 0;  ///< from its name to its last brace
};

/// Whether a brace after `before` only gives a value: within parentheses, after a name or after =.
inline bool gives_value(const std::string& before) {
  static const std::regex named(R"(^\s*(inline |static |const |constexpr )*[\w:<>, ]+ \w+\s*=)");
  if (before.empty()) return false;
  const bool open = std::count(before.begin(), before.end(), '(') != std::count(before.begin(), before.end(), ')');
  const auto end = before.find_last_not_of(" \n");
  return open || !std::isspace(static_cast<unsigned char>(before.back())) ||
         (end != std::string::npos && before[end] == '=') || std::regex_search(before, named);
}

/// Whether what stands before a brace begins a function: it has parameters, and is no type and no namespace.
inline bool begins_function(const std::string& before) {
  static const std::regex other(R"(^\s*(namespace|class|struct|union|enum|extern)\b[^(]*$)");
  return before.find('(') != std::string::npos && !std::regex_search(before, other);
}

/// Every function with a body in a C++ source laid out by clang-format, in order; those within functions are part of
/// them.
inline std::vector<Function> functions_of(const std::string& text) {
  static const std::regex name_of(R"(([\w:~]+)\s*\()");
  const std::string code = code_only(text);
  std::vector<Function> found;
  std::vector<bool> values;           // of the braces that are open, which only give a value
  std::size_t begin = 0, inside = 0;  // inside: how many braces are open within the function, or 0
  int line = 1;
  for (std::size_t at = 0; at < code.size(); ++at) {
    const char c = code[at];
    bool ends = c == ';';
    if (c == '\n') {
      ++line;
      // A line of the preprocessor has no semicolon to end it.
      const std::size_t first = code.find_first_not_of(" \n", begin);
      ends = first < at && code[first] == '#';
    } else if (c == '{') {
      std::string before = code.substr(begin, at - begin);
      before.erase(0, std::min(before.find_first_not_of(" \n"), before.size()));
      values.push_back(inside == 0 && gives_value(before));
      ends = !values.back();
      if (ends && inside == 0 && begins_function(before)) {
        std::smatch name;
        std::regex_search(before, name, name_of);
        const auto breaks = static_cast<int>(std::count(before.begin(), before.end(), '\n'));
        found.push_back({name.size() > 1 ? name[1].str() : before, line - breaks, 0});
        inside = values.size();
      }
    } else if (c == '}' && !values.empty()) {
      if (values.size() == inside) {
        found.back().lines = line - found.back().line + 1;
        inside = 0;
      }
      ends = !values.back();
      values.pop_back();
    }
    if (ends) begin = at + 1;
  }
  return found;
}

/// The house proper: what is counted. Tests, studies, tools and examples are beside it.
inline bool in_the_house(const std::string& file) {
  return is_cpp_source(file) && (file.starts_with("include/") || file.starts_with("src/") ||
                                 file.starts_with("apps/cli/") || file.starts_with("apps/window/"));
}

struct NamedFunction {
  std::string file;
  Function function;
};

/// All functions of the house, the longest first.
inline std::vector<NamedFunction> functions_by_length(const std::filesystem::path& root) {
  std::vector<NamedFunction> all;
  for (const std::string& file : project_files(root)) {
    if (!in_the_house(file)) continue;
    for (const Function& function : functions_of(read_text(root / file))) all.push_back({file, function});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.function.lines > b.function.lines; });
  return all;
}

/// How many sources (.cpp) each folder of the house has of its own.
inline std::map<std::string, int> sources_by_folder(const std::filesystem::path& root) {
  std::map<std::string, int> count;
  for (const std::string& file : project_files(root)) {
    if (in_the_house(file) && file.ends_with(".cpp")) ++count[std::filesystem::path(file).parent_path().string()];
  }
  return count;
}

inline int public_headers(const std::filesystem::path& root) {
  const auto files = project_files(root);
  return static_cast<int>(std::count_if(files.begin(), files.end(), [](const std::string& file) {
    return file.starts_with("include/") && (file.ends_with(".hpp") || file.ends_with(".h"));
  }));
}

/// Lines of include/, src/, apps/cli/ and apps/window/, by their first folders; those of src/learn once more by
/// themselves.
inline std::map<std::string, int> lines_by_folder(const std::filesystem::path& root) {
  std::map<std::string, int> count;
  for (const std::string& file : project_files(root)) {
    if (!in_the_house(file)) continue;
    const std::size_t after = file.starts_with("apps/") ? std::string("apps/").size() : 0;
    const int lines = static_cast<int>(lines_of(read_text(root / file)).size());
    count[file.substr(0, file.find('/', after))] += lines;
    if (file.starts_with("src/learn/")) count["src/learn"] += lines;
  }
  return count;
}

/// Lines written by hand of the whole house.
inline int lines_together(const std::filesystem::path& root) {
  int total = 0;
  for (const auto& [folder, lines] : lines_by_folder(root)) total += folder == "src/learn" ? 0 : lines;
  return total;
}

/// The flags of every command, as the manual (docs/reference/cli.md) lists them.
inline std::map<std::string, std::set<std::string>> flags_by_command(const std::string& manual) {
  std::map<std::string, std::set<std::string>> flags;
  std::string command;
  for (const std::string& line : lines_of(manual)) {
    static const std::regex row(R"(^\| `(?:-\w, )?(--[\w-]+))");
    std::smatch match;
    if (line.starts_with("## ")) command = line.substr(3);
    if (!command.empty() && std::regex_search(line, match, row)) flags[command].insert(match[1]);
  }
  return flags;
}

}  // namespace wisp::house
