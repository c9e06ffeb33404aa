#pragma once
// A page of reports and pictures that needs nothing beside it.

#include <filesystem>
#include <string>
#include <vector>

#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"

namespace wisp::cli {

/// A heading, what is said under it, and the pictures below: .svg and .png files.
struct PagePart {
  std::string title;
  Report report;
  std::vector<std::filesystem::path> pictures{};
};

/// The page as HTML, its pictures within it. Errors: a picture that cannot be read.
Result<std::string> report_page(const std::string& title, const std::vector<PagePart>& parts);

}  // namespace wisp::cli
