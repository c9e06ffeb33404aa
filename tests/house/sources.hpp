#pragma once
// Reading the tree as text: which files there are and what they include.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "paths.hpp"

namespace wisp::house {

/// One #include line.
struct Include {
  std::string name;     ///< what stands between the quotes or the angle brackets
  bool quoted = false;  ///< "name" rather than <name>
  int line = 0;         ///< 1-based
};

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// All #include lines of a C or C++ source, in their order, those behind #if too.
inline std::vector<Include> includes_of(const std::string& text) {
  static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^">]+)[">])");
  std::vector<Include> found;
  int number = 0;
  for (const std::string& line : lines_of(text)) {
    ++number;
    std::smatch match;
    if (line.find("include") == std::string::npos) continue;
    if (std::regex_search(line, match, pattern)) found.push_back({match[2], match[1] == "\"", number});
  }
  return found;
}

inline bool is_cpp_source(const std::filesystem::path& path) {
  static const std::set<std::string> extensions{".h", ".hpp", ".c", ".cpp", ".inc"};
  return extensions.contains(path.extension().string());
}

/// All files of the project under `root`, as sorted paths relative to it with forward slashes. What is built, fetched,
/// made by running or others' is left out.
inline std::vector<std::string> project_files(const std::filesystem::path& root) {
  static const std::set<std::string> not_ours{".git", "build", "out", "node_modules", ".cache", "third_party"};
  std::vector<std::string> files;
  std::filesystem::recursive_directory_iterator walk(root);
  for (auto it = begin(walk); it != end(walk); ++it) {
    const std::string name = it->path().filename().string();
    if (it->is_directory() && not_ours.contains(name)) it.disable_recursion_pending();
    // In a work tree of git's, .git is a file. The reader of model files is flatc's, weights are a fitting tool's.
    if (name == ".git" || name == "wisp_generated.h" || name.ends_with("_weights.hpp")) continue;
    if (it->is_regular_file()) files.push_back(it->path().lexically_relative(root).generic_string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// A folder under the build that only the running test has, empty when made and removed when done: a small tree for a
/// check to judge.
class ScratchTree {
 public:
  ScratchTree() : root_(std::filesystem::path(WISP_BINARY_DIR) / "house" / test_name()) {
    std::filesystem::remove_all(root_);
    std::filesystem::create_directories(root_);
  }
  ~ScratchTree() {
    std::error_code ignored;
    std::filesystem::remove_all(root_, ignored);
  }
  ScratchTree(const ScratchTree&) = delete;
  ScratchTree& operator=(const ScratchTree&) = delete;

  ScratchTree& add(const std::string& path, const std::string& text) {
    std::filesystem::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path, std::ios::binary) << text;
    return *this;
  }

  const std::filesystem::path& root() const { return root_; }

 private:
  static std::string test_name() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    return std::string(test->test_suite_name()) + "." + test->name();
  }

  std::filesystem::path root_;
};

}  // namespace wisp::house
