#pragma once
// A path as text for messages, in UTF-8 on every platform. On Windows path::string() is in the machine's code page, in
// which a name may have no representation.

#include <filesystem>
#include <string>

namespace wisp {

inline std::string path_text(const std::filesystem::path& path) {
  const std::u8string text = path.u8string();
  return {text.begin(), text.end()};
}

}  // namespace wisp
