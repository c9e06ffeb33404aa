// The house stays small enough to be known: short functions, folders that one look takes in, few public headers.
// script/figures prints what is measured here.

#include "house/size.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>

#include "paths.hpp"

namespace wisp::house::size_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Ceilings, to be lowered as the house gets smaller.
constexpr int kFunctionLines = 60;
constexpr int kFolderSources = 25;
constexpr int kPublicHeaders = 56;
constexpr int kLinesTogether = 71'758;
constexpr int kLinesOfLearn = 20'624;
constexpr int kFlagsTogether = 83;
constexpr std::size_t kFlagsOfACommand = 20;
// Commands that have more flags than they should.
const std::map<std::string, std::size_t> kTooManyFlags{{"wisp learn arx", 28},
                                                       {"wisp learn chain", 23},
                                                       {"wisp learn leaf", 23},
                                                       {"wisp validate", 25},
                                                       {"wisp report", 22}};

std::string manual() { return read_text(std::filesystem::path(WISP_SOURCE_DIR) / "docs/reference/cli.md"); }

std::vector<std::string> overloaded_commands(const std::string& manual,
                                             const std::map<std::string, std::size_t>& allowed) {
  std::vector<std::string> found;
  for (const auto& [command, flags] : flags_by_command(manual)) {
    const auto more = allowed.find(command);
    if (flags.size() > (more == allowed.end() ? kFlagsOfACommand : more->second)) {
      found.push_back(command + " has " + std::to_string(flags.size()) + " flags");
    }
  }
  return found;
}

std::size_t flags_together(const std::string& manual) {
  std::set<std::string> all;
  for (const auto& [command, flags] : flags_by_command(manual)) all.insert(flags.begin(), flags.end());
  return all.size();
}

std::vector<std::string> long_functions(const std::filesystem::path& root, int most) {
  std::vector<std::string> found;
  for (const auto& [file, function] : functions_by_length(root)) {
    if (function.lines <= most) break;
    found.push_back(file + ":" + std::to_string(function.line) + ": " + function.name + " has " +
                    std::to_string(function.lines) + " lines");
  }
  return found;
}

std::vector<std::string> full_folders(const std::filesystem::path& root, int most) {
  std::vector<std::string> found;
  for (const auto& [folder, count] : sources_by_folder(root)) {
    if (count > most) found.push_back(folder + " has " + std::to_string(count) + " sources");
  }
  return found;
}

TEST(Size, Figures) {
  for (const auto& [top, lines] : lines_by_folder(WISP_SOURCE_DIR)) {
    std::cout << "lines of " << top << ": " << lines << "\n";
  }
  std::cout << "lines together: " << lines_together(WISP_SOURCE_DIR)
            << "\npublic headers: " << public_headers(WISP_SOURCE_DIR)
            << "\nflags of all commands: " << flags_together(manual()) << "\n";
  std::vector<std::pair<int, std::string>> folders;
  for (const auto& [folder, count] : sources_by_folder(WISP_SOURCE_DIR)) folders.emplace_back(-count, folder);
  std::sort(folders.begin(), folders.end());
  folders.resize(std::min<std::size_t>(folders.size(), 8));
  for (const auto& [count, folder] : folders) std::cout << "sources in " << folder << ": " << -count << "\n";
  auto functions = functions_by_length(WISP_SOURCE_DIR);
  ASSERT_GT(functions.size(), 1000u) << "the functions of the house were not found";
  functions.resize(10);
  for (const auto& [file, function] : functions) {
    std::cout << "lines of " << function.name << " (" << file << ":" << function.line << "): " << function.lines
              << "\n";
  }
}

TEST(Size, FunctionsAreShort) { EXPECT_THAT(long_functions(WISP_SOURCE_DIR, kFunctionLines), IsEmpty()); }

TEST(Size, FoldersAreNotFull) { EXPECT_THAT(full_folders(WISP_SOURCE_DIR, kFolderSources), IsEmpty()); }

TEST(Size, PublicHeadersAreFew) { EXPECT_LE(public_headers(WISP_SOURCE_DIR), kPublicHeaders); }

