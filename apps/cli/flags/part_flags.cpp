#include "flags/part_flags.hpp"

#include <charconv>

namespace wisp::cli {

std::vector<Flag> part_flags(std::string partial, std::string part, std::string merge) {
  return {
      {"partial", Kind::kOutput, "P", "", std::move(partial)},
      {"part", Kind::kText, "K/N", "1/1", std::move(part)},
      {"merge", Kind::kSwitch, "", "", std::move(merge)},
      {"expect", Kind::kInteger, "N", "", "with --merge: how many parts there must be, so that none is forgotten"},
  };
}

Result<PartShare> share_of(const Arguments& arguments) {
  const std::string& text = arguments.text("part");
  const Error bad{"--part: found \"" + text + "\", expected K/N with 1 <= K <= N, such as 2/8"};
  PartShare share;
  const char* const end = text.data() + text.size();
  const auto [slash, code] = std::from_chars(text.data(), end, share.index);
  if (code != std::errc() || slash == end || *slash != '/') return bad;
  const auto [rest, count_code] = std::from_chars(slash + 1, end, share.count);
  if (count_code != std::errc() || rest != end || share.index < 1 || share.index > share.count) return bad;
  --share.index;
  return share;
}

Result<void> check_expected(std::size_t jobs, const Arguments& arguments) {
  if (!arguments.has("expect") || static_cast<std::size_t>(arguments.integer("expect")) == jobs) return {};
  return Error{"found " + std::to_string(jobs) + " parts, expected " + arguments.text("expect") +
               ": did every job end well, and are all parts named?"};
}

}  // namespace wisp::cli
