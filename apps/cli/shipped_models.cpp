#include "shipped_models.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>

#include "wisp/model/file.hpp"

namespace wisp::cli {
namespace {

namespace fs = std::filesystem;

// The first flame is that of the default recipe, as on the page.
constexpr const char* kFirst = "flame.wisp";

// Order of the list: the first flame, other kinds, then flames of other orders.
int rank(const fs::path& path, const View& view) {
  if (path.filename() == kFirst) return 0;
  if (std::holds_alternative<PlainView>(view)) return 3;
  return std::holds_alternative<OutlineView>(view) ? 2 : 1;
}

std::vector<fs::path> models_in(const fs::path& folder) {
  std::vector<std::pair<std::pair<int, fs::path>, fs::path>> found;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder, code)) {
    if (entry.path().extension() != ".wisp") continue;
    if (const auto model = read_model(entry.path()))
      found.push_back({{rank(entry.path(), model->view), entry.path()}, entry.path()});
  }
  std::sort(found.begin(), found.end());
  std::vector<fs::path> paths;
  paths.reserve(found.size());
  for (auto& [order, path] : found) paths.push_back(path);
  return paths;
}

}  // namespace

std::vector<fs::path> model_folders() {
  std::vector<fs::path> folders;
  if (const char* named = std::getenv("WISP_MODELS")) folders.emplace_back(named);
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  if (!code) folders.push_back(program.parent_path().parent_path() / "share/wisp/models");
  folders.emplace_back(WISP_MODELS_FOLDER);
  folders.emplace_back("out/demo");
  return folders;
}

std::vector<fs::path> shipped_models() {
  for (const fs::path& folder : model_folders()) {
    if (auto models = models_in(folder); !models.empty()) return models;
  }
  return {};
}

}  // namespace wisp::cli
