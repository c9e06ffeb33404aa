#pragma once
// The models that come with Wisp, where `wisp play` looks for them.

#include <filesystem>
#include <vector>

namespace wisp::cli {

/// Folders that are looked into, in this order: $WISP_MODELS; share/wisp/models beside the installed program; the
/// source tree that it was built from; out/demo, where `wisp demo` leaves its model.
std::vector<std::filesystem::path> model_folders();

/// The models in the first of them that has any: flames first, then what falls, then others, by name within each. Files
/// that are no model are passed over.
std::vector<std::filesystem::path> shipped_models();

}  // namespace wisp::cli
