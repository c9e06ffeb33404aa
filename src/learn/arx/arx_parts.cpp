#include "wisp/learn/parts.hpp"

#include <algorithm>
#include <fstream>

#include "base/hash.hpp"
#include "learn/arx/fit/arx_errors.hpp"
#include "learn/arx/fit/arx_report.hpp"
#include "learn/arx/fit/triangular_factor.hpp"
#include "learn/arx/judge/arx_verdict.hpp"
#include "learn/arx/judge/prediction_tally.hpp"
#include "learn/arx/learn_arx.hpp"
#include "learn/arx/plain_model.hpp"
#include "learn/arx/report/report_values.hpp"
#include "learn/arx/rows/seen_rows.hpp"

namespace wisp {
namespace {

constexpr std::size_t kAllRows = std::numeric_limits<std::size_t>::max();

// A CSV file that was taken in whole or in its range.
struct Table {
  std::filesystem::path path;
  CsvOptions options;
  TableShare share;
};

// A CSV file being read, standing at the first row of its range.
struct OpenTable {
  std::unique_ptr<std::ifstream> stream;  // on the heap, where the reader's view of it survives moves
  std::unique_ptr<CsvReader> reader;
};

Result<OpenTable> open_table(const Table& table) {
  const std::string name = table.path.string();
  OpenTable open{std::make_unique<std::ifstream>(table.path, std::ios::binary), nullptr};
  if (!*open.stream || std::filesystem::is_directory(table.path)) {
    return Error{name + ": cannot be opened as a table; is the name right?"};
  }
  auto reader = CsvReader::open(*open.stream, name, table.options);
  if (!reader) return reader.error();
  open.reader = std::make_unique<CsvReader>(std::move(*reader));
  if (const auto skipped = open.reader->skip(table.share.first); !skipped) return skipped.error();
  return open;
}

Error beyond(const std::string& name, const TableShare& share) {
  return {name + ": rows " + std::to_string(share.first + 1) + ":" + std::to_string(share.first + share.rows) +
          " were requested, which reach beyond its end"};
}

// How many rows the table's range has. A reading of its own, which looks for ends of lines only.
Result<std::size_t> count_rows(const Table& table) {
  const auto open = open_table(table);
  if (!open) return open.error();
  const auto rows = open->reader->skip(table.share.rows);
  if (!rows) return rows.error();
  const std::string name = table.path.string();
  if (table.share.rows != kAllRows && *rows < table.share.rows) return beyond(name, table.share);
  if (*rows == 0) return Error{name + ": has a header but no rows"};
  return *rows;
}

// Which rows of a recording a share is of.
SeenRows seen_of(const std::string& source, std::uint64_t hash, std::uint64_t rows, const TableShare& share,
                 const PartRows& part) {
  const bool all = share.count == 1 && share.rows == kAllRows && rows == kAllRows;
  const std::uint64_t last = all ? kToTheEnd : share.first + rows;
  const std::uint64_t end = all || part.end >= rows ? last : share.first + part.end;
  return {source, hash, share.first, last, share.first + part.begin, end};
}

// Of a file's bytes, read once more: two parts know by it that they are of one recording, wherever it lies.
Result<std::uint64_t> hash_of_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> block(std::size_t{1} << 20);
  std::uint64_t hash = hash_bytes({});
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) || stream.gcount() > 0) {
    hash = hash_bytes(std::as_bytes(std::span(block.data(), static_cast<std::size_t>(stream.gcount()))), hash);
  }
  if (stream.bad()) return Error{path.string() + ": cannot be read to its end"};
  return hash;
}

// Of the samples of a model's channels.
std::uint64_t hash_of_samples(const Recording& recording, const ChannelChoice& channels) {
  std::uint64_t hash = hash_bytes({});
  for (const auto* names : {&channels.outputs, &channels.inputs}) {
    for (const std::string& name : *names) {
      const auto channel = find_channel(recording, name);
      if (channel) hash = hash_bytes(std::as_bytes(std::span(recording.channels[*channel].samples)), hash);
    }
  }
  return hash;
}

bool driven(const ArxOrders& orders) {
  const auto nb = orders.nb.values();
  return std::any_of(nb.begin(), nb.end(), [](int order) { return order > 0; });
}

