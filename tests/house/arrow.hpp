#pragma once
// The arrow between layers, as docs/architecture.md draws it, and the check that holds the tree to it.

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "house/sources.hpp"

namespace wisp::house {

/// What a layer may include beside itself and the C++ standard library.
struct Layer {
  std::set<std::string> layers;              ///< layers below it
  std::vector<std::string> outside_private;  ///< prefixes of outside headers that its sources may include
  std::set<std::string> shared{};            ///< private headers of it that the layers above it may include: what the
                                             ///< house has in common and no user needs
};

/// The layers by their folder under include/wisp/ and src/. No layer's public headers include anything from outside.
inline const std::map<std::string, Layer>& layers() {
  static const std::vector<std::string> ffmpeg{"libavcodec/", "libavformat/", "libavutil/", "libswscale/",
                                               "libswresample/"};
  static const std::vector<std::string> draws{"cairo",      "libavcodec/", "libavformat/",
                                              "libavutil/", "libswscale/", "libswresample/"};
  static const std::map<std::string, Layer> table{
      // The one place that speaks to the operating system about files.
      {"base",
       {{},
        {"fcntl.h", "unistd.h", "io.h", "process.h"},
        {"base/hash.hpp", "base/json_text.hpp", "base/path_text.hpp", "base/statistics.hpp", "base/verdict.hpp"}}},
      {"model", {{"base"}, {"flatbuffers/", "wisp_generated.h"}, {"model/bspline.hpp"}}},
      // The compiler's own header of the processor's vector instructions.
      {"run", {{"base", "model"}, {"immintrin.h"}}},
      {"sound", {{"base"}, {}}},
      {"c", {{"base", "model", "run", "sound"}, {}, {"c/boundary.hpp"}}},
      {"c_learn", {{"base", "model", "record", "learn", "c"}, {}}},
      {"record",
       {{"base"}, {}, {"record/csv_cells.hpp", "record/loudness.hpp", "record/number_text.hpp", "record/verdict.hpp"}}},
      {"matfile", {{"base", "record"}, {"zlib.h"}}},
      {"umbrella",
       {{"base", "model", "run", "sound", "record", "learn", "capture", "capture/vision", "capture/clip",
         "capture/media", "describe"},
        {}}},
      {"describe", {{"base"}, {"nlohmann/"}}},
      {"export", {{"base", "model", "run"}, {}}},
      {"learn", {{"base", "model", "run", "sound", "record"}, {"Eigen/"}}},
      {"capture/vision", {{"base", "model", "record"}, {}, {"capture/vision/film_look.hpp"}}},
      {"capture/clip",
       {{"base", "model", "sound", "record", "capture/vision"},
        {},
        {"capture/clip/clip_ear.hpp", "capture/clip/frame_grid.hpp", "capture/clip/views/view_join.hpp"}}},
      {"capture/media", {{"base", "model", "sound", "record", "capture/vision", "capture/clip"}, ffmpeg}},
      {"capture", {{"base", "model", "sound", "record", "capture/vision", "capture/clip", "capture/media"}, {}}},
      {"simulate", {{"base", "model", "record"}, {}}},
      {"draw", {{"base", "model", "run", "record"}, draws}},
  };
  return table;
}

/// The layer of a path below include/wisp/ or src/ (or of an include): the longest matching folder.
inline std::optional<std::string> layer_of(const std::string& path) {
  if (path == "wisp.h") return "c";
  if (path == "learn.hpp" || path == "play.hpp") return "umbrella";
  std::optional<std::string> best;
  for (const auto& [name, layer] : layers()) {
    if (path.starts_with(name + "/") && (!best || name.size() > best->size())) best = name;
  }
  return best;
}

inline const std::set<std::string>& standard_headers() {
  static const std::set<std::string> names{
      "algorithm", "any", "array", "atomic", "barrier", "bit", "bitset", "cassert", "ccomplex", "cctype", "cerrno",
      "cfenv", "cfloat", "charconv", "chrono", "cinttypes", "climits", "clocale", "cmath", "compare", "complex",
      "concepts", "condition_variable", "coroutine", "csetjmp", "csignal", "cstdarg", "cstddef", "cstdint", "cstdio",
      "cstdlib", "cstring", "ctime", "cuchar", "cwchar", "cwctype", "deque", "exception", "execution", "filesystem",
      "forward_list", "fstream", "functional", "future", "initializer_list", "iomanip", "ios", "iosfwd", "iostream",
      "istream", "iterator", "latch", "limits", "list", "locale", "map", "memory", "memory_resource", "mutex", "new",
      "numbers", "numeric", "optional", "ostream", "queue", "random", "ranges", "ratio", "regex", "scoped_allocator",
      "semaphore", "set", "shared_mutex", "source_location", "span", "sstream", "stack", "stdexcept", "stop_token",
      "streambuf", "string", "string_view", "system_error", "thread", "tuple", "type_traits", "typeindex", "typeinfo",
      "unordered_map", "unordered_set", "utility", "valarray", "variant", "vector", "version",
      // C's own, for wisp.h.
      "assert.h", "stdbool.h", "stddef.h", "stdint.h"};
  return names;
}

inline bool starts_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(), [&](const auto& prefix) { return text.starts_with(prefix); });
}

