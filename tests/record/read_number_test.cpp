// How numbers are read where std::from_chars reads whole ones alone: held against std::from_chars, which is here.

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

#define WISP_READ_BY_STRTOD
#define wisp wisp_by_strtod
#include "record/number_text.cpp"  // NOLINT(bugprone-suspicious-include)
#undef wisp

namespace wisp::read_number_test {
namespace {

struct Read {
  std::ptrdiff_t length = 0;
  std::errc code = {};
  double value = -77;

  bool operator==(const Read& other) const {
    return length == other.length && code == other.code &&
           (value == other.value || (std::isnan(value) && std::isnan(other.value)));
  }
};

template <class Reader>
Read read(std::string_view text, Reader&& reader) {
  Read made;
  const auto [end, code] = reader(text.data(), text.data() + text.size(), made.value);
  made.length = end - text.data();
  made.code = code;
  return made;
}

void expect_as_from_chars(std::string_view text) {
  const auto expected = read(text, [](const char* a, const char* b, double& x) { return std::from_chars(a, b, x); });
  EXPECT_TRUE(read(text, wisp_by_strtod::read_number) == expected) << '"' << text << '"';
}

TEST(ReadNumber, WithoutTheLibraryIsWhatTheLibraryReads) {
  for (const char* text :
       {"0", "-0", "1.5", "-25e-3", ".5", "5.", "1e5", "1e+5", "0.1", "123456789012345678901234567890",
        "2.2250738585072011e-308", "1.7976931348623157e308", "4.9e-324", "0.30000000000000004"})
    expect_as_from_chars(text);
  for (const char* text : {"", "-", "+1", "-+1", " 1", "x", ".", "e5", "-x"}) expect_as_from_chars(text);
}

TEST(ReadNumber, EndsWhereTheLibraryEnds) {
  for (const char* text : {"1,2", "1 2", "0x10", "-0x1p3", "1.5.2", "1e", "1e+", "2-3", "3,5e1", "7d2", "12abc"})
    expect_as_from_chars(text);
}

TEST(ReadNumber, KnowsWhatIsNoNumberAndWhatNoDoubleHolds) {
  for (const char* text : {"nan", "inf", "-inf", "NaN 3", "infinity", "1e999", "-1e999", "1e-999"})
    expect_as_from_chars(text);
}

}  // namespace
}  // namespace wisp::read_number_test