// Which rows of which recordings the model knows.
void add_coverage(const FactorNotes& notes, ReportSection& section) {
  if (notes.jobs < 2) return;
  arx::add(section, "parts", static_cast<std::int64_t>(notes.jobs), "parts that were merged");
  ReportTable table{"covered", "rows taken in", {{"source", "recording"}, {"rows", "rows"}}, {}};
  for (const SeenRows& seen : notes.seen) table.rows.push_back({seen.source, rows_text(seen.begin, seen.end)});
  section.tables.push_back(std::move(table));
}

// Simulates the model over the tables, a stretch at a time and each from its measured start, and adds what that says to
// the fit's summary.
Result<void> judge_free_run(const std::vector<Table>& tables, const ChannelChoice& channels, const Progress& progress,
                            ArxFit& fit) {
  constexpr std::size_t kRowsAtATime = 65536;
  Tally tally(fit.model.orders.outputs());
  for (const Table& table : tables) {
    if (auto ok = arx::check_progress(progress, "simulating", 0); !ok) return ok;
    const auto open = open_table(table);
    if (!open) return open.error();
    for (std::size_t left = table.share.rows;;) {
      Recording window = open->reader->header();
      const auto read = open->reader->read(window, std::min(kRowsAtATime, left));
      if (!read) return read.error();
      if (*read == 0) break;
      left -= *read;
      const auto signals = signals_of_model(fit.model, {&window, 1}, channels);
      if (!signals) return signals.error();
      const FreeRunStart start{InitialState::kMeasured, fit.model.orders.history()};
      free_run(fit.model, *signals, 0, start, [&](std::size_t first, std::size_t rows, const double* values) {
        tally.add_simulated(*signals, 0, first, rows, values);
      });
    }
  }
  if (tally.rows() == 0) return {};
  fit.summary.free_run_fit_percent = tally.figures(kFreeRun).fit_percent;
  warn_of_free_run(channels.outputs, fit.summary);
  return {};
}

}  // namespace

struct ArxPart::State {
  TriangularFactor factor;
  TriangularFactor empty;       // what each recording begins with, so that a bad one leaves no trace
  std::vector<Table> tables{};  // that were taken in whole
  bool only_tables = true;      // nothing else was taken in

  Result<void> merge(const TriangularFactor& more, const SeenRows& seen) {
    auto all = joined(factor.notes().seen, {copy_of(seen, factor.notes().seen)});
    if (!all) return Error{seen.source + ": " + all.error().message};
    if (auto ok = factor.merge(more); !ok) return Error{seen.source + ": " + ok.error().message};
    factor.set_notes({factor.notes().jobs, std::move(*all)});
    return {};
  }
};

ArxPart::ArxPart(std::unique_ptr<State> state) : state_(std::move(state)) {}
ArxPart::ArxPart(ArxPart&&) noexcept = default;
ArxPart& ArxPart::operator=(ArxPart&&) noexcept = default;
ArxPart::~ArxPart() = default;

Result<ArxPart> ArxPart::create(const ArxRecipe& recipe) {
  if (recipe.search) return Error{"a part is of one model, and a search tries many: search first, then fit in parts"};
  if (!recipe.nk) return Error{"a part needs its delays as numbers: find them in recordings in memory first"};
  const ChannelChoice channels{recipe.inputs, recipe.outputs};
  auto orders = arx::orders_of(recipe.na, recipe.nb, *recipe.nk, recipe.coupling, channels);
  if (!orders) return orders.error();
  auto factor = TriangularFactor::create({channels, std::move(*orders)});
  if (!factor) return factor.error();
  return ArxPart(std::make_unique<State>(State{*factor, *factor}));
}

Result<void> ArxPart::add(const Recording& recording, const TableShare& share) {
  const std::size_t end = share.rows == kAllRows ? recording.rows() : share.first + share.rows;
  if (share.first >= recording.rows() || end > recording.rows()) return beyond(recording.source, share);
  const Recording ranged = slice(recording, share.first, end);
  TriangularFactor factor = state_->empty;
  const PartRows part = part_rows(ranged.rows(), share.index, share.count);
  if (auto ok = factor.add(ranged, part); !ok) return ok;
  const std::uint64_t hash = hash_of_samples(recording, factor.options().channels);
  if (auto ok = state_->merge(factor, seen_of(recording.source, hash, ranged.rows(), share, part)); !ok) return ok;
  state_->only_tables = false;
  return {};
}

