// Names that say what is inside, tests that are found by their place, and no word of the machine that a file was
// written on.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>

#include "house/sources.hpp"
#include "paths.hpp"

namespace wisp::house::names_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Files whose name, or a folder of theirs, says nothing about what is inside.
std::vector<std::string> vague_names(const std::filesystem::path& root) {
  static const std::regex vague("(^|[/_.-])(utils?|helpers?|misc|common)([/_.-]|$)");
  std::vector<std::string> found;
  for (const std::string& file : project_files(root)) {
    if (std::regex_search(file, vague)) found.push_back(file);
  }
  return found;
}

/// Whether `line` holds an absolute path that begins with the folder `top`.
bool names_folder(const std::string& line, const std::string& top) {
  static const std::string in_a_path = "_.-}";
  for (std::size_t at = line.find(top); at != std::string::npos; at = line.find(top, at + 1)) {
    if (at == 0) return true;
    const char before = line[at - 1];
    if (!std::isalnum(static_cast<unsigned char>(before)) && in_a_path.find(before) == std::string::npos) return true;
  }
  return false;
}

/// Lines with an absolute path that exists only where they were written: FILE:LINE.
std::vector<std::string> machine_paths(const std::filesystem::path& root) {
  std::vector<std::string> found;
  for (const std::string& file : project_files(root)) {
    int number = 0;
    for (const std::string& line : lines_of(read_text(root / file))) {
      ++number;
      for (const std::string top : {"root", "home", "work", "tmp"}) {
        if (names_folder(line, "/" + top + "/")) found.push_back(file + ":" + std::to_string(number));
      }
    }
  }
  return found;
}

/// Folders under tests/ with tests that tests/CMakeLists.txt does not build: they would never run.
std::vector<std::string> forgotten_test_folders(const std::filesystem::path& root) {
  const std::string list = read_text(root / "tests/CMakeLists.txt");
  std::set<std::string> folders;
  for (const std::string& file : project_files(root)) {
    if (!file.starts_with("tests/") || !file.ends_with("_test.cpp")) continue;
    folders.insert(std::filesystem::path(file).parent_path().lexically_relative("tests").generic_string());
  }
  std::vector<std::string> forgotten;
  const auto named = [&](const std::filesystem::path& folder) {
    return list.find("wisp_tests(" + folder.generic_string() + " ") != std::string::npos ||
           list.find("add_subdirectory(" + folder.generic_string() + ")") != std::string::npos;
  };
  for (const std::string& folder : folders) {
    // A folder is built with the one that it is in.
    std::filesystem::path at = folder;
    while (!at.empty() && !named(at)) at = at.parent_path();
    if (at.empty()) forgotten.push_back(folder);
  }
  return forgotten;
}

TEST(Names, SayWhatIsInside) { EXPECT_THAT(vague_names(WISP_SOURCE_DIR), IsEmpty()); }

TEST(Names, ThatSayNothingAreFound) {
  ScratchTree tree;
  tree.add("src/run/utils.hpp", "").add("src/common/a.cpp", "").add("src/run/math_helpers.cpp", "");
  tree.add("src/run/commonality.cpp", "");
  EXPECT_THAT(vague_names(tree.root()),
              ElementsAre("src/common/a.cpp", "src/run/math_helpers.cpp", "src/run/utils.hpp"));
}

TEST(TestFolders, AreAllBuilt) { EXPECT_THAT(forgotten_test_folders(WISP_SOURCE_DIR), IsEmpty()); }

TEST(TestFolders, ThatAreForgottenAreFound) {
  ScratchTree tree;
  tree.add("tests/CMakeLists.txt", "wisp_tests(run LINKS wisp::run)\nadd_subdirectory(house)\n");
  tree.add("tests/run/a_test.cpp", "")
      .add("tests/run/arx/d_test.cpp", "")
      .add("tests/house/b_test.cpp", "")
      .add("tests/capture/sound/c_test.cpp", "");
  EXPECT_THAT(forgotten_test_folders(tree.root()), ElementsAre("capture/sound"));
}

TEST(MachinePaths, AreNowhereInTheTree) { EXPECT_THAT(machine_paths(WISP_SOURCE_DIR), IsEmpty()); }

TEST(MachinePaths, AreFound) {
  ScratchTree tree;
  const std::string slash = "/";
  tree.add("docs/a.md", "fine\nsee " + slash + "root/notes\n");
  tree.add("script/b", "cd " + slash + "home/someone/wisp\n");
  tree.add("src/c.cpp", "// see " + slash + "tmp/x\n");
  tree.add("src/d.cpp", "#include \"house/work/d.hpp\"\n// ${TMPDIR:-" + slash + "tmp}\n");
  EXPECT_THAT(machine_paths(tree.root()), ElementsAre("docs/a.md:2", "script/b:1", "src/c.cpp:1"));
}

}  // namespace
}  // namespace wisp::house::names_test
