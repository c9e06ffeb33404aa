#pragma once
// Every model that is shipped with the page or kept as a file of the format: what a door promises holds for all of
// them.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "paths.hpp"

namespace wisp {

inline std::vector<std::string> shipped_models() {
  std::vector<std::string> paths;
  for (const char* folder :
       {"/apps/web/public/models", "/apps/web/tests/models", "/tests/model/golden", "/tests/c/models"}) {
    for (const auto& entry : std::filesystem::directory_iterator(WISP_SOURCE_DIR + std::string(folder))) {
      if (entry.path().extension() == ".wisp") paths.push_back(entry.path().string());
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace wisp
