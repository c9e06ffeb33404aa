#include "command.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "reports/learned_model.hpp"
#include "wisp/capture/media/video.hpp"
#include "wisp/learn/recipe_fields.hpp"

namespace wisp::cli {

int Arguments::integer(std::string_view flag) const { return std::atoi(text(flag).c_str()); }

double Arguments::number(std::string_view flag) const { return std::strtod(text(flag).c_str(), nullptr); }

namespace {

// Returns whether round brackets are balanced. names() does not split at commas inside balanced brackets.
bool is_balanced(std::string_view text) {
  int depth = 0;
  for (char c : text) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (depth < 0) return false;
  }
  return depth == 0;
}

}  // namespace

std::vector<std::string> Arguments::names(std::string_view flag) const {
  std::vector<std::string> names;
  if (!has(flag)) return names;
  const std::string& all = text(flag);
  const bool brackets = is_balanced(all);
  int depth = 0;
  bool quoted = false;
  std::string name;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const char c = all[k];
    const bool doubled = quoted && c == '"' && k + 1 < all.size() && all[k + 1] == '"';
    if (c == '"' && !doubled && (quoted || name.empty())) {
      quoted = !quoted;
    } else if (doubled) {
      name += all[++k];
    } else if (c == ',' && !quoted && depth == 0) {
      if (!name.empty()) names.push_back(std::move(name));
      name.clear();
    } else {
      if (brackets) depth += c == '(' ? 1 : c == ')' ? -1 : 0;
      name += c;
    }
  }
  if (!name.empty()) names.push_back(std::move(name));
  return names;
}

bool is_sample_range(const std::string& text) {
  SampleRange range{0, 0};
  int end = -1;
  const bool read = std::sscanf(text.c_str(), "%zu:%zu%n", &range.first, &range.last, &end) == 2;
  return read && text.find_first_not_of("0123456789:") == std::string::npos && end == std::ssize(text) &&
         range.first >= 1 && range.first <= range.last && range.last < std::numeric_limits<std::size_t>::max() / 2;
}

SampleRange Arguments::samples(std::string_view flag) const {
  const std::string& range = text(flag);
  const std::size_t colon = range.find(':');
  return {std::strtoull(range.c_str(), nullptr, 10), std::strtoull(range.c_str() + colon + 1, nullptr, 10)};
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : separator) + word;
  return all;
}

std::string help_of(const Flag& flag) {
  // Some flags list their words in `value`, which the help shows too.
  if (flag.words.empty() || flag.value == joined(flag.words, "|") || flag.kind != Kind::kChoice) return flag.help;
  return flag.help + " (one of " + joined(flag.words, ", ") + ")";
}

Flag ranged(Flag flag, double lowest, double highest) {
  flag.lowest = lowest;
  flag.highest = highest;
  flag.help += "; " + range_text(lowest, highest);
  return flag;
}

