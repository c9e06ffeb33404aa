#pragma once
// Free simulation held against tables too large for memory: what fit_arx tells of a recording that it has whole.

#include <cstddef>
#include <limits>
#include <memory>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/arx/judge/prediction.hpp"
#include "learn/arx/rows/channel_choice.hpp"
#include "wisp/base/result.hpp"
#include "wisp/record/csv.hpp"

namespace wisp {

/// Simulates a model along the inputs of tables as they are read, and keeps sums of its errors only. The figures are
/// those of prediction_figures with kFreeRun over the whole tables, but for rounding.
class FreeRunJudge {
 public:
  /// Preconditions: the channels fit the model.
  FreeRunJudge(const ArxModel& model, const ChannelChoice& channels);

  FreeRunJudge(FreeRunJudge&&) noexcept;
  FreeRunJudge& operator=(FreeRunJudge&&) noexcept;
  ~FreeRunJudge();

  /// Takes in the table from where the reader stands, at most `table_rows` rows.
  /// Errors: a channel that the table has not, and as CsvReader.
  Result<void> add(CsvReader& reader, std::size_t table_rows = std::numeric_limits<std::size_t>::max());

  /// Over all that was taken in.
  /// Errors: no row could be simulated.
  Result<PredictionFigures> figures() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes how a free simulation fits into a fit's summary, and warns as fit_arx does where one-step fit hides failure.
void add_free_run(const PredictionFigures& figures, const ChannelChoice& channels, ArxSummary& summary);

}  // namespace wisp
