#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/hash.hpp"
#include "base/statistics.hpp"
#include "learn/arx/learn_arx.hpp"
#include "learn/arx/part_state.hpp"
#include "learn/fit/arx_errors.hpp"
#include "learn/fit/arx_estimate.hpp"
#include "learn/fit/arx_fit.hpp"
#include "learn/fit/arx_report.hpp"
#include "learn/judge/arx_verdict.hpp"
#include "learn/judge/prediction.hpp"
#include "learn/report/report_values.hpp"
#include "wisp/learn/parts.hpp"

namespace wisp {
namespace arx {
namespace {

constexpr std::size_t kAllRows = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kRowsAtATime = 65536;  // rows of a table held in memory at a time

// A CSV file, and the range of its rows (by default all) that a part reads.
struct Table {
  std::filesystem::path path;
  CsvOptions options;
  std::size_t first = 0, rows = kAllRows;

  std::string name() const { return path.string(); }
};

// An open CSV file. open_table() leaves the reader at the first row of the table's range.
struct OpenTable {
  std::unique_ptr<std::ifstream> stream;  // on the heap, so that the reader's pointer to it survives moves
  std::unique_ptr<CsvReader> reader;
};

Result<OpenTable> open_table(const Table& table) {
  OpenTable open{std::make_unique<std::ifstream>(table.path, std::ios::binary), nullptr};
  if (!*open.stream || std::filesystem::is_directory(table.path)) {
    return Error{table.name() + ": cannot be opened as a table; is the name right?"};
  }
  auto reader = CsvReader::open(*open.stream, table.name(), table.options);
  if (!reader) return reader.error();
  open.reader = std::make_unique<CsvReader>(std::move(*reader));
  if (const auto skipped = open.reader->skip(table.first); !skipped) return skipped.error();
  return open;
}

Error beyond(const std::string& name, const TableShare& share) {
  return {name + ": rows " + rows_text(share.first, share.first + share.rows) +
          " were requested, which reach beyond its end"};
}

// Returns the rows of part share.index where `rows` rows are divided into share.count nearly equal parts.
RowPart share_of(std::size_t rows, const TableShare& share) {
  const auto start = [&](std::size_t k) { return k * (rows / share.count) + std::min(k, rows % share.count); };
  return {start(share.index), start(share.index + 1), share.index + 1 == share.count};
}

// Hash of a file's bytes (a second read), by which two parts recognise one recording under any path.
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

// Adds rows of a recording to the state; the rows of the episode before them serve as history.
// Errors: a missing channel, infinite samples. merge() compares the rates.
Result<void> take_rows(const Recording& recording, const RowPart& part, PartState& state) {
  auto signals = find_signals({&recording, 1}, state.names);
  if (!signals) return signals.error();
  state.rate_hz = recording.rate_hz;
  for (std::size_t c = 0; c < state.channels.size(); ++c) {
    PartChannel& channel = state.channels[c];
    const auto samples = signals->samples[0][c].subspan(part.begin, part.end - part.begin);
    if (std::any_of(samples.begin(), samples.end(), [](double sample) { return std::isinf(sample); })) {
      return Error{"channel '" + signals->names[c] + "' holds an infinite sample"};
    }
    if (std::isnan(channel.reference)) {
      const std::vector<double> there = present({samples.begin(), samples.end()});
      if (!there.empty()) channel.reference = mean(there);
    }
    if (channel.span.unit.empty()) {
      channel.span.unit = recording.channels[*find_channel(recording, signals->names[c])].unit;
    }
    signals->offset[c] = std::isnan(channel.reference) ? 0.0 : channel.reference;
    for (double sample : samples) channel.add(sample);
  }
  const LagLayout layout = layout_of(state.orders);
  const RowPlan plan = plan_part(*signals, layout, state.orders.history(), part);
  if (plan.rows > 0) reduce_rows(state.triangle, triangle_by_qr(*signals, plan, layout));
  state.rows += plan.rows;
  state.episodes_used += plan.episodes_used;
  state.episodes_skipped += plan.episodes_skipped;
  state.rows_left_out += plan.rows_left_out;
  return {};
}

// Adds rows of a table, counted from the reader's position, chunk by chunk. Returns the number of rows.
Result<std::size_t> take_table(CsvReader& reader, const RowPart& part, PartState& state) {
  // Keeps one row more than the history: plan_part() would count an episode cut to fewer rows as too short.
  const auto kept = static_cast<std::size_t>(state.orders.history()) + 1;
  const std::size_t before = std::min(kept, part.begin);
  Recording window = reader.header();
  if (const auto passed = reader.skip(part.begin - before); !passed) return passed.error();
  if (const auto history = reader.read(window, before); !history) return history.error();
  for (std::size_t at = part.begin;;) {
    const std::size_t known = window.rows();
    const auto read = reader.read(window, std::min(kRowsAtATime, part.end - at));
    if (!read) return read.error();
    at += *read;
    const bool over = *read == 0;
    if (auto ok = take_rows(window, {known, window.rows(), over && (part.last || at < part.end)}, state); !ok) {
      return ok.error();
    }
    if (over) return at - part.begin;
    window = slice(window, window.rows() - std::min(kept, window.rows()), window.rows());
  }
}

// Computes operating point and scales as gather_signals() does. Errors: a channel without samples; as check_size().
Result<FitFacts> facts_of(const PartState& state, const ArxOptions& options) {
  FitFacts facts;
  facts.options = options;
  facts.outputs = state.orders.outputs();
  facts.names = state.names.outputs;
  facts.names.insert(facts.names.end(), state.names.inputs.begin(), state.names.inputs.end());
  for (std::size_t c = 0; c < facts.names.size(); ++c) {
    const PartChannel& channel = state.channels[c];
    if (channel.samples == 0) return Error{"channel '" + facts.names[c] + "' has no sample that is not missing"};
    if (auto ok = check_size(facts.names[c], channel.span); !ok) return ok.error();
    const ChannelPoint point = operating_point({channel.sum, channel.square, static_cast<std::size_t>(channel.samples)},
                                               channel.reference, options.offset);
    facts.offset.push_back(point.offset);
    facts.scale.push_back(point.scale);
  }
  facts.rows = state.rows;
  facts.first_sample = state.orders.history();
  facts.episodes_used = state.episodes_used;
  facts.episodes_skipped = state.episodes_skipped;
  facts.rows_left_out = state.rows_left_out;
  return facts;
}

// Sets `fits` to the fit percentages of free simulation, restarted from measured samples every kRowsAtATime rows.
Result<void> simulate(const std::vector<Table>& tables, const PartState& state, const ArxModel& model,
                      const Progress& progress, std::vector<double>& fits) {
  Tally tally(model.orders.outputs());
  for (const Table& table : tables) {
    if (auto ok = check_progress(progress, "simulating", 0); !ok) return ok;
    const auto open = open_table(table);
    if (!open) return open.error();
    for (std::size_t left = table.rows; left > 0;) {
      Recording window = open->reader->header();
      const auto read = open->reader->read(window, std::min(kRowsAtATime, left));
      if (!read) return read.error();
      if (*read == 0) break;
      left -= *read;
      const auto signals = signals_of_model(model, {&window, 1}, state.names);
      if (!signals) return signals.error();
      const FreeRunStart start{InitialState::kMeasured, model.orders.history()};
      free_run(model, *signals, 0, start, [&](std::size_t first, std::size_t rows, const double* values) {
        tally.add_simulated(*signals, 0, first, rows, values);
      });
    }
  }
  if (tally.rows() > 0) fits = tally.figures(kFreeRun).fit_percent;
  return {};
}

// Fits all rows in the part. Departures from fit_arx(): the poles of an unstable estimate are moved only as far as
// stability needs, and free simulation is judged in double precision over `tables`, if any.
Result<ArxFit> fit_of(const PartState& state, const ArxOptions& options, const std::vector<Table>& tables,
                      const Progress& progress) {
  if (auto ok = check_options(options, state.names); !ok) return ok.error();
  const ArxDesign design = make_design(options.orders, options.offset, options.kernel != ArxKernel::kNone);
  const RowCounts counts{.rows = static_cast<std::size_t>(state.rows), .first_sample = state.orders.history()};
  if (auto ok = check_rows(counts, design); !ok) return ok.error();
  const auto facts = facts_of(state, options);
  if (!facts) return facts.error();
  std::vector<double> shift;
  for (std::size_t c = 0; c < facts->offset.size(); ++c) {
    shift.push_back(state.channels[c].reference - facts->offset[c]);
  }
  Eigen::MatrixXd triangle = state.triangle;
  shift_columns(state.orders, shift, facts->scale, triangle);
  ArxFit fit = report_fit(*facts, design,
                          estimate_from_triangle(triangle, facts->scale, design, {options.covariance, options.kernel}));
  if (auto ok = simulate(tables, state, fit.model, progress, fit.summary.free_run_fit_percent); !ok) return ok.error();
  judge_fit(*facts, fit.summary);
  return fit;
}

}  // namespace
}  // namespace arx

using arx::PartState;

struct ArxPart::State : PartState {
  std::vector<arx::Table> tables{};  // tables that were added as a whole

