#pragma once
// Runs the program `wisp` as a user does, and keeps what it said.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "folder_test.hpp"
#include "paths.hpp"

namespace wisp {

struct Said {
  int status = -1;
  std::string out;
  std::string err;

  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

inline std::string file_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// `arguments` as for a shell. The program's output goes to files beside `folder`.
inline Said run_wisp(const std::string& arguments, const std::filesystem::path& folder) {
  const auto out = folder / "said.out", err = folder / "said.err";
  const std::string line =
      std::string(WISP_PROGRAM) + " " + arguments + " >" + out.string() + " 2>" + err.string() + " </dev/null";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, file_text(out), file_text(err)};
}

/// A test of the program in a folder of its own.
class InFolder : public FolderTest {
 protected:
  Said wisp(const std::string& arguments) { return run_wisp(arguments, folder_); }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }
};

/// Where the recordings of real things are; empty where they are not.
inline std::string data_folder() {
  const char* named = std::getenv("WISP_DATA");
  const std::string folder = named ? named : WISP_SOURCE_DIR "/../shared/data";
  return std::filesystem::exists(folder) ? folder : "";
}

}  // namespace wisp
