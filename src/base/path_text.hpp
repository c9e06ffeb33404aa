#pragma once
// A path as text for messages: UTF-8 everywhere. path::string() is in the code page of the machine on Windows, in which
// a name may have no text.

#include <filesystem>
#include <string>

namespace wisp {

inline std::string path_text(const std::filesystem::path& path) {
  const std::u8string text = path.u8string();
  return {text.begin(), text.end()};
}

}  // namespace wisp
