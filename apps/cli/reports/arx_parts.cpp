#include "reports/arx_parts.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>

#include "flags/recordings.hpp"
#include "wisp/base/file.hpp"

namespace wisp::cli {
namespace {

// --part "2/8", the second of eight, of the rows of --range.
Result<TableShare> table_share(const Arguments& arguments) {
  const std::string& text = arguments.text("part");
  const Error bad{"--part: found \"" + text + "\", expected K/N with 1 <= K <= N, such as 2/8"};
  TableShare share;
  const char* const end = text.data() + text.size();
  const auto [slash, code] = std::from_chars(text.data(), end, share.index);
  if (code != std::errc() || slash == end || *slash != '/') return bad;
  const auto [rest, count_code] = std::from_chars(slash + 1, end, share.count);
  if (count_code != std::errc() || rest != end || share.index < 1 || share.index > share.count) return bad;
  --share.index;
  if (!arguments.has("range")) return share;
  const SampleRange range = arguments.samples("range");
  share.first = range.first - 1;
  share.rows = range.last - range.first + 1;
  return share;
}

Result<ArxPart> read_part(const std::string& path) {
  const auto bytes = read_file(path);
  if (!bytes) return bytes.error();
  auto part = ArxPart::from_bytes(*bytes);
  if (!part) return Error{path + ": " + part.error().message};
  return part;
}

Result<void> take(const std::string& path, const TableShare& share, const Arguments& arguments, ArxPart& part) {
  if (is_matlab(path)) {
    const auto whole = read_table(path, arguments);
    if (!whole) return whole.error();
    return part.add(*whole, share);
  }
  const auto options = csv_options(arguments);
  if (!options) return options.error();
  return part.add(std::filesystem::path(path), *options, share);
}

ReportList list_of(const OrderMatrix& orders) {
  ReportList rows;
  for (int i = 0; i < orders.rows(); ++i) {
    const auto row = orders.values().subspan(static_cast<std::size_t>(i * orders.columns()),
                                             static_cast<std::size_t>(orders.columns()));
    rows.push_back(ReportList(row.begin(), row.end()));
  }
  return rows;
}

}  // namespace

std::vector<Flag> arx_part_flags() {
  std::vector<Flag> flags{
      {"partial", Kind::kOutput, "P", "",
       "write a part of a fit instead of a model: the products of these rows, a small file however many they are"},
      {"part", Kind::kText, "K/N", "1/1", "with --partial: take the K-th of N equal shares of every recording's rows"},
      {"merge", Kind::kSwitch, "", "",
       "what is named are parts written with --partial, in any order; they say what the channels and orders are"},
      {"expect", Kind::kInteger, "N", "", "with --merge: how many parts there must be, so that none is forgotten"},
  };
  flags[1].with = "partial";
  flags[3].with = "merge";
  return flags;
}

// A recording, what is held out of it, and the room that reading keeps: up to 46 bytes a sample (measured), beside
// what the program has anyway.
bool too_large(const Arguments& arguments) {
  constexpr double kMebibyte = 1 << 20, kProgram = 24, kBytesASample = 46;
  const auto channels = static_cast<double>(arguments.names("inputs").size() + arguments.names("outputs").size());
  double rows = 0;
  for (const std::string& path : arguments.positionals()) {
    std::error_code code;
    const auto size = std::filesystem::file_size(path, code);
    if (code) continue;
    std::string first(std::size_t{1} << 16, '\0');
    std::ifstream stream(path, std::ios::binary);
    stream.read(first.data(), std::ssize(first));
    const auto read = static_cast<double>(stream.gcount());
    const auto lines = static_cast<double>(std::count(first.begin(), first.end(), '\n'));
    rows += static_cast<double>(size) / (is_matlab(path) || lines < 2 ? 8 * channels : read / lines);
  }
  return kProgram + kBytesASample * channels * rows / kMebibyte > arguments.integer("memory");
}

Result<NamedPart> part_of_tables(const ArxRecipe& recipe, const Arguments& arguments, Terminal& terminal) {
  const auto share = table_share(arguments);
  if (!share) return share.error();
  auto part = ArxPart::create(recipe);
  if (!part) return part.error();
  NamedPart named{std::move(*part), {}};
  for (const std::string& path : arguments.positionals()) {
    if (const auto taken = take(path, *share, arguments, named.part); taken) {
      named.sources.push_back(path);
    } else if (!leave_out(path, taken.error(), arguments, terminal)) {
      return taken.error();
    }
  }
  if (named.sources.empty()) return Error{"none of the recordings can be used"};
  return named;
}

Result<NamedPart> merged_parts(const Arguments& arguments) {
  const auto& paths = arguments.positionals();
  auto whole = read_part(paths.front());
  if (!whole) return whole.error();
  for (std::size_t k = 1; k < paths.size(); ++k) {
    const auto part = read_part(paths[k]);
    if (!part) return part.error();
    if (auto ok = whole->merge(*part); !ok) {
      return Error{paths[k] + ": cannot be merged with " + paths.front() + ": " + ok.error().message};
    }
  }
  if (arguments.has("expect") && static_cast<std::size_t>(arguments.integer("expect")) != whole->jobs()) {
    return Error{"found " + std::to_string(whole->jobs()) + " parts, expected " + arguments.text("expect") +
                 ": did every job end well, and are all parts named?"};
  }
  auto sources = whole->sources();
  return NamedPart{std::move(*whole), std::move(sources)};
}

Result<void> write_part(const ArxRecipe& recipe, const Arguments& arguments, Terminal& terminal) {
  const auto named = arguments.on("merge") ? merged_parts(arguments) : part_of_tables(recipe, arguments, terminal);
  if (!named) return named.error();
  const ArxPart& part = named->part;
  const std::string& path = arguments.text("partial");
  const auto bytes = part.bytes();
  if (auto ok = write_file(path, bytes); !ok) return ok;
  terminal.add("partial", path);
  terminal.add("rows", part.rows());
  terminal.add("bytes", bytes.size());
  terminal.add("parts", part.jobs());
  const auto sources = part.sources();
  terminal.add("sources", ReportList(sources.begin(), sources.end()));
  terminal.add("na", list_of(part.orders().na));
  terminal.add("nb", list_of(part.orders().nb));
  terminal.add("nk", list_of(part.orders().nk));
  terminal.say("wrote " + path + ": " + std::to_string(part.rows()) + " rows in " + std::to_string(bytes.size()) +
               " bytes; wisp learn arx --merge makes a model of all parts");
  return {};
}

}  // namespace wisp::cli
