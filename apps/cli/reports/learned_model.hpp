#pragma once
// How the commands hand over what they learned.

#include <string>

#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp::cli {

/// Whether a file of that name can be written: asked before work that takes long. Errors: as write_file().
Result<void> check_writable(const std::string& path);

/// Writes a model file that says what a frame of it costs, since players that travel light do not count it themselves.
/// A model in units that no player takes is written without. Errors: as write_model().
Result<void> write_learned(const std::string& path, Model model);

}  // namespace wisp::cli
