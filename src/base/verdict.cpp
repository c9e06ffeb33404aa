#include "base/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace wisp {
namespace {

std::string number_text(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  std::string out = text;
  // Some locales' decimal point is a comma.
  std::replace(out.begin(), out.end(), ',', '.');
  return out;
}

void fill(std::string& sentence, const std::string& name, const std::string& value) {
  for (auto at = sentence.find(name); at != std::string::npos; at = sentence.find(name, at + value.size())) {
    sentence.replace(at, name.size(), value);
  }
}

bool missed(const Criterion& criterion) {
  if (std::isnan(criterion.figure)) return false;
  return criterion.bound == Bound::kAtLeast ? criterion.figure < criterion.limit : criterion.figure > criterion.limit;
}

}  // namespace

std::optional<std::string> first_missed(std::span<const Criterion> criteria, std::string* code) {
  const auto found = std::find_if(criteria.begin(), criteria.end(), missed);
  if (found == criteria.end()) return {};
  if (code) *code = found->code;
  std::string sentence = found->sentence;
  fill(sentence, "{figure}", number_text(found->figure, found->digits));
  fill(sentence, "{limit}", number_text(found->limit, found->digits));
  return sentence;
}

}  // namespace wisp
