// docs/reference/doors.md: every call of the C ABI has its name in each language, or a reason why it is not there.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "house/sources.hpp"

namespace wisp::house::doors_test {
namespace {

using ::testing::IsEmpty;

// All text of the files under some folders or of some files.
std::string text_of(const std::filesystem::path& root, const std::vector<std::string>& places) {
  std::string text;
  for (const std::string& file : project_files(root)) {
    for (const std::string& place : places) {
      if (file.starts_with(place)) text += read_text(root / file);
    }
  }
  return text;
}

std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), last; it != last; ++it) found.push_back((*it)[1]);
  return found;
}

std::set<std::string> words_of(const std::string& text) {
  static const std::regex word(R"(\b([A-Za-z_]\w*)\b)");
  const auto all = matches(text, word);
  return {all.begin(), all.end()};
}

std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream stream(row.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');) {
    cell.erase(0, cell.find_first_not_of(' '));
    cell.erase(cell.find_last_not_of(' ') + 1);
    cells.push_back(cell);
  }
  return cells;
}

// What is wrong with a table of doors, a sentence each.
std::vector<std::string> gaps(const std::string& header, const std::string& table,
                              const std::vector<std::set<std::string>>& languages) {
  static const std::regex function(R"(WISP_API [\w \*]*?\*?(wisp_\w+)\()"), quoted("`([A-Za-z_]+)`");
  const auto declared = matches(header, function);
  std::set<std::string> missing(declared.begin(), declared.end());
  std::vector<std::string> wrong;
  for (const std::string& line : lines_of(table)) {
    if (!line.starts_with("| `wisp_")) continue;
    const auto cells = cells_of(line);
    const std::string name = cells[0].substr(1, cells[0].size() - 2);
    if (missing.erase(name) == 0) wrong.push_back(name + " has a row twice, or is not in wisp.h");
    if (cells.size() != languages.size() + 1) {
      wrong.push_back(name + " has " + std::to_string(cells.size()) + " cells");
      continue;
    }
    for (std::size_t k = 0; k < languages.size(); ++k) {
      const std::string& cell = cells[k + 1];
      if (cell.starts_with("– ")) continue;
      const auto names = matches(cell, quoted);
      if (names.empty()) wrong.push_back(name + " has neither a name nor a reason in column " + std::to_string(k + 2));
      for (const std::string& each : names) {
        if (!languages[k].contains(each)) wrong.push_back(name + ": there is no " + each);
      }
    }
  }
  for (const std::string& name : missing) wrong.push_back(name + " has no row");
  return wrong;
}

TEST(Doors, EveryCallHasItsNameInEveryLanguageOrAReason) {
  const std::filesystem::path root = WISP_SOURCE_DIR;
  const std::vector<std::set<std::string>> languages = {
      words_of(text_of(root, {"include/wisp/base", "include/wisp/model", "include/wisp/run", "include/wisp/sound",
                              "include/wisp/record", "include/wisp/learn"})),
      words_of(text_of(root, {"bindings/unity/Wisp.cs"})),
      words_of(text_of(root, {"bindings/python/wisp/__init__.pyi"})),
      words_of(
          text_of(root, {"bindings/npm/src/bank.ts", "bindings/npm/src/model.ts", "bindings/npm/src/wind.ts",
                         "bindings/npm/src/index.ts", "bindings/npm/src/library.ts", "bindings/npm/src/native.ts"}))};
  EXPECT_THAT(gaps(read_text(root / "include/wisp/wisp.h"), read_text(root / "docs/reference/doors.md"), languages),
              IsEmpty());
}

// What C# declares of the native library is in wisp.h, and its table has nothing that it does not call.
TEST(Doors, WhatCSharpDeclaresIsInTheHeader) {
  const std::filesystem::path root = WISP_SOURCE_DIR;
  const std::string sharp = read_text(root / "bindings/unity/Wisp.cs");
  const auto header = words_of(read_text(root / "include/wisp/wisp.h"));
  for (const std::string& name : matches(sharp, std::regex(R"(extern \w+ (wisp_\w+)\()"))) {
    EXPECT_TRUE(header.contains(name)) << name;
    EXPECT_GT(matches(sharp, std::regex("(Native|return|Text\\()[ .]*()" + name + "\\(")).size(), 0U)
        << name << " is not called";
  }
}

TEST(Doors, GapsAreFound) {
  const std::string header = "WISP_API wisp_status wisp_a(int x);\nWISP_API const char* wisp_b(void);\n";
  EXPECT_THAT(gaps(header, "| `wisp_a` | `A` |\n| `wisp_b` | – no need |\n", {{"A"}}), IsEmpty());
  EXPECT_THAT(gaps(header, "| `wisp_a` | `A` |\n", {{"A"}}), ::testing::ElementsAre("wisp_b has no row"));
  EXPECT_THAT(gaps(header, "| `wisp_a` | `B` |\n| `wisp_b` | |\n", {{"A"}}),
              ::testing::ElementsAre("wisp_a: there is no B", "wisp_b has neither a name nor a reason in column 2"));
}

}  // namespace
}  // namespace wisp::house::doors_test
