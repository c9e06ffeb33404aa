#include "reports/learned_model.hpp"

#include <fstream>

#include "wisp/base/file.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/cost.hpp"

namespace wisp::cli {

Result<void> check_writable(const std::string& path) {
  auto pending = PendingFile::create(path);
  if (!pending) return pending.error();
  // Some folders let nobody write though they say otherwise.
  if (std::ofstream(pending->path())) return {};
  return Error{path + ": cannot be written: no file can be made in its folder"};
}

Result<void> write_learned(const std::string& path, Model model) {
  if (const auto cost = count_operations(model)) {
    model.training.multiply_adds_per_frame = cost->multiply_adds_per_frame;
    model.training.operations_per_frame = cost->operations_per_frame;
  }
  return write_model(path, model);
}

}  // namespace wisp::cli
