#include "record/number_text.hpp"

#include <algorithm>
#include <cerrno>
#include <clocale>
#include <cstdlib>
#include <string>
#include <string_view>
#include <version>

namespace wisp {

std::string number_text(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string number_text(double value, int digits) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr};
}

#if defined(__cpp_lib_to_chars) && !defined(WISP_READ_BY_STRTOD)

std::from_chars_result read_number(const char* first, const char* last, double& value) {
  return std::from_chars(first, last, value);
}

#else
namespace {

// Returns how many characters to give strtod, which would also accept leading blanks, a plus and hexadecimals.
std::size_t plain_length(std::string_view text) {
  const std::size_t sign = text.starts_with('-') ? 1 : 0;
  const char lead = sign < text.size() ? text[sign] : 0;
  if (lead == 'i' || lead == 'I' || lead == 'n' || lead == 'N') return std::min(text.size(), text.find(' '));
  const std::size_t length = std::min(text.size(), text.find_first_not_of("0123456789.eE+-", sign));
  return lead == '+' || lead == '-' ? 0 : length;
}

}  // namespace

std::from_chars_result read_number(const char* first, const char* last, double& value) {
  std::string text(first, plain_length({first, static_cast<std::size_t>(last - first)}));
  const std::size_t point = text.find('.');
  if (point != text.npos) text[point] = *std::localeconv()->decimal_point;
  char* end = text.data();
  const int before = errno;
  errno = 0;
  const double read = std::strtod(text.c_str(), &end);
  const bool out_of_range = errno == ERANGE && (read == 0 || read > 1 || read < -1);
  errno = before;
  const char* stop = first + (end - text.data());
  if (stop == first) return {first, std::errc::invalid_argument};
  if (out_of_range) return {stop, std::errc::result_out_of_range};
  value = read;
  return {stop, {}};
}

#endif

}  // namespace wisp
