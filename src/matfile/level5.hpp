#pragma once
// The outermost structure of a MATLAB file of level 5.

#include <filesystem>

namespace wisp {

/// Whether the file's data elements, each a tag of type and size and that many bytes, end where the file ends. A reader
/// that is not asked first may take what is missing for zeros.
/// Source: MathWorks, MAT-File Format, chapter 1. Returns false where the file cannot be read.
bool level5_is_whole(const std::filesystem::path& path);

}  // namespace wisp
