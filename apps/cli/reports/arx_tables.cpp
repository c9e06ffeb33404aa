#include "reports/arx_tables.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <memory>

#include "flags/order_flags.hpp"
#include "flags/recordings.hpp"
#include "wisp/learn/free_run_judge.hpp"

namespace wisp::cli {
namespace {

constexpr std::size_t kAllRows = std::numeric_limits<std::size_t>::max();

// A CSV file being read, standing at the first row of --range.
struct OpenTable {
  std::unique_ptr<std::ifstream> stream;  // on the heap, where the reader's view of it survives moves
  std::unique_ptr<CsvReader> reader;
  std::size_t rows = kAllRows;  // of the range, or all there are
};

Result<OpenTable> open_table(const std::string& path, const Arguments& arguments) {
  const auto options = csv_options(arguments);
  if (!options) return options.error();
  OpenTable table{std::make_unique<std::ifstream>(path, std::ios::binary), nullptr};
  if (!*table.stream || std::filesystem::is_directory(path)) {
    return Error{path + ": cannot be opened as a table; is the name right?"};
  }
  auto reader = CsvReader::open(*table.stream, path, *options);
  if (!reader) return reader.error();
  table.reader = std::make_unique<CsvReader>(std::move(*reader));
  if (!arguments.has("range")) return table;
  const SampleRange range = arguments.samples("range");
  if (const auto skipped = table.reader->skip(range.first - 1); !skipped) return skipped.error();
  table.rows = range.last - range.first + 1;
  return table;
}

// How many rows the table has, or its --range. A reading of its own, which looks for ends of lines only.
Result<std::size_t> count_rows(const std::string& path, const Arguments& arguments) {
  auto table = open_table(path, arguments);
  if (!table) return table.error();
  const auto rows = table->reader->skip(table->rows);
  if (!rows) return rows.error();
  if (table->rows != kAllRows && *rows < table->rows) {
    return Error{path + ": --range " + arguments.text("range") + " reaches beyond its rows"};
  }
  if (*rows == 0) return Error{path + ": has a header but no rows"};
  return *rows;
}

Result<TriangularFactor> factor_of_csv(const std::string& path, const Arguments& arguments, const TableShare& share,
                                       TriangularFactor factor) {
  PartRows part;
  if (share.count > 1 || arguments.has("range")) {
    const auto rows = count_rows(path, arguments);
    if (!rows) return rows.error();
    part = part_rows(*rows, share.index, share.count);
  }
  auto table = open_table(path, arguments);
  if (!table) return table.error();
  const bool last = share.index + 1 == share.count;
  const auto added = factor.add(*table->reader, part, last ? std::min(part.end, table->rows) : kAllRows);
  if (!added) return added.error();
  return factor;
}

Result<TriangularFactor> factor_of_table(const std::string& path, const Arguments& arguments, const TableShare& share,
                                         const TriangularFactor& empty) {
  if (std::filesystem::path(path).extension() != ".mat") return factor_of_csv(path, arguments, share, empty);
  auto whole = read_table(path, arguments);
  if (!whole) return whole.error();
  const auto recording = in_range(std::move(*whole), arguments, "range");
  if (!recording) return recording.error();
  TriangularFactor factor = empty;
  if (auto ok = factor.add(*recording, part_rows(recording->rows(), share.index, share.count)); !ok) return ok.error();
  return factor;
}

// The factor, and which tables are in it.
struct Taken {
  TriangularFactor factor;
  std::vector<std::string> paths;
};

Result<Taken> take_tables(const Arguments& arguments, const TableShare& share, Terminal& terminal) {
  if (arguments.text("nk") == "auto") {
    return Error{
        "--nk auto needs the recordings in memory: find the delays in a part of them with --range, then give "
        "them as numbers"};
  }
  FactorOptions options;
  options.channels = {arguments.names("inputs"), arguments.names("outputs")};
  auto orders = orders_from(arguments, static_cast<int>(options.channels.outputs.size()),
                            static_cast<int>(options.channels.inputs.size()));
  if (!orders) return orders.error();
  options.orders = std::move(*orders);
  auto empty = TriangularFactor::create(options);
  if (!empty) return empty.error();
  Taken taken{*empty, {}};
  for (const std::string& path : arguments.positionals()) {
    const auto factor = factor_of_table(path, arguments, share, *empty);
    if (!factor) {
      if (!leave_out(path, factor.error(), arguments, terminal)) return factor.error();
      continue;
    }
    if (auto ok = taken.factor.merge(*factor); !ok) return Error{path + ": " + ok.error().message};
    taken.paths.push_back(path);
  }
  if (taken.paths.empty()) return Error{"none of the recordings can be used"};
  return taken;
}

Result<void> judge_free_run(const Taken& taken, const Arguments& arguments, ArxFit& fit) {
  const auto nb = fit.model.orders.nb.values();
  if (std::none_of(nb.begin(), nb.end(), [](int order) { return order > 0; })) return {};
  const ChannelChoice& channels = taken.factor.options().channels;
  FreeRunJudge judge(fit.model, channels);
  for (const std::string& path : taken.paths) {
    auto table = open_table(path, arguments);
    if (!table) return table.error();
    if (auto ok = judge.add(*table->reader, table->rows); !ok) return ok;
  }
  const auto figures = judge.figures();
  if (figures) add_free_run(*figures, channels, fit.summary);
  return {};
}

bool holds_mat(const std::vector<std::string>& paths) {
  return std::any_of(paths.begin(), paths.end(),
                     [](const std::string& path) { return std::filesystem::path(path).extension() == ".mat"; });
}

}  // namespace

std::uintmax_t bytes_on_disk(const std::vector<std::string>& paths) {
  std::uintmax_t bytes = 0;
  for (const std::string& path : paths) {
    std::error_code code;
    const auto size = std::filesystem::file_size(path, code);
    if (!code) bytes += size;
  }
  return bytes;
}

Result<TriangularFactor> factor_of_tables(const Arguments& arguments, const TableShare& share, Terminal& terminal) {
  auto taken = take_tables(arguments, share, terminal);
  if (!taken) return taken.error();
  return std::move(taken->factor);
}

Result<StreamedFit> fit_of_tables(const Arguments& arguments, const ArxOptions& options, Terminal& terminal) {
  auto taken = take_tables(arguments, {}, terminal);
  if (!taken) return taken.error();
  auto fit = taken->factor.finish(options);
  if (!fit) return fit.error();
  if (!holds_mat(taken->paths)) {
    if (auto ok = judge_free_run(*taken, arguments, *fit); !ok) return ok.error();
  }
  return StreamedFit{std::move(*fit), std::move(taken->factor), std::move(taken->paths)};
}

}  // namespace wisp::cli
