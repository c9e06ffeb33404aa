#include "record/csv_cells.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "record/number_text.hpp"

namespace wisp::csv {
namespace {

// Like std::from_chars, but accepts a leading plus and numbers outside a double's range.
std::optional<double> parsed(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, code] = read_number(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if (code == std::errc::result_out_of_range)
    return text.find("e-") != text.npos || text.find("E-") != text.npos ? 0.0 : HUGE_VAL;
  return code == std::errc() ? std::optional(value) : std::nullopt;
}

bool same_word(std::string_view text, std::string_view lower) {
  return text.size() == lower.size() && std::equal(text.begin(), text.end(), lower.begin(), [](char a, char b) {
           return a == b || (a >= 'A' && a <= 'Z' && a + ('a' - 'A') == b);
         });
}

}  // namespace

std::size_t quoted_length(std::string_view line, char separator) {
  std::size_t at = 1;
  for (;; at += 2) {
    at = line.find('"', at);
    if (at == std::string_view::npos) return 0;
    if (at + 1 == line.size() || line[at + 1] != '"') break;
  }
  ++at;
  const auto ends = [&](char c) { return c == separator || (separator == kBlanks && c == '\t'); };
  while (at < line.size() && !ends(line[at]) && (line[at] == ' ' || line[at] == '\t' || line[at] == '\r')) ++at;
  return at == line.size() || ends(line[at]) ? at : 0;
}

Cell cell_of(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    return {trimmed(text.substr(1, text.size() - 2)), true};
  }
  return {text, false};
}

std::string text_of(const Cell& cell) {
  std::string text(cell.text);
  for (std::size_t at = text.find("\"\""); cell.quoted && at != text.npos; at = text.find("\"\"", at + 1)) {
    text.erase(at, 1);
  }
  return text;
}

bool is_missing(const Cell& cell) {
  static constexpr std::array<std::string_view, 8> kWords = {"nan",  "na",   "n/a",  "n.a.",
                                                             "#n/a", "null", "none", "-nan"};
  if (cell.text.empty()) return true;
  // Most cells are numbers, and no number begins with these characters.
  const char first = cell.text.front();
  if (first != 'n' && first != 'N' && first != '#' && first != '-') return false;
  return std::any_of(kWords.begin(), kWords.end(), [&](auto word) { return same_word(cell.text, word); });
}

std::optional<double> number_of(const Cell& cell, char separator) {
  if (const auto value = parsed(cell.text)) return value;
  constexpr std::size_t kLongest = 64;
  if (cell.text.size() > kLongest) return std::nullopt;
  std::string text(cell.text);
  const bool comma = separator != ',' || cell.quoted;
  const std::size_t at = text.find(',');
  if (at != text.npos && comma && text.find('.') == text.npos) text[at] = '.';
  // Fortran's double precision exponent.
  const std::size_t exponent = text.find_first_of("dD");
  if (exponent != text.npos && exponent > 0) text[exponent] = 'e';
  return text == cell.text ? std::nullopt : parsed(text);
}

PlainNumber plain_number(std::string_view text) {
  // A double holds these powers of ten exactly, and integers up to 2^53.
  static constexpr double kTens[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                     1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  constexpr std::uint64_t kMaxExact = std::uint64_t{1} << 53;
  const char *at = text.data(), *const end = at + text.size();
  const bool minus = at != end && *at == '-';
  at += minus;
  std::uint64_t whole = 0;
  std::ptrdiff_t digits = 0;
  const char* point = nullptr;
  for (; at != end; ++at) {
    const auto digit = static_cast<unsigned>(*at - '0');
    if (digit <= 9) {
      whole = 10 * whole + digit, ++digits;
    } else if (*at == '.' && !point) {
      point = at + 1;
    } else {
      break;
    }
  }
  std::ptrdiff_t power = point ? point - at : 0;
  if (digits == 0 || digits > 18 || whole > kMaxExact) return {};
  if (at != end && (*at == 'e' || *at == 'E')) {
    int exponent = 0;
    const char* const first = at + 1 + (at + 1 != end && at[1] == '+' ? 1 : 0);
    const auto [last, code] = std::from_chars(first, end, exponent);
    if (code != std::errc() || (first == at + 2 && first != end && *first == '-')) return {};
    power += exponent, at = last;
  }
  if (power < -22 || power > 22) return {};
  const double size = static_cast<double>(whole);
  const double value = power < 0 ? size / kTens[-power] : size * kTens[power];
  return {minus ? -value : value, static_cast<std::size_t>(at - text.data()), point != nullptr};
}

}  // namespace wisp::csv
