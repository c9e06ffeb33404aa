#pragma once
// The models that come with Wisp, where `wisp play` looks for them.

#include <filesystem>
#include <vector>

namespace wisp::cli {

/// Folders searched, in this order: $WISP_MODELS; share/wisp/models beside the installed program; the
/// source tree that it was built from; out/demo, where `wisp demo` leaves its model.
std::vector<std::filesystem::path> model_folders();

/// The models of the first folder that has any: flames, falling things, others, each by name. Skips files that are no
/// models.
std::vector<std::filesystem::path> shipped_models();

}  // namespace wisp::cli
