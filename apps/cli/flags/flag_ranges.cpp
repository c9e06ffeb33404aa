#include "flags/flag_ranges.hpp"

#include <cstdlib>

#include "terminal.hpp"

namespace wisp::cli {

Result<void> check_ranges(const Arguments& arguments, std::span<const FlagRange> ranges) {
  for (const FlagRange& range : ranges) {
    if (!arguments.has(range.flag)) continue;
    char* end = nullptr;
    const double value = std::strtod(arguments.text(range.flag).c_str(), &end);
    if (*end != '\0' || (value >= range.lowest && value <= range.highest)) continue;
    return Error{std::string("--") + range.flag + " is " + arguments.text(range.flag) + ", expected " +
                 shown(range.lowest) + " to " + shown(range.highest, 6)};
  }
  return {};
}

}  // namespace wisp::cli
