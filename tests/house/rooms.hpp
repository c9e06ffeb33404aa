#pragma once
// The rooms of the layers that are large enough to have some: in which order they stand, and what runs against it.

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "house/arrow.hpp"

namespace wisp::house {

/// A room is a folder of a layer. It may include the rooms that stand lower, and none at its own height but itself.
struct Rooms {
  std::string layer;                   ///< its folder below src/
  std::map<std::string, int> heights;  ///< by the room's path below the layer's folder; "" is the folder itself
};

/// The floors of docs/architecture.md. A folder below a room of the table belongs to that room.
inline const std::vector<Rooms>& rooms() {
  static const std::vector<Rooms> table{
      {"learn",
       {{"numeric", 0},
        {"fidelity", 1},
        {"rows", 2},
        {"fit", 3},
        {"judge", 4},
        {"choose", 5},
        {"report", 6},
        {"arx", 7},
        {"outline", 8},
        {"chain", 8},
        {"markov", 8},
        {"flame", 9},
        {"flicker", 9},
        {"", 10}}},
      {"run", {{"lanes", 0}, {"state", 1}, {"arx", 2}, {"chain", 2}, {"bank", 3}, {"", 4}}},
      {"capture", {{"vision", 0}, {"clip", 1}, {"clip/fall", 2}, {"clip/views", 2}, {"media", 3}, {"", 4}}},
  };
  return table;
}

/// The room of a path below the layer's folder: the longest name of the table that is a folder of it.
inline std::optional<std::string> room_of(const Rooms& layer, const std::string& path) {
  std::string folder = std::filesystem::path(path).parent_path().generic_string();
  while (!layer.heights.contains(folder)) {
    if (folder.empty()) return {};
    const auto slash = folder.rfind('/');
    if (slash == std::string::npos) return {};
    folder.resize(slash);
  }
  return folder;
}

/// One room that includes another which does not stand below it, as "learn/outline -> learn/flame".
using Climb = std::string;

/// All climbs of the tree at `root`, each with the first file that makes it; a folder without a place in the table as
/// "learn/attic has no floor".
inline std::map<Climb, std::string> climbs(const std::filesystem::path& root) {
  std::map<Climb, std::string> found;
  for (const std::string& file : project_files(root)) {
    if (!is_cpp_source(file) || !file.starts_with("src/")) continue;
    for (const Rooms& layer : rooms()) {
      const std::string folder = "src/" + layer.layer + "/";
      if (!file.starts_with(folder)) continue;
      const auto from = room_of(layer, file.substr(folder.size()));
      if (!from) {
        const auto parent = std::filesystem::path(file).parent_path().generic_string().substr(4);
        found.emplace(parent + " has no floor", file);
        continue;
      }
      for (const Include& written : includes_of(read_text(root / file))) {
        const Include include = in_full(root, file, written);
        if (!include.quoted || !include.name.starts_with(layer.layer + "/")) continue;
        const auto to = room_of(layer, include.name.substr(layer.layer.size() + 1));
        if (!to || *to == *from || layer.heights.at(*to) < layer.heights.at(*from)) continue;
        found.emplace(layer.layer + "/" + *from + " -> " + layer.layer + "/" + *to, file);
      }
    }
  }
  return found;
}

}  // namespace wisp::house