  // Merges the part just read from a recording; on an error nothing of it is merged.
  Result<void> take(const std::string& source, PartState&& part, const arx::SeenRows& read) {
    part.seen = {read};
    auto ok = merge(part);
    return ok ? std::move(ok) : Error{source + ": " + ok.error().message};
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
  return ArxPart(std::make_unique<State>(State{{channels, std::move(*orders)}}));
}

Result<void> ArxPart::add(const Recording& recording, const TableShare& share) {
  const std::size_t left = recording.rows() - std::min(share.first, recording.rows());
  const std::size_t rows = share.rows == arx::kAllRows ? left : share.rows;
  if (recording.rows() == 0) return Error{recording.source + ": has no rows"};
  if (left == 0 || rows > left) return arx::beyond(recording.source, share);
  const std::size_t end = share.first + rows;
  PartState own(state_->names, state_->orders);
  const RowPart part = arx::share_of(end - share.first, share);
  if (auto ok = arx::take_rows(slice(recording, share.first, end), part, own); !ok) return ok;
  std::uint64_t hash = hash_bytes({});
  for (const auto* names : {&own.names.outputs, &own.names.inputs}) {
    for (const std::string& name : *names) {
      hash = hash_bytes(std::as_bytes(std::span(recording.channels[*find_channel(recording, name)].samples)), hash);
    }
  }
  const std::string name = std::filesystem::path(recording.source).filename().string();
  return state_->take(recording.source, std::move(own),
                      {name, hash, share.first, end, share.first + part.begin, share.first + part.end});
}

Result<void> ArxPart::add(const std::filesystem::path& path, const CsvOptions& options, const TableShare& share) {
  const arx::Table table{path, options, share.first, share.rows};
  RowPart part{0, share.rows, true};
  std::size_t rows = share.rows;
  if (share.count > 1) {  // counts the rows in a separate read that only looks for line ends
    const auto counting = arx::open_table(table);
    if (!counting) return counting.error();
    const auto counted = counting->reader->skip(share.rows);
    if (!counted) return counted.error();
    rows = *counted;
    part = arx::share_of(rows, share);
  }
  const auto open = arx::open_table(table);
  if (!open) return open.error();
  PartState own(state_->names, state_->orders);
  const auto read = arx::take_table(*open->reader, part, own);
  if (!read) return read.error();
  if (share.count == 1) rows = part.end = *read;
  if (share.rows != arx::kAllRows && rows < share.rows) return arx::beyond(table.name(), share);
  if (rows == 0) return Error{table.name() + ": has a header but no rows"};
  const auto hash = arx::hash_of_file(path);
  if (!hash) return hash.error();
  const arx::SeenRows seen{path.filename().string(), *hash, share.first, share.first + rows, share.first + part.begin,
                           share.first + part.end};
  if (auto ok = state_->take(table.name(), std::move(own), seen); !ok) return ok;
  if (share.count == 1) state_->tables.push_back(table);
  return {};
}

Result<void> ArxPart::merge(const ArxPart& other) {
  const State& more = *other.state_;
  if (auto ok = state_->merge(more); !ok) return ok;
  state_->jobs += more.jobs;
  state_->tables.insert(state_->tables.end(), more.tables.begin(), more.tables.end());
  return {};
}

std::size_t ArxPart::rows() const { return state_->rows; }

std::size_t ArxPart::jobs() const { return state_->jobs; }

std::vector<std::string> ArxPart::sources() const {
  std::vector<std::string> names;
  for (const arx::SeenRows& seen : state_->seen) {
    if (std::find(names.begin(), names.end(), seen.source) == names.end()) names.push_back(seen.source);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::byte> ArxPart::bytes() const { return state_->bytes(); }

Result<ArxPart> ArxPart::from_bytes(std::span<const std::byte> bytes) {
  auto state = PartState::from_bytes(bytes);
  if (!state) return state.error();
  return ArxPart(std::make_unique<State>(State{std::move(*state)}));
}

Result<Fit> ArxPart::finish(const ArxRecipe& recipe, const Progress& progress) const {
  const PartState& state = *state_;
  const auto rows = arx::covered(state.seen);
  if (!rows) return rows.error();
  if (auto ok = arx::check_progress(progress, "fitting", 0); !ok) return ok.error();
  const auto nb = state.orders.nb.values();
  const bool driven = std::any_of(nb.begin(), nb.end(), [](int order) { return order > 0; });
  const bool simulated = driven && state_->tables.size() == state.seen.size();  // every row can be read again
  auto fitted = arx::fit_of(state, arx::fit_options(recipe, state.orders),
                            simulated ? state_->tables : std::vector<arx::Table>(), progress);
  if (!fitted) return fitted.error();
  Usable& usable = fitted->summary.usable;
  arx::judge_use({state.names, state.orders}, fitted->summary);
  if (usable.verdict && driven) {
    usable.reason += std::string(simulated ? "" : "; free simulation was not judged, as parts hold no rows") +
                     "; no row was held out: validate the model on another recording";
  }
  arx::Sources sources{.rate_hz = state.rate_hz, .files = this->sources()};
  for (const arx::PartChannel& channel : state.channels) sources.spans.push_back(channel.span);
  Fit fit = arx::finish(*fitted, recipe, state.names, sources);
  ReportSection& section = fit.report.sections.back();
  if (state.jobs > 1) {
    arx::add(section, "parts", static_cast<std::int64_t>(state.jobs), "parts that were merged");
    ReportTable table{"covered", "rows taken in", {{"source", "recording"}, {"rows", "rows"}}, {}};
    for (const arx::SeenRows& seen : *rows) table.rows.push_back({seen.source, arx::rows_text(seen.begin, seen.end)});
    section.tables.push_back(std::move(table));
  }
  arx::complete(fit);
  return fit;
}

}  // namespace wisp
