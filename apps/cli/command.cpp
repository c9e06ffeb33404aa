#include "command.hpp"

#include <cstdlib>

namespace wisp::cli {

int Arguments::integer(std::string_view flag) const { return std::atoi(text(flag).c_str()); }

double Arguments::number(std::string_view flag) const { return std::strtod(text(flag).c_str(), nullptr); }

std::vector<std::string> Arguments::names(std::string_view flag) const {
  std::vector<std::string> names;
  if (!has(flag)) return names;
  std::string_view rest = text(flag);
  while (!rest.empty()) {
    const std::size_t comma = rest.find(',');
    if (comma != 0) names.emplace_back(rest.substr(0, comma));
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  return names;
}

SampleRange Arguments::samples(std::string_view flag) const {
  const std::string& range = text(flag);
  const std::size_t colon = range.find(':');
  return {std::strtoull(range.c_str(), nullptr, 10), std::strtoull(range.c_str() + colon + 1, nullptr, 10)};
}

const std::vector<Flag>& common_flags() {
  static const std::vector<Flag> flags = {
      {"json", Kind::kSwitch, "", "", "print one JSON document on standard output, and nothing else there"},
      {"quiet", Kind::kSwitch, "", "", "no progress bars"},
  };
  return flags;
}

}  // namespace wisp::cli
