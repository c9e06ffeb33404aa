#pragma once
// Rows of a regression on lagged channels: the samples that can be predicted, and the history they need.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// A regression's column: `channel` at t − lag. Channels are the outputs, then the inputs; −1 is the constant column.
struct LaggedChannel {
  int channel = 0;
  int lag = 0;
  friend bool operator==(const LaggedChannel&, const LaggedChannel&) = default;
};
inline constexpr int kConstantChannel = -1;

/// Columns in a fixed order: the constant, then for each channel the lags in use, ascending. Lag 0 of every output is
/// included as the target.
class LagLayout {
 public:
  LagLayout(int outputs, int inputs, std::span<const LaggedChannel> used);

  int outputs() const { return outputs_; }
  int channels() const { return static_cast<int>(lags_.size()); }
  int size() const { return static_cast<int>(columns_.size()); }

  /// Largest lag in use, the number of rows of history.
  int history() const { return history_; }

  /// Lags in use of one channel, ascending.
  std::span<const int> lags(int channel) const { return lags_[channel]; }

  LaggedChannel operator[](int column) const { return columns_[column]; }

  /// Position of a column, or −1 where it is absent.
  int find(LaggedChannel column) const;

  int target(int output) const { return find({output, 0}); }

 private:
  int outputs_;
  int history_ = 0;
  std::vector<std::vector<int>> lags_;
  std::vector<int> first_;  // position of each channel's first lag
  std::vector<LaggedChannel> columns_;
};

/// Names of channels, in the model's order. Recorded roles are ignored: one system's output may be another's input.
struct ChannelChoice {
  std::vector<std::string> inputs;   ///< may be empty: a model without input
  std::vector<std::string> outputs;  ///< at least one
};

/// The chosen channels of all recordings. The regression uses (sample − offset)·scale; scales are powers of two near
/// 1/RMS, which cause no rounding, and 0 for constant channels.
struct Signals {
  int outputs = 0;
  int inputs = 0;
  std::vector<std::string> names;                             ///< outputs, then inputs
  std::vector<std::vector<std::span<const double>>> samples;  ///< [recording][channel]
  std::vector<std::vector<Episode>> episodes;                 ///< [recording]
  std::vector<double> offset;
  std::vector<double> scale;
  bool missing = true;  ///< whether samples may be missing

  int channels() const { return outputs + inputs; }
};

/// Sums of (sample − reference) and of its square over a channel's samples that are not missing.
struct ChannelSums {
  double sum = 0;
  double square = 0;
  std::size_t count = 0;
};

/// Offset subtracted from a channel's samples, and the scale they are multiplied by afterwards.
struct ChannelPoint {
  double offset = 0;
  double scale = 0;
};

/// Operating point of a channel: its mean, 0 for kNone; scale 0 if it is constant. Precondition: sums.count > 0.
ChannelPoint operating_point(const ChannelSums& sums, double reference, ArxOffset offset);

/// Target rows [begin, end) of one recording, all usable.
struct RowRun {
  std::size_t recording = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

struct RowCounts {
  std::size_t rows = 0;  ///< n: rows in the regression
  int first_sample = 0;  ///< first predicted row of every episode, 0-based
  std::size_t episodes_used = 0;
  std::size_t episodes_skipped = 0;  ///< episodes without a row to predict: too short, or incomplete
  std::size_t rows_left_out = 0;     ///< rows skipped because a sample in them or in their history is missing
};

struct RowPlan : RowCounts {
  std::vector<RowRun> runs;
};

/// Finds the channels, with offsets 0 and scales 1. Errors: no recording or output, a missing channel, different rates.
Result<Signals> find_signals(std::span<const Recording> recordings, const ChannelChoice& channels);

/// Finds channels, offsets and scales. Errors: as find_signals; a channel without samples, or whose squares overflow.
Result<Signals> gather_signals(std::span<const Recording> recordings, const ChannelChoice& channels, ArxOffset offset);

/// Maximum number of rows that a model is judged on; more would not change the figures noticeably.
inline constexpr std::size_t kJudgedRows = std::size_t{1} << 18;

/// The central part of every recording, at most `most` rows in total. The result's spans view the samples of `signals`.
Signals middle_of(const Signals& signals, std::size_t most);

/// Rows whose regressors and targets are all present, from row `first_sample` of every episode on.
///
/// Precondition: first_sample >= layout.history().
RowPlan plan_rows(const Signals& signals, const LagLayout& layout, int first_sample);

/// Rows [begin, end) of the first recording, and whether the recording ends at `end`.
struct RowPart {
  std::size_t begin = 0;
  std::size_t end = 0;
  bool last = true;
};

/// Plans the rows of one part. An episode counts as used in the part with its first target row, even if samples are
/// missing. An episode too short for a target row counts as skipped in the part with the row after its end.
RowPlan plan_part(const Signals& signals, const LagLayout& layout, int first_sample, const RowPart& part);

/// Rows of one recording whose inputs are all present, whether or not outputs are missing.
RowPlan plan_input_rows(const Signals& signals, std::size_t recording, const LagLayout& layout, int first_sample);

/// Scaled samples of all channels over a block of rows and the history before it.
class ScaledBlock {
 public:
  /// Preconditions: `signals` outlives the block; history >= 0.
  ScaledBlock(const Signals& signals, int history) : signals_(signals), history_(history) {}

  /// Loads the rows, and `history` rows before them. Precondition: rows.begin >= history.
  void load(const RowRun& rows);

  std::size_t rows() const { return rows_; }

  /// The channel at t − lag over the block's rows.
  const double* series(LaggedChannel column) const {
    return samples_.data() + static_cast<std::size_t>(column.channel) * stride_ +
           static_cast<std::size_t>(history_ - column.lag);
  }

 private:
  const Signals& signals_;
  int history_;
  std::size_t rows_ = 0;
  std::size_t stride_ = 0;
  std::vector<double> samples_;
};

/// Number of rows processed together: samples of a few channels fit into the first-level cache.
inline constexpr std::size_t kBlockRows = 1024;

/// Calls visit(RowRun) for all rows of the plan, in blocks of at most kBlockRows.
template <class Visit>
void for_each_block(const RowPlan& plan, Visit visit) {
  for (const RowRun& run : plan.runs) {
    for (std::size_t begin = run.begin; begin < run.end; begin += kBlockRows) {
      visit(RowRun{run.recording, begin, begin + kBlockRows < run.end ? begin + kBlockRows : run.end});
    }
  }
}

}  // namespace wisp