/// Why `include`, met in a file of `layer`, runs against the arrow; nothing when it does not.
inline std::optional<std::string> objection(const std::string& layer, bool public_header, const Include& include) {
  const Layer& own = layers().at(layer);
  const bool names_public = include.quoted && include.name.starts_with("wisp/");
  const auto target = layer_of(names_public ? include.name.substr(5) : include.name);
  if (names_public && !target) return "includes \"" + include.name + "\", which belongs to no layer";
  if (target && *target != layer && !names_public && !layers().at(*target).shared.contains(include.name)) {
    return "includes \"" + include.name + "\", a private header of " + *target;
  }
  if (target && *target != layer && !own.layers.contains(*target)) {
    return "includes \"" + include.name + "\": " + layer + " may not include " + *target;
  }
  if (target) {
    if (public_header && !names_public) return "is public and includes the private header \"" + include.name + "\"";
    return {};
  }
  if (standard_headers().contains(include.name)) return {};
  if (!starts_with_any(include.name, own.outside_private)) {
    return "includes <" + include.name + ">, which " + layer + " may not use";
  }
  if (public_header) return "is public and includes <" + include.name + ">: outside libraries stay private";
  return {};
}

/// Whether a file is an umbrella header, which gathers the public headers of one job: include/wisp/play.hpp.
inline bool is_umbrella(const std::string& file) {
  const std::filesystem::path path(file);
  return path.parent_path() == "include/wisp" && path.extension() == ".hpp";
}

/// Why an umbrella header may not include this: it gathers public headers, and no library includes it.
inline std::optional<std::string> umbrella_objection(const Include& include) {
  if (standard_headers().contains(include.name)) return {};
  if (include.quoted && include.name.starts_with("wisp/") && layer_of(include.name.substr(5))) return {};
  return "gathers public headers and includes \"" + include.name + "\", which is none";
}

/// Whether an application's source may include this: public headers and its own files, any outside library but those
/// that belong to a layer.
inline std::optional<std::string> application_objection(const Include& include) {
  if (include.quoted && include.name.starts_with("wisp/")) return {};
  if (layer_of(include.name)) return "includes \"" + include.name + "\", a private header";
  for (const auto& [name, layer] : layers()) {
    // What the operating system and the compiler offer is no layer's own.
    if (name != "base" && name != "run" && starts_with_any(include.name, layer.outside_private)) {
      return "includes <" + include.name + ">, which belongs to " + name;
    }
  }
  return {};
}

/// The include with a file named beside the including one written in full: "knots.hpp" in src/learn/ is
/// "learn/knots.hpp".
inline Include in_full(const std::filesystem::path& root, const std::string& file, Include include) {
  if (!include.quoted) return include;
  const auto beside = (std::filesystem::path(file).parent_path() / include.name).lexically_normal();
  if (!std::filesystem::exists(root / beside)) return include;
  const std::string path = beside.generic_string();
  for (const std::string top : {"include/", "src/"}) {
    if (path.starts_with(top)) include.name = path.substr(top.size());
  }
  return include;
}

/// Every include in the tree at `root` that runs against the arrow, one line each: FILE:LINE: why.
inline std::vector<std::string> arrow_violations(const std::filesystem::path& root) {
  std::vector<std::string> violations;
  for (const std::string& file : project_files(root)) {
    if (!is_cpp_source(file)) continue;
    const bool public_header = file.starts_with("include/wisp/");
    const bool library = public_header || file.starts_with("src/");
    if (!library && !file.starts_with("apps/")) continue;
    const bool umbrella = is_umbrella(file);
    std::optional<std::string> layer;
    if (library && !umbrella) {
      layer = layer_of(file.substr(public_header ? std::string("include/wisp/").size() : std::string("src/").size()));
      if (!layer) {
        violations.push_back(file + ": belongs to no layer of docs/architecture.md");
        continue;
      }
    }
    for (const Include& written : includes_of(read_text(root / file))) {
      const Include include = in_full(root, file, written);
      const auto why = umbrella ? umbrella_objection(include)
                       : layer  ? objection(*layer, public_header, include)
                                : application_objection(include);
      if (why) violations.push_back(file + ":" + std::to_string(written.line) + ": " + *why);
    }
  }
  return violations;
}

/// Every `wisp_layer(NAME … USES …)` in the tree at `root` that links a layer which NAME may not include.
inline std::vector<std::string> link_violations(const std::filesystem::path& root) {
  static const std::regex call(R"(wisp_layer\(([^)]*)\))");
  static const std::set<std::string> keywords{"FOLDER", "USES", "LINKS", "OPTIONS"};
  std::vector<std::string> violations;
  for (const std::string& file : project_files(root)) {
    if (!file.starts_with("src/") || !file.ends_with("CMakeLists.txt")) continue;
    const std::string text = read_text(root / file);
    for (std::sregex_iterator it(text.begin(), text.end(), call), end; it != end; ++it) {
      std::istringstream words((*it)[1]);
      std::string name, keyword;
      std::vector<std::string> uses;
      words >> name;
      std::string folder = name;
      for (std::string word; words >> word;) {
        if (keywords.contains(word))
          keyword = word;
        else if (keyword == "FOLDER")
          folder = word;
        else if (keyword == "USES")
          uses.push_back(word);
      }
      const auto layer = layers().find(folder);
      if (layer == layers().end()) {
        violations.push_back(file + ": " + name + " is no layer of docs/architecture.md");
        continue;
      }
      for (const std::string& used : uses) {
        const auto& below = layer->second.layers;
        if (!below.contains(used) && !below.contains("capture/" + used)) {
          violations.push_back(file + ": " + name + " may not use " + used);
        }
      }
    }
  }
  return violations;
}

}  // namespace wisp::house