TEST(Size, TheHouseIsSmall) {
  EXPECT_LE(lines_together(WISP_SOURCE_DIR), kLinesTogether);
  EXPECT_LE(lines_by_folder(WISP_SOURCE_DIR)["src/learn"], kLinesOfLearn);
}

TEST(Size, CommandsHaveFewFlags) {
  EXPECT_THAT(overloaded_commands(manual(), kTooManyFlags), IsEmpty());
  EXPECT_LE(flags_together(manual()), static_cast<std::size_t>(kFlagsTogether));
}

TEST(Size, EveryLineOfTheHouseIsCountedOnce) {
  ScratchTree tree;
  tree.add("include/wisp/a.hpp", "1\n2\n").add("src/learn/fit/a.cpp", "1\n2\n3\n").add("src/run/a.cpp", "1\n");
  tree.add("apps/cli/a.cpp", "1\n").add("apps/window/a.cpp", "1\n2\n").add("tests/run/a_test.cpp", "1\n");
  tree.add("src/model/wisp_generated.h", "1\n").add("apps/web/a.ts", "1\n");
  EXPECT_EQ(lines_together(tree.root()), 9);
  EXPECT_EQ(lines_by_folder(tree.root())["src/learn"], 3);
  EXPECT_EQ(lines_by_folder(tree.root())["apps/window"], 2);
}

TEST(Size, CommandsWithManyFlagsAreFound) {
  std::string text = "Every command\n| `--json` | | text |\n## wisp one\n\n| flag | default | meaning |\n";
  for (char c = 'a'; c <= 'u'; ++c) text += std::string("| `-o, --flag-") + c + " N` | `1` | what |\n";
  text += "\n## wisp two\n| `--flag-a` | | see `--other` |\n";
  EXPECT_THAT(overloaded_commands(text, {}), ElementsAre("wisp one has 21 flags"));
  EXPECT_THAT(overloaded_commands(text, {{"wisp one", 21}}), IsEmpty());
  EXPECT_EQ(flags_together(text), 21u);
}

TEST(Size, LongFunctionsAreFound) {
  ScratchTree tree;
  tree.add("src/run/a.cpp",
           "#include <map>\n"
           "namespace wisp {\n"
           "const std::map<int, char> kBraces = {{1, '{'}, {2, '}'}};  // } and {\n"
           "struct Pair {\n"
           "  int sum() const { return a + b; }\n"
           "  int a = 0;\n"
           "  int b = 0;\n"
           "};\n"
           "int brief() { return 1'000; }\n"
           "int Pair::lengthy(int a,\n"
           "                  int b) {\n"
           "  const auto text = R\"({ { {)\";\n"
           "  if (a < b) {\n"
           "    return [&] { return 1; }();\n"
           "  }\n"
           "  return 2;\n"
           "}\n"
           "Bank::Bank(int n) : n_(n), rows_{n} {\n"
           "  fill();\n"
           "  fill();\n"
           "  fill();\n"
           "}\n"
           "}  // namespace wisp\n");
  tree.add("tests/run/a_test.cpp", "int long_test() {\n\n\n\n\n\n\n\n\n}\n");
  EXPECT_THAT(long_functions(tree.root(), 4),
              ElementsAre("src/run/a.cpp:10: Pair::lengthy has 8 lines", "src/run/a.cpp:18: Bank::Bank has 5 lines"));
}

TEST(Size, FullFoldersAndManyHeadersAreFound) {
  ScratchTree tree;
  for (const std::string name : {"a", "b", "c"}) {
    tree.add("src/learn/arx/" + name + ".cpp", "").add("src/learn/arx/" + name + ".hpp", "");
    tree.add("include/wisp/learn/" + name + ".hpp", "");
  }
  tree.add("src/learn/d.cpp", "");
  EXPECT_THAT(full_folders(tree.root(), 2), ElementsAre("src/learn/arx has 3 sources"));
  EXPECT_EQ(public_headers(tree.root()), 3);
}

}  // namespace
}  // namespace wisp::house::size_test
