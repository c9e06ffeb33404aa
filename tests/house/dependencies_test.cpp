// docs/reference/dependencies.md is complete: all that CMake looks for and all that script/bootstrap installs is on it,
// and all packages on it are installed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "house/sources.hpp"
#include "paths.hpp"

namespace wisp::house::dependencies_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;

std::set<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::set<std::string> words;
  for (std::string word; stream >> word;) words.insert(word);
  return words;
}

/// What the project's own CMake files look for by find_package, find_program, find_path or pkg_check_modules.
std::set<std::string> looked_for(const std::filesystem::path& root) {
  static const std::regex call(R"((find_package|find_program|find_path|find_library|pkg_check_modules)\s*\(([^)]*)\))");
  static const std::set<std::string> keywords{"REQUIRED",  "QUIET",  "IMPORTED_TARGET",        "GLOBAL",
                                              "NO_MODULE", "CONFIG", "NO_CMAKE_FIND_ROOT_PATH"};
  static const std::regex version("[0-9.]+");
  std::set<std::string> names;
  for (const std::string& file : project_files(root)) {
    // Tests and examples have projects of their own that look for Wisp.
    const bool cmake = file.ends_with("CMakeLists.txt") || file.ends_with(".cmake");
    if (!cmake || file.starts_with("tests/house/") || file.starts_with("examples/")) continue;
    const std::string text = read_text(root / file);
    for (std::sregex_iterator it(text.begin(), text.end(), call), end; it != end; ++it) {
      std::istringstream arguments((*it)[2]);
      std::string word;
      // All but find_package name a variable first.
      if ((*it)[1] != "find_package") arguments >> word;
      while (arguments >> word && word != "COMPONENTS" && word != "PATHS") {
        const bool variable = word.starts_with("${");
        if (!variable && !keywords.contains(word) && !std::regex_match(word, version)) names.insert(word);
        if ((*it)[1] == "find_package") break;
      }
    }
  }
  return names;
}

/// The words between backquotes in the tables of a page.
std::set<std::string> listed(const std::string& page) {
  static const std::regex quoted("`([^`]+)`");
  std::set<std::string> names;
  for (const std::string& line : lines_of(page)) {
    if (!line.starts_with("|")) continue;
    for (std::sregex_iterator it(line.begin(), line.end(), quoted), end; it != end; ++it) names.insert((*it)[1]);
  }
  return names;
}

/// The packages in the lists of script/bootstrap: NAME_packages=( … ).
std::set<std::string> installed_packages(const std::string& script) {
  static const std::regex list(R"([a-z]+_packages=\(([^)]*)\))");
  std::set<std::string> names;
  for (std::sregex_iterator it(script.begin(), script.end(), list), end; it != end; ++it)
    names.merge(words_of((*it)[1]));
  return names;
}

/// The words between backquotes in the columns "Debian packages" of a page's tables.
std::set<std::string> listed_packages(const std::string& page) {
  std::set<std::string> names;
  std::size_t column = 0;
  for (const std::string& line : lines_of(page)) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
    const auto heading = std::find(cells.begin(), cells.end(), " Debian packages ");
    if (heading != cells.end()) column = static_cast<std::size_t>(heading - cells.begin());
    if (line.starts_with("|") && column < cells.size()) names.merge(listed("|" + cells[column]));
  }
  return names;
}

std::string page() { return read_text(std::filesystem::path(WISP_SOURCE_DIR) / "docs/reference/dependencies.md"); }

TEST(Dependencies, AllThatCMakeLooksForIsListed) {
  const auto names = listed(page());
  std::vector<std::string> forgotten;
  for (const std::string& name : looked_for(WISP_SOURCE_DIR)) {
    if (!names.contains(name)) forgotten.push_back(name);
  }
  EXPECT_THAT(forgotten, IsEmpty());
  EXPECT_THAT(looked_for(WISP_SOURCE_DIR), IsSupersetOf({"GTest", "Eigen3", "cairo"}));
}

TEST(Dependencies, ThePackagesListedAreThoseThatBootstrapInstalls) {
  const auto installed = installed_packages(read_text(std::filesystem::path(WISP_SOURCE_DIR) / "script/bootstrap"));
  EXPECT_EQ(listed_packages(page()), installed);
  EXPECT_THAT(installed, IsSupersetOf({"cmake", "debootstrap", "libeigen3-dev"}));
}

TEST(Dependencies, AForgottenOneIsFound) {
  ScratchTree tree;
  tree.add("src/CMakeLists.txt",
           "find_package(Zlib 1.2 REQUIRED NO_MODULE)\npkg_check_modules(X REQUIRED\n  one two)\n");
  EXPECT_THAT(looked_for(tree.root()), ElementsAre("Zlib", "one", "two"));
  EXPECT_THAT(listed("| Eigen | `Eigen3` |\n`Zlib`\n"), ElementsAre("Eigen3"));
  EXPECT_THAT(installed_packages("a_packages=(\n  x y\n)\nb_packages=(z)\n"), ElementsAre("x", "y", "z"));
  EXPECT_THAT(listed_packages("| a | Debian packages |\n| --- | --- |\n| `no` | `x`, `y` |\n"), ElementsAre("x", "y"));
}

}  // namespace
}  // namespace wisp::house::dependencies_test
