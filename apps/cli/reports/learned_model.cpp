#include "reports/learned_model.hpp"

#include <filesystem>
#include <fstream>

#include "wisp/base/file.hpp"
#include "wisp/model/file.hpp"

namespace wisp::cli {

Flag output_flag(std::vector<std::string> unless) {
  unless.push_back("json");
  return {"output",
          Kind::kOutput,
          "M.wisp",
          "",
          "where to write the model; with --json not needed: then there is the report alone",
          {},
          true,
          std::move(unless)};
}

std::string model_path(const Arguments& arguments) {
  return arguments.has("output") ? arguments.text("output") : std::string();
}

std::string model_name(const Arguments& arguments) {
  return std::filesystem::path(model_path(arguments)).stem().string();
}

Result<void> check_writable(const std::string& path) {
  if (path.empty()) return {};
  auto pending = PendingFile::create(path);
  if (!pending) return pending.error();
  // Tries to write, as some folders report write permission and refuse it.
  if (std::ofstream(pending->path())) return {};
  return Error{path + ": cannot be written: no file can be made in its folder"};
}

Result<void> hand_over(const Result<Fit>& fit, const Arguments& arguments, Terminal& terminal) {
  if (!fit) return fit.error();
  const std::string path = model_path(arguments);
  if (!path.empty()) {
    if (auto ok = write_model(path, fit->model); !ok) return ok;
  }
  terminal.show(fit->report);
  if (!path.empty()) {
    terminal.say("wrote " + path);
    terminal.add("output", path);
  }
  terminal.add("seconds", terminal.seconds());
  return {};
}

}  // namespace wisp::cli