Result<void> ArxPart::add(const std::filesystem::path& path, const CsvOptions& options, const TableShare& share) {
  const Table table{path, options, share};
  PartRows part;
  std::uint64_t rows = kAllRows;
  if (share.count > 1 || share.first > 0 || share.rows != kAllRows) {
    const auto counted = count_rows(table);
    if (!counted) return counted.error();
    rows = *counted;
    part = part_rows(*counted, share.index, share.count);
  }
  const auto open = open_table(table);
  if (!open) return open.error();
  TriangularFactor factor = state_->empty;
  const bool last = share.index + 1 == share.count;
  if (auto ok = factor.add(*open->reader, part, last ? std::min(part.end, share.rows) : kAllRows); !ok) return ok;
  const auto hash = hash_of_file(path);
  if (!hash) return hash.error();
  const SeenRows seen = seen_of(path.filename().string(), *hash, rows, share, part);
  if (auto ok = state_->merge(factor, seen); !ok) return ok;
  state_->tables.push_back(table);
  state_->only_tables &= share.count == 1;
  return {};
}

Result<void> ArxPart::merge(const ArxPart& other) {
  const FactorNotes &own = state_->factor.notes(), &more_notes = other.state_->factor.notes();
  TriangularFactor whole = state_->factor;
  if (auto ok = whole.merge(other.state_->factor); !ok) return ok;
  auto seen = joined(own.seen, more_notes.seen);
  if (!seen) return seen.error();
  whole.set_notes({own.jobs + more_notes.jobs, std::move(*seen)});
  state_->factor = std::move(whole);
  state_->only_tables &= other.state_->only_tables;
  const auto& more = other.state_->tables;
  state_->tables.insert(state_->tables.end(), more.begin(), more.end());
  return {};
}

std::size_t ArxPart::rows() const { return state_->factor.rows(); }

std::size_t ArxPart::jobs() const { return static_cast<std::size_t>(state_->factor.notes().jobs); }

std::vector<std::string> ArxPart::sources() const {
  std::vector<std::string> names;
  for (const SeenRows& seen : state_->factor.notes().seen) {
    if (std::find(names.begin(), names.end(), seen.source) == names.end()) names.push_back(seen.source);
  }
  std::sort(names.begin(), names.end());
  return names;
}

const ArxOrders& ArxPart::orders() const { return state_->factor.options().orders; }

std::vector<std::byte> ArxPart::bytes() const { return state_->factor.bytes(); }

Result<ArxPart> ArxPart::from_bytes(std::span<const std::byte> bytes) {
  auto factor = TriangularFactor::from_bytes(bytes);
  if (!factor) return factor.error();
  auto empty = TriangularFactor::create(factor->options());
  if (!empty) return empty.error();
  return ArxPart(std::make_unique<State>(State{std::move(*factor), std::move(*empty), {}, false}));
}

Result<Fit> ArxPart::finish(const ArxRecipe& recipe, const std::vector<std::string>& sources,
                            const Progress& progress) const {
  const TriangularFactor& factor = state_->factor;
  const ChannelChoice& channels = factor.options().channels;
  const FactorNotes& notes = factor.notes();
  if (auto ok = check_complete(notes.seen); !ok) return ok.error();
  const auto spans = factor.spans();
  for (std::size_t c = 0; c < spans.size(); ++c) {
    const std::size_t outputs = channels.outputs.size();
    const std::string& name = c < outputs ? channels.outputs[c] : channels.inputs[c - outputs];
    if (auto ok = arx::check_size(name, spans[c]); !ok) return ok.error();
  }
  if (auto ok = arx::check_progress(progress, "fitting", 0); !ok) return ok.error();
  auto fitted = factor.finish(arx::fit_options(recipe, factor.options().orders));
  if (!fitted) return fitted.error();
  const bool simulated = state_->only_tables && driven(fitted->model.orders);
  if (simulated) {
    if (auto ok = judge_free_run(state_->tables, channels, progress, *fitted); !ok) return ok.error();
  }
  arx::judge_use({channels, factor.options().orders}, fitted->summary);
  Fit fit = arx::finish(*fitted, recipe, channels, {factor.rate_hz(), factor.spans(), sources});
  add_coverage(notes, fit.report.sections.back());
  if (!simulated && driven(fitted->model.orders)) {
    arx::add_line(fit.report.sections.back(), "free simulation",
                  "not judged: parts hold no rows to simulate; validate the model on a recording");
  }
  return fit;
}

}  // namespace wisp
