#include "outputs.hpp"

#include <filesystem>
#include <map>

#include "wisp/capture/media/video.hpp"

namespace wisp::cli {
namespace {

// Flags whose values may name input files; a wind is a word or a file.
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

// Whether writing a file would overwrite an input or an image of an input folder, under any name.
bool would_destroy(const std::filesystem::path& written, const std::string& input) {
  std::error_code none;
  if (!std::filesystem::exists(written, none) || std::filesystem::is_directory(written, none)) return false;
  if (!std::filesystem::is_directory(input, none)) return std::filesystem::equivalent(written, input, none);
  return is_numbered_image(written) && std::filesystem::equivalent(absolute(written).parent_path(), input, none);
}

// The kind of file of an extension; empty: any.
std::string kind_of(const std::filesystem::path& name) {
  static const std::map<std::string, std::string> kinds = {
      {".csv", "table"}, {".wisp", "model"},  {".html", "page"},   {".json", "document"},
      {".wav", "sound"}, {".png", "picture"}, {".svg", "picture"}, {".mp4", "film"},
      {".mov", "film"},  {".mkv", "film"},    {".webm", "film"}};
  const auto known = kinds.find(name.extension().string());
  return known == kinds.end() ? std::string() : known->second;
}

// Rejects names whose extension contradicts the contents, such as a table in a .png.
bool is_named_for_another_kind(const Flag& flag, const std::string& output) {
  const std::string expected = kind_of(flag.value), found = kind_of(output);
  return !expected.empty() && !found.empty() && expected != found;
}

// A table of figures and a model name what they were made of, a line each.
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

Result<void> check_outputs(const Command& command, const Arguments& arguments) {
  if (auto ok = check_names(command, arguments); !ok) return ok;
  for (const Flag& flag : command.flags) {
    if (flag.kind != Kind::kOutput || !arguments.has(flag.name)) continue;
    const std::string& output = arguments.text(flag.name);
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
  }
  return {};
}

}  // namespace wisp::cli
