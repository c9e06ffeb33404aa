#include "learn/arx/judge/free_run_judge.hpp"

#include <algorithm>
#include <cmath>

#include "learn/arx/fit/arx_errors.hpp"
#include "learn/arx/fit/arx_report.hpp"
#include "learn/arx/judge/free_run.hpp"
#include "learn/arx/judge/prediction_tally.hpp"

namespace wisp {
namespace {

// What is taken into memory of a table at a time.
constexpr std::size_t kRowsAtATime = 65536;

// The last rows of a window become the history of the next one. Outputs that were simulated there take the measured
// ones' place, so that the simulation goes on where it was.
Recording next_window(const Recording& window, const std::vector<std::size_t>& outputs,
                      const std::vector<std::vector<double>>& simulated, std::size_t kept) {
  const std::size_t first = window.rows() - std::min(kept, window.rows());
  Recording next = slice(window, first, window.rows());
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    std::vector<double>& samples = next.channels[outputs[i]].samples;
    for (std::size_t t = 0; t < samples.size(); ++t) {
      if (!std::isnan(simulated[i][first + t])) samples[t] = simulated[i][first + t];
    }
  }
  return next;
}

}  // namespace

struct FreeRunJudge::State {
  ArxModel model;
  ChannelChoice channels;
  Tally tally;

  Result<void> add_window(const Recording& window, std::vector<std::vector<double>>& simulated) {
    const auto signals = signals_of_model(model, {&window, 1}, channels);
    if (!signals) return signals.error();
    const auto outputs = static_cast<std::size_t>(signals->outputs);
    simulated.assign(outputs, std::vector<double>(window.rows(), std::numeric_limits<double>::quiet_NaN()));
    FreeRunTally errors(tally);
    free_run(model, *signals, 0, {InitialState::kMeasured, model.orders.history()},
             [&](std::size_t first, std::size_t rows, const double* values) {
               errors.add(*signals, 0, first, rows, values);
               for (std::size_t t = 0; t < rows; ++t) {
                 for (std::size_t i = 0; i < outputs; ++i) {
                   simulated[i][first + t] = values[t * outputs + i] + signals->offset[i];
                 }
               }
             });
    return {};
  }
};

FreeRunJudge::FreeRunJudge(const ArxModel& model, const ChannelChoice& channels)
    : state_(std::make_unique<State>(State{model, channels, Tally(model.orders.outputs(), 1)})) {}
FreeRunJudge::FreeRunJudge(FreeRunJudge&&) noexcept = default;
FreeRunJudge& FreeRunJudge::operator=(FreeRunJudge&&) noexcept = default;
FreeRunJudge::~FreeRunJudge() = default;

Result<void> FreeRunJudge::add(CsvReader& reader, std::size_t table_rows) {
  const auto kept = static_cast<std::size_t>(state_->model.orders.history());
  Recording window = reader.header();
  std::vector<std::size_t> outputs;
  for (const std::string& name : state_->channels.outputs) {
    const auto found = find_channel(window, name);
    if (!found) return Error{window.source + " has no channel '" + name + "'"};
    outputs.push_back(*found);
  }
  std::vector<std::vector<double>> simulated;
  for (std::size_t left = table_rows;;) {
    const auto read = reader.read(window, std::min(kRowsAtATime, left));
    if (!read) return read.error();
    if (*read == 0) return {};
    left -= *read;
    if (auto ok = state_->add_window(window, simulated); !ok) return ok;
    window = next_window(window, outputs, simulated, kept);
  }
}

Result<PredictionFigures> FreeRunJudge::figures() const {
  if (state_->tally.rows() == 0) return Error{"no row can be simulated"};
  return state_->tally.figures(kFreeRun);
}

void add_free_run(const PredictionFigures& figures, const ChannelChoice& channels, ArxSummary& summary) {
  summary.free_run_fit_percent = figures.fit_percent;
  warn_of_free_run(channels.outputs, summary);
}

}  // namespace wisp
