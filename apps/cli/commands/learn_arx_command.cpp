// `wisp learn arx`: learns an ARX model from any recording.

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "command.hpp"
#include "commands/commands.hpp"
#include "flags/arx_flags.hpp"
#include "flags/recipe_flags.hpp"
#include "flags/recordings.hpp"
#include "reports/arx_validation.hpp"
#include "reports/learned_model.hpp"
#include "terminal.hpp"
#include "wisp/base/file.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/learn/parts.hpp"

namespace wisp::cli {
namespace {

// Parses --part: "2/8" is the second of eight equal parts of the rows of --range.
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

// Returns whether learning from all named recordings at once would exceed --memory: each recording, its held-out part
// and buffers for reading take up to 46 bytes per sample (measured), besides the program's own memory.
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

// Accumulates the statistics of the named tables, of each the share of --part, in bounded memory. --range selects rows;
// MATLAB files are read whole. A bad table is an error, or is skipped with --skip-bad.
Result<ArxPart> part_of_tables(const ArxRecipe& recipe, const Arguments& arguments, Terminal& terminal) {
  const auto share = table_share(arguments);
  if (!share) return share.error();
  auto part = ArxPart::create(recipe);
  if (!part) return part;
  for (const std::string& path : arguments.positionals()) {
    const auto taken = take(path, *share, arguments, *part);
    if (!taken && !leave_out(path, taken.error(), arguments, terminal)) return taken.error();
  }
  if (part->sources().empty()) return Error{"none of the recordings can be used"};
  return part;
}

// Merges the named part files. Errors: a file that cannot be read, is no part, is damaged, or is of another model than
// the first (each names the file); a number of parts other than --expect; a flag that needs rows or contradicts them.
Result<ArxPart> merged_parts(const Arguments& arguments) {
  const auto settled =
      refuse(arguments, {"search", "range", "inputs", "outputs", "columns", "rate", "dt", "na", "nb", "nk", "coupling"},
             "does not go with --merge: parts hold no rows, but channels and orders");
  if (!settled) return settled.error();
  const auto& paths = arguments.positionals();
  auto whole = read_part(paths.front());
  if (!whole) return whole;
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
  return whole;
}

// Writes the statistics of the recordings (or, with --merge, of the parts) to the file of --partial, atomically.
// Errors: as part_of_tables and merged_parts, and where the file cannot be written.
Result<void> write_part(const ArxRecipe& recipe, const Arguments& arguments, Terminal& terminal) {
  auto no_model = refuse(arguments, {"output", "figures"}, "is of a model, and --partial writes a part instead");
  if (!no_model) return no_model;
  const auto part = arguments.on("merge") ? merged_parts(arguments) : part_of_tables(recipe, arguments, terminal);
  if (!part) return part.error();
  const std::string& path = arguments.text("partial");
  const auto bytes = part->bytes();
  if (auto ok = write_file(path, bytes); !ok) return ok;
  terminal.add("partial", path);
  terminal.add("rows", part->rows());
  terminal.add("bytes", bytes.size());
  terminal.add("parts", part->jobs());
  const auto sources = part->sources();
  terminal.add("sources", ReportList(sources.begin(), sources.end()));
  terminal.say("wrote " + path + ": " + std::to_string(part->rows()) + " rows in " + std::to_string(bytes.size()) +
               " bytes; wisp learn arx --merge makes a model of all parts");
  return {};
}

Error bad_grid(std::string_view text) {
  return {"--search: found \"" + std::string(text) + "\", expected such as na=1:10,nb=1:10,nk=0:3, up to 4096"};
}

// Parses a range of orders: "1:10" or "3".
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
  // Orders without a range in the grid have the single value of their flag.
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

std::vector<Flag> search_flags() {
  std::vector<Flag> flags{
      {"search", Kind::kNames, "GRID", "",
       "try a grid of orders and delays and keep the best, such as na=1:10,nb=1:10,nk=0:3; what it leaves out is "
       "that of --na, --nb, --nk"},
      {"by",
       Kind::kChoice,
       "C",
       "fpe",
       "what the best candidate is best at",
       {"fpe", "aic", "aicc", "bic", "validation"}},
      {"validate", Kind::kNames, "A:B|REC,…", "", "rows to validate on, 1-based and inclusive, or other recordings"},
      {"steps", Kind::kIntegerOrWord, "K", "1", "for validation: steps ahead, or inf for free simulation", {"inf"}},
  };
  for (std::size_t k = 1; k < flags.size(); ++k) flags[k].with = "search";
  return flags;
}

// Reads the options of the search from the flags. `whole`: all rows of the recordings, before --range is applied; the
// rows of --validate are counted in them.
Result<ArxSearch> search_of(const std::vector<Recording>& whole, const Arguments& arguments) {
  auto search = parse_grid(arguments);
  if (!search) return search;
  search->by = *value_of<OrderCriterion>(arguments.text("by"));
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

Result<void> take_orders(const Arguments& arguments, ArxRecipe& recipe) {
  auto na = order_choice(arguments, "na"), nb = order_choice(arguments, "nb");
  if (!na) return na.error();
  if (!nb) return nb.error();
  const auto none = [](const OrderChoice& order) {
    return std::holds_alternative<int>(order) && std::get<int>(order) == 0;
  };
  if (none(*na) && none(*nb)) return Error{"--na 0 --nb 0 leaves a model without a term; give one of them at least 1"};
  recipe.na = std::move(*na);
  recipe.nb = std::move(*nb);
  recipe.nk.reset();
  const std::string& text = arguments.text("nk");
  if (text == "auto") return {};
  if (text.starts_with("auto")) {
    int delay = -1;
    char rest = 0;
    if (std::sscanf(text.c_str(), "auto:%d%c", &delay, &rest) != 1 || delay < 0 || delay > 4096) {
      return Error{"--nk: found \"" + text + "\", expected auto, or auto:N with N from 0 to 4096"};
    }
    recipe.max_delay = delay;
    return {};
  }
  auto nk = order_choice(arguments, "nk");
  if (!nk) return nk.error();
  recipe.nk = std::move(*nk);
  return {};
}

// Reads the recipe from the flags, without the search, which needs the recordings.
Result<ArxRecipe> recipe_of(const Arguments& arguments) {
  ArxRecipe recipe;
  if (auto ok = read_recipe(arguments, recipe); !ok) return ok.error();
  recipe.name = model_name(arguments);
  recipe.responses = arguments.has("figures");
  const auto preparation = preparation_of(arguments);
  if (!preparation) return preparation.error();
  recipe.preparation = *preparation;
  const bool focused = recipe.focus != ArxFocus::kPrediction;
  if ((arguments.has("partial") || arguments.on("merge")) && (arguments.has("prepare") || focused)) {
    return Error{(focused ? "--focus " + arguments.text("focus") : "--prepare") +
                 " needs the recordings in one place: learn without --partial and --merge"};
  }
  if (recipe.kernel != ArxKernel::kNone && recipe.focus != ArxFocus::kPrediction) {
    return Error{"--kernel chooses the coefficients itself: leave --focus " + arguments.text("focus") + " out"};
  }
  for (const auto& [flag, names] : {std::pair{"--inputs", &recipe.inputs}, {"--outputs", &recipe.outputs}}) {
    for (const std::string& name : *names) {
      if (std::ranges::count(*names, name) > 1) return Error{std::string(flag) + " names '" + name + "' twice"};
      if (names == &recipe.outputs || std::ranges::count(recipe.outputs, name) == 0) continue;
      return Error{"'" + name + "' is named in --inputs and in --outputs; it is one of them"};
    }
  }
  if (arguments.has("partial") && arguments.has("search")) {
    return Error{"--partial is of one model; --search tries many: search first, then fit the best orders in parts"};
  }
  if (arguments.on("merge") || arguments.has("search")) return recipe;
  if (auto ok = take_orders(arguments, recipe); !ok) return ok.error();
  if (!recipe.nk && arguments.has("partial")) {
    return Error{
        "--nk auto needs the recordings in memory: find the delays in a part of them with --range, then give "
        "them as numbers"};
  }
  return recipe;
}

Result<Fit> learned_from_memory(ArxRecipe recipe, const Arguments& arguments, Terminal& terminal) {
  auto whole = read_tables(arguments.positionals(), arguments, terminal);
  if (!whole) return whole.error();
  if (arguments.has("search")) {
    auto search = search_of(*whole, arguments);
    if (!search) return search.error();
    recipe.search = std::move(*search);
  }
  const auto recordings = in_range(std::move(*whole), arguments, terminal);
  if (!recordings) return recordings.error();
  return learn(*recordings, recipe, terminal.progress());
}

Result<Fit> learned(const ArxRecipe& recipe, const Arguments& arguments, Terminal& terminal) {
  if (arguments.on("merge")) {
    const auto merged = merged_parts(arguments);
    if (!merged) return merged.error();
    return merged->finish(recipe, terminal.progress());
  }
  // A search, a preparation, --nk auto and a focus other than prediction need all recordings in memory.
  const bool whole = arguments.has("search") || arguments.has("prepare") || !recipe.nk;
  if (whole || recipe.focus != ArxFocus::kPrediction || !too_large(arguments)) {
    return learned_from_memory(recipe, arguments, terminal);
  }
  const auto all = part_of_tables(recipe, arguments, terminal);
  if (!all) return all.error();
  return all->finish(recipe, terminal.progress());
}

Result<void> run_learn_arx(const Arguments& arguments, Terminal& terminal) {
  const auto recipe = recipe_of(arguments);
  if (!recipe) return recipe.error();
  if (arguments.has("partial")) return write_part(*recipe, arguments, terminal);
  auto fit = learned(*recipe, arguments, terminal);
  if (!fit) return fit.error();
  if (arguments.has("range")) fit->model.training.recipe.push_back({"range", arguments.text("range")});
  const std::string output = model_path(arguments);
  if (spectral_radius(std::get<ArxModel>(fit->model.dynamics)) < 1) {
    if (auto ok = hand_over(fit, arguments, terminal); !ok) return ok;
  } else {
    // Reached with --keep-unstable only: the report is complete, so the exit status is 0 although no model is written.
    terminal.show(fit->report);
    terminal.add("output", {});
    if (!output.empty()) {
      terminal.add("not_written", output);
      terminal.warn(output + " was not written: an unstable model cannot be played" +
                    (std::filesystem::exists(output) ? "; the file of that name is an older one" : ""));
    }
  }
  if (!arguments.has("figures")) return {};
  return write_arx_figures(arguments.text("figures"), fit->model, fit->report, terminal);
}

std::vector<Flag> arx_flags() {
  auto of_recipe = recipe_flags(ArxRecipe{});
  flag_named(of_recipe, "outputs").required = true;
  flag_named(of_recipe, "outputs").unless = {"merge"};
  const std::vector<Flag> of_rows = {
      {"range", Kind::kSamples, "A:B", "", "rows to learn from, 1-based and inclusive"},
      prepare_flag(),
      {"figures", Kind::kOutput, "DIR", "",
       "draw poles and zeros, step and frequency responses with their 95 % bands, and residual tests there; --json "
       "has their numbers as responses"},
      {"memory", Kind::kInteger, "MIB", "1024",
       "where learning would take more than this, recordings are read a stretch at a time, which takes 40 (not "
       "with --search, --prepare, --nk auto, --focus simulation or auto); held-out rows and residuals are not judged "
       "then"},
  };
  const auto of_orders =
      order_flags({"4", "", "; auto finds every input's delay to every output, auto:N those up to N samples"});
  return flags_of(
      {{output_flag({"partial"})}, of_recipe, of_orders, of_rows, search_flags(), arx_part_flags(), recording_flags()});
}

}  // namespace

Command learn_arx_command() {
  return {
      "learn arx",
      "Estimates an ARX model by least squares: y(t) + A1 y(t-1) + … = B1 u(t-nk) + … + e(t).",
      {{"REC",
        "recordings: CSV files, or MATLAB files whose variables --inputs and --outputs name; with --merge, parts",
        true}},
      arx_flags(),
      {
          {"wisp learn arx hairdryer.csv -o dryer.wisp --inputs u1 --outputs y1 --dt 0.08 --na 2 --nb 2 --nk 3 --range "
           "1:300",
           "A classic: a hair dryer's air temperature from its heating power"},
          {"wisp learn arx hairdryer.csv -o dryer.wisp --inputs u1 --outputs y1 --dt 0.08 --range 1:500 "
           "--search na=1:10,nb=1:10,nk=0:3 --by validation --validate 501:1000",
           "The orders that predict unseen rows best"},
          {"wisp learn arx long.csv --partial 2.part --part 2/8 --inputs u --outputs y && wisp learn arx --merge "
           "*.part -o long.wisp",
           "One of eight jobs, each with its share of the rows, and what makes one model of all of them"},
      },
      run_learn_arx,
  };
}

}  // namespace wisp::cli