std::vector<Flag> flags_of(std::initializer_list<std::vector<Flag>> lists) {
  std::vector<Flag> all;
  for (const std::vector<Flag>& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

const std::vector<Flag>& common_flags() {
  static const std::vector<Flag> flags = {
      {"json", Kind::kSwitch, "", "", "print one JSON document on standard output, and nothing else there"},
      {"quiet", Kind::kSwitch, "", "", "no progress bars"},
      ranged({"unpacked", Kind::kNumber, "GB", "",
              "of numbers that a packed MATLAB file may hold; 64 times the file and at most 1 otherwise"},
             0, 1000),
  };
  return flags;
}

namespace {

// Returns all arguments that may name input files: positionals, paths, and texts (--wind is a word or a file).
std::vector<std::string> files_read(const Command& command, const Arguments& arguments) {
  std::vector<std::string> files = arguments.positionals();
  for (const Flag& flag : command.flags) {
    const bool reads = flag.kind == Kind::kPath || flag.kind == Kind::kText;
    if (reads && arguments.has(flag.name)) files.push_back(arguments.text(flag.name));
  }
  return files;
}

std::vector<std::filesystem::path> files_written(const Flag& flag, const std::filesystem::path& output) {
  std::vector<std::filesystem::path> files{output};
  for (const std::string& name : flag.brings) {
    std::filesystem::path beside = output;
    files.push_back(name.starts_with('.') ? beside.replace_extension(name) : output / name);
  }
  return files;
}

// Returns the kind of a file by its extension; empty for other extensions, which any kind may have.
std::string kind_of(const std::filesystem::path& name) {
  static const std::map<std::string, std::string> kinds = {
      {".csv", "table"},      {".wisp", "model"},     {".html", "page"},       {".json", "document"},
      {".wav", "sound"},      {".png", "picture"},    {".svg", "picture"},     {".mp4", "film"},
      {".mov", "other film"}, {".mkv", "other film"}, {".webm", "other film"}, {".avi", "other film"}};
  const auto known = kinds.find(name.extension().string());
  return known == kinds.end() ? std::string() : known->second;
}

// Returns whether an output's extension belongs to another kind of file than the flag writes (a .png for a table).
bool is_named_for_another_kind(const Flag& flag, const std::string& output) {
  const std::string expected = kind_of(flag.value), found = kind_of(output);
  return !expected.empty() && !found.empty() && expected != found;
}

// Rejects file names with a line break: tables and models store the names of their sources, one per line.
Result<void> check_names(const Command& command, const Arguments& arguments) {
  std::vector<std::pair<std::string, std::string>> names;
  for (const std::string& name : arguments.positionals()) names.push_back({"", name});
  for (const Flag& flag : command.flags) {
    const bool path = flag.kind == Kind::kPath || flag.kind == Kind::kOutput;
    if (path && arguments.has(flag.name)) names.push_back({"--" + flag.name + " ", arguments.text(flag.name)});
  }
  for (const auto& [flag, name] : names) {
    const std::size_t line = name.find_first_of("\n\r");
    if (line == name.npos) continue;
    return Error{flag + name.substr(0, line) + "…: the name has a line break in it; rename the file"};
  }
  return {};
}

}  // namespace

bool would_destroy(const std::filesystem::path& written, const std::string& input) {
  std::error_code none;
  if (!std::filesystem::exists(written, none) || std::filesystem::is_directory(written, none)) return false;
  if (!std::filesystem::is_directory(input, none)) return std::filesystem::equivalent(written, input, none);
  return is_numbered_image(written) && std::filesystem::equivalent(absolute(written).parent_path(), input, none);
}

Result<void> check_outputs(const Command& command, const Arguments& arguments) {
  if (auto ok = check_names(command, arguments); !ok) return ok;
  for (const Flag& flag : command.flags) {
    if (flag.kind != Kind::kOutput || !arguments.has(flag.name)) continue;
    const std::string& output = arguments.text(flag.name);
    if (output == "-") return Error{"--" + flag.name + " -: nothing is written to standard output; give a name"};
    for (const std::filesystem::path& written : files_written(flag, output)) {
      for (const std::string& input : files_read(command, arguments)) {
        if (!would_destroy(written, input)) continue;
        const std::string beside = written == output ? "" : ": " + written.string() + ", which it brings,";
        return Error{"--" + flag.name + " " + output + beside +
                     " is a file that is read, and would be lost: give another name"};
      }
    }
    if (is_named_for_another_kind(flag, output)) {
      return Error{"--" + flag.name + " " + output + ": the name is of another kind of file, expected one such as " +
                   flag.value};
    }
    if (flag.value == "DIR" || (kind_of(output).empty() && flag.value != "M.wisp")) continue;
    if (auto ok = check_writable(output); !ok) return ok;
  }
  return {};
}

Result<void> refuse(const Arguments& arguments, std::initializer_list<const char*> flags, const std::string& why) {
  for (const char* flag : flags) {
    if (arguments.given(flag)) return Error{"--" + std::string(flag) + " " + why};
  }
  return {};
}

}  // namespace wisp::cli
