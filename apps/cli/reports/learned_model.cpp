#include "reports/learned_model.hpp"

#include <fstream>

#include "wisp/base/file.hpp"
#include "wisp/model/file.hpp"

namespace wisp::cli {

Result<void> check_writable(const std::string& path) {
  auto pending = PendingFile::create(path);
  if (!pending) return pending.error();
  // Some folders let nobody write though they say otherwise.
  if (std::ofstream(pending->path())) return {};
  return Error{path + ": cannot be written: no file can be made in its folder"};
}

Result<void> hand_over(const Fit& fit, const std::string& path, std::chrono::steady_clock::time_point start,
                       Terminal& terminal) {
  if (auto ok = write_model(path, fit.model); !ok) return ok;
  terminal.show(fit.report);
  terminal.say("wrote " + path);
  terminal.add("output", path);
  terminal.add("seconds", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return {};
}

}  // namespace wisp::cli
