#include "command.hpp"

#include <cstdio>
#include <cstdlib>

#include "wisp/learn/recipe_fields.hpp"

namespace wisp::cli {

int Arguments::integer(std::string_view flag) const { return std::atoi(text(flag).c_str()); }

double Arguments::number(std::string_view flag) const { return std::strtod(text(flag).c_str(), nullptr); }

namespace {

// Whether quotes and brackets are balanced; a comma within them is part of a name.
bool is_balanced(std::string_view text) {
  int depth = 0;
  for (char c : text) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (depth < 0) return false;
  }
  return depth == 0;
}

}  // namespace

std::vector<std::string> Arguments::names(std::string_view flag) const {
  std::vector<std::string> names;
  if (!has(flag)) return names;
  const std::string& all = text(flag);
  const bool brackets = is_balanced(all);
  int depth = 0;
  bool quoted = false;
  std::string name;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const char c = all[k];
    const bool doubled = quoted && c == '"' && k + 1 < all.size() && all[k + 1] == '"';
    if (c == '"' && !doubled && (quoted || name.empty())) {
      quoted = !quoted;
    } else if (doubled) {
      name += all[++k];
    } else if (c == ',' && !quoted && depth == 0) {
      if (!name.empty()) names.push_back(std::move(name));
      name.clear();
    } else {
      if (brackets) depth += c == '(' ? 1 : c == ')' ? -1 : 0;
      name += c;
    }
  }
  if (!name.empty()) names.push_back(std::move(name));
  return names;
}

bool is_sample_range(const std::string& text) {
  SampleRange range{0, 0};
  int end = -1;
  const bool read = std::sscanf(text.c_str(), "%zu:%zu%n", &range.first, &range.last, &end) == 2;
  return read && text.find_first_not_of("0123456789:") == std::string::npos && end == std::ssize(text) &&
         range.first >= 1 && range.first <= range.last;
}

SampleRange Arguments::samples(std::string_view flag) const {
  const std::string& range = text(flag);
  const std::size_t colon = range.find(':');
  return {std::strtoull(range.c_str(), nullptr, 10), std::strtoull(range.c_str() + colon + 1, nullptr, 10)};
}

std::string help_of(const Flag& flag) {
  std::string words, signs;
  for (const std::string& word : flag.words) {
    words += (words.empty() ? "" : ", ") + word;
    signs += (signs.empty() ? "" : "|") + word;
  }
  // Some flags list their words in `value`.
  if (words.empty() || flag.value == signs || flag.kind != Kind::kChoice) return flag.help;
  return flag.help + " (one of " + words + ")";
}

Flag ranged(Flag flag, double lowest, double highest) {
  flag.lowest = lowest;
  flag.highest = highest;
  flag.help += "; " + range_text(lowest, highest);
  return flag;
}

const std::vector<Flag>& common_flags() {
  static const std::vector<Flag> flags = {
      {"json", Kind::kSwitch, "", "", "print one JSON document on standard output, and nothing else there"},
      {"quiet", Kind::kSwitch, "", "", "no progress bars"},
      {"unpacked", Kind::kNumber, "GB", "",
       "of numbers that a packed MATLAB file may hold; 64 times the file and at most 1 otherwise"},
  };
  return flags;
}

}  // namespace wisp::cli
