#include "reports/arx_parts.hpp"

#include <charconv>

#include "reports/arx_tables.hpp"
#include "reports/figures_json.hpp"
#include "wisp/base/file.hpp"

namespace wisp::cli {
namespace {

// "2/8": the second of eight.
Result<TableShare> parse_share(const std::string& text) {
  const Error bad{"--part: found \"" + text + "\", expected K/N with 1 <= K <= N, such as 2/8"};
  TableShare share;
  const char* const end = text.data() + text.size();
  const auto [slash, code] = std::from_chars(text.data(), end, share.index);
  if (code != std::errc() || slash == end || *slash != '/') return bad;
  const auto [rest, count_code] = std::from_chars(slash + 1, end, share.count);
  if (count_code != std::errc() || rest != end || share.index < 1 || share.index > share.count) return bad;
  --share.index;
  return share;
}

Result<TriangularFactor> read_part(const std::string& path) {
  const auto bytes = read_file(path);
  if (!bytes) return bytes.error();
  auto part = TriangularFactor::from_bytes(*bytes);
  if (!part) return Error{path + ": " + part.error().message};
  return part;
}

Result<TriangularFactor> learned_part(const Arguments& arguments, Terminal& terminal) {
  if (arguments.on("merge")) return merged_parts(arguments);
  const auto share = parse_share(arguments.text("part"));
  if (!share) return share.error();
  return factor_of_tables(arguments, *share, terminal);
}

}  // namespace

std::vector<Flag> part_flags() {
  return {
      {"partial", Kind::kPath, "P", "",
       "write a part of a fit instead of a model: what these rows have to say, a small file however many they are"},
      {"part", Kind::kText, "K/N", "1/1", "with --partial: take the K-th of N equal shares of every recording's rows"},
      {"merge", Kind::kSwitch, "", "",
       "what is named are parts written with --partial, in any order; they say what the channels and orders are"},
  };
}

Result<TriangularFactor> merged_parts(const Arguments& arguments) {
  const auto& paths = arguments.positionals();
  auto whole = read_part(paths.front());
  if (!whole) return whole;
  for (std::size_t k = 1; k < paths.size(); ++k) {
    const auto part = read_part(paths[k]);
    if (!part) return part;
    if (auto ok = whole->merge(*part); !ok) {
      return Error{paths[k] + ": cannot be merged with " + paths.front() + ": " + ok.error().message};
    }
  }
  return whole;
}

Result<void> write_part(const Arguments& arguments, Terminal& terminal) {
  if (arguments.has("search")) {
    return Error{"--partial is of one model; --search tries many: search first, then fit the best orders in parts"};
  }
  const auto part = learned_part(arguments, terminal);
  if (!part) return part.error();
  const std::string& path = arguments.text("partial");
  const auto bytes = part->bytes();
  if (auto ok = write_file(path, bytes); !ok) return ok;
  Json& result = terminal.result();
  result["partial"] = path;
  result["rows"] = part->rows();
  result["bytes"] = bytes.size();
  result["na"] = json_of(part->options().orders.na);
  result["nb"] = json_of(part->options().orders.nb);
  result["nk"] = json_of(part->options().orders.nk);
  terminal.say("wrote " + path + ": " + std::to_string(part->rows()) + " rows in " + std::to_string(bytes.size()) +
               " bytes; wisp learn arx --merge makes a model of all parts");
  return {};
}

}  // namespace wisp::cli
