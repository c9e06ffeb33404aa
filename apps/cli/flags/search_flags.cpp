#include "flags/search_flags.hpp"

#include <charconv>

#include "flags/recordings.hpp"

namespace wisp::cli {
namespace {

Error bad_grid(std::string_view text) {
  return {"--search: found \"" + std::string(text) + "\", expected such as na=1:10,nb=1:10,nk=0:3, up to 4096"};
}

// "1:10" or "3".
Result<OrderRange> parse_range(std::string_view text, std::string_view whole) {
  OrderRange range;
  const char* const end = text.data() + text.size();
  auto [next, code] = std::from_chars(text.data(), end, range.first);
  if (code != std::errc()) return bad_grid(whole);
  range.last = range.first;
  if (next != end) {
    if (*next != ':') return bad_grid(whole);
    const auto [last, last_code] = std::from_chars(next + 1, end, range.last);
    if (last_code != std::errc() || last != end) return bad_grid(whole);
  }
  if (range.first < 0 || range.last < range.first || range.last > 4096) return bad_grid(whole);
  return range;
}

Result<ArxSearch> parse_grid(const Arguments& arguments) {
  ArxSearch search;
  const std::string& whole = arguments.text("search");
  // What the grid leaves out has one value, that of the flag.
  for (const auto& [flag, range] : {std::pair{"na", &search.na}, {"nb", &search.nb}, {"nk", &search.nk}}) {
    const auto alone = parse_range(arguments.text(flag), whole);
    if (!alone && whole.find(std::string(flag) + "=") == std::string::npos) {
      return Error{"--search leaves " + std::string(flag) + " to --" + flag + ", which is \"" + arguments.text(flag) +
                   "\", expected a number; or give it a range in --search"};
    }
    if (alone) *range = *alone;
  }
  for (const std::string& part : arguments.names("search")) {
    const std::string_view text(part);
    const std::string_view name = text.substr(0, 3);
    if (name != "na=" && name != "nb=" && name != "nk=") return bad_grid(whole);
    const auto range = parse_range(text.substr(3), whole);
    if (!range) return range.error();
    (name == "na=" ? search.na : name == "nb=" ? search.nb : search.nk) = *range;
  }
  return search;
}

OrderCriterion criterion_of(const std::string& word) {
  if (word == "aic") return OrderCriterion::kAic;
  if (word == "aicc") return OrderCriterion::kAicc;
  if (word == "bic") return OrderCriterion::kBic;
  return word == "validation" ? OrderCriterion::kValidation : OrderCriterion::kFpe;
}

}  // namespace

std::vector<Flag> search_flags() {
  return {
      {"search", Kind::kNames, "GRID", "",
       "try a grid of orders and delays and keep the best, such as na=1:10,nb=1:10,nk=0:3; what it leaves out is that "
       "of "
       "--na, --nb, --nk"},
      {"by",
       Kind::kChoice,
       "C",
       "fpe",
       "what the best candidate is best at",
       {"fpe", "aic", "aicc", "bic", "validation"}},
      {"validate", Kind::kNames, "A:B|REC,…", "", "rows to validate on, 1-based and inclusive, or other recordings"},
      {"steps", Kind::kIntegerOrWord, "K", "1", "for validation: steps ahead, or inf for free simulation", {"inf"}},
  };
}

Result<ArxSearch> search_of(const std::vector<Recording>& whole, const Arguments& arguments) {
  auto search = parse_grid(arguments);
  if (!search) return search;
  search->by = criterion_of(arguments.text("by"));
  search->steps = arguments.text("steps") == "inf" ? kFreeRun : arguments.integer("steps");
  if (arguments.text("steps") == "0") return Error{"--steps: found \"0\", expected a number from 1, or inf"};
  if (search->by == OrderCriterion::kValidation && !arguments.has("validate")) {
    return Error{"--by validation needs --validate, the rows A:B or the recordings to judge on"};
  }
  const auto validation = arguments.names("validate");
  const bool rows = validation.size() == 1 && is_sample_range(validation.front());
  for (std::size_t k = 0; k < (rows ? whole.size() : validation.size()); ++k) {
    auto part = rows ? in_range(whole[k], arguments, "validate") : read_table(validation[k], arguments);
    if (!part) return rows ? part.error() : Error{part.error().message + " (--validate)"};
    search->validation.push_back(std::move(*part));
  }
  return search;
}

}  // namespace wisp::cli
