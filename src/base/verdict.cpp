#include "base/verdict.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace wisp {
namespace {

std::string number_text(double value, int digits) {
  char text[400];  // the largest double has 309 digits before the point
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits).ptr};
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
