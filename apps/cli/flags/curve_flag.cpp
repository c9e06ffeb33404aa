#include "flags/curve_flag.hpp"

namespace wisp::cli {

Flag curve_flag(const std::string& unless_said, const std::string& help) {
  return {
      "input-curve",
      Kind::kIntegerOrWord,
      "N|auto",
      unless_said,
      "a monotone curve of N knots, 3 to 16, that bends every input before the linear model sees it; 0: none; auto: "
      "3 to 6 knots or none, as held-out rows say" +
          help,
      {"auto"}};
}

std::optional<int> curve_knots_of(const Arguments& arguments) {
  if (arguments.text("input-curve") == "auto") return std::nullopt;
  return arguments.integer("input-curve");
}

}  // namespace wisp::cli
