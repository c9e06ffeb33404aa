#include "wisp/learn/arx_parts.hpp"

#include <algorithm>
#include <fstream>

#include "learn/arx/judge/arx_verdict.hpp"
#include "learn/arx/judge/free_run_judge.hpp"
#include "learn/arx/learn_arx.hpp"
#include "learn/arx/report/report_values.hpp"
#include "learn/numeric/triangular_factor.hpp"

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
          " were asked for, which reach beyond its end"};
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

bool driven(const ArxOrders& orders) {
  const auto nb = orders.nb.values();
  return std::any_of(nb.begin(), nb.end(), [](int order) { return order > 0; });
}

// Simulates the model over the tables and adds what that says to the fit's summary.
Result<void> judge_free_run(const std::vector<Table>& tables, const ChannelChoice& channels, const Progress& progress,
                            ArxFit& fit) {
  FreeRunJudge judge(fit.model, channels);
  for (std::size_t k = 0; k < tables.size(); ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(tables.size());
    if (auto ok = arx::check_progress(progress, "simulating", share); !ok) return ok;
    const auto open = open_table(tables[k]);
    if (!open) return open.error();
    if (auto ok = judge.add(*open->reader, tables[k].share.rows); !ok) return ok;
  }
  if (const auto figures = judge.figures()) add_free_run(*figures, channels, fit.summary);
  return {};
}

}  // namespace

struct ArxPart::State {
  TriangularFactor factor;
  TriangularFactor empty;       // what each recording begins with, so that a bad one leaves no trace
  std::vector<Table> tables{};  // that were taken in whole
  bool only_tables = true;      // nothing else was taken in

  Result<void> merge(const TriangularFactor& more, const std::string& name) {
    if (auto ok = factor.merge(more); !ok) return Error{name + ": " + ok.error().message};
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
  if (recipe.curve_knots != 0)
    return Error{"curves on inputs need the recordings in memory: they cannot be fitted in parts"};
  const ChannelChoice channels{recipe.inputs, recipe.outputs};
  auto orders = arx::orders_of(recipe.na, recipe.nb, *recipe.nk, recipe.coupling, channels);
  if (!orders) return orders.error();
  auto factor = TriangularFactor::create({channels, std::move(*orders), {}});
  if (!factor) return factor.error();
  return ArxPart(std::make_unique<State>(State{*factor, *factor}));
}

Result<void> ArxPart::add(const Recording& recording, const TableShare& share) {
  const std::size_t end = share.rows == kAllRows ? recording.rows() : share.first + share.rows;
  if (share.first >= recording.rows() || end > recording.rows()) return beyond(recording.source, share);
  const Recording ranged = slice(recording, share.first, end);
  TriangularFactor factor = state_->empty;
  if (auto ok = factor.add(ranged, part_rows(ranged.rows(), share.index, share.count)); !ok) return ok;
  state_->only_tables = false;
  return state_->merge(factor, recording.source);
}

Result<void> ArxPart::add(const std::filesystem::path& path, const CsvOptions& options, const TableShare& share) {
  const Table table{path, options, share};
  PartRows part;
  if (share.count > 1 || share.first > 0 || share.rows != kAllRows) {
    const auto rows = count_rows(table);
    if (!rows) return rows.error();
    part = part_rows(*rows, share.index, share.count);
  }
  const auto open = open_table(table);
  if (!open) return open.error();
  TriangularFactor factor = state_->empty;
  const bool last = share.index + 1 == share.count;
  if (auto ok = factor.add(*open->reader, part, last ? std::min(part.end, share.rows) : kAllRows); !ok) return ok;
  if (auto ok = state_->merge(factor, path.string()); !ok) return ok;
  state_->tables.push_back(table);
  state_->only_tables &= share.count == 1;
  return {};
}

Result<void> ArxPart::merge(const ArxPart& other) {
  if (auto ok = state_->factor.merge(other.state_->factor); !ok) return ok;
  state_->only_tables &= other.state_->only_tables;
  const auto& more = other.state_->tables;
  state_->tables.insert(state_->tables.end(), more.begin(), more.end());
  return {};
}

std::size_t ArxPart::rows() const { return state_->factor.rows(); }

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
  if (auto ok = arx::check_progress(progress, "fitting", 0); !ok) return ok.error();
  auto fitted = factor.finish(arx::fit_options(recipe, factor.options().orders));
  if (!fitted) return fitted.error();
  const bool simulated = state_->only_tables && driven(fitted->model.orders);
  if (simulated) {
    if (auto ok = judge_free_run(state_->tables, channels, progress, *fitted); !ok) return ok.error();
  }
  arx::judge_use({channels, factor.options().orders}, fitted->summary);
  Fit fit = arx::finish(*fitted, recipe, channels, {factor.rate_hz(), factor.spans(), sources});
  if (!simulated && driven(fitted->model.orders)) {
    arx::add_line(fit.report.sections.back(), "free simulation",
                  "not judged: parts hold no rows to simulate; validate the model on a recording");
  }
  return fit;
}

}  // namespace wisp
