#include "record/number_text.hpp"

#include <charconv>

namespace wisp {

std::string number_text(double value) {
  char text[32];
  const auto [end, code] = std::to_chars(text, text + sizeof text, value);
  return {text, end};
}

std::string number_text(double value, int digits) {
  char text[32];
  const auto [end, code] = std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits);
  return {text, end};
}

}  // namespace wisp
