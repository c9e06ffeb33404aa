#pragma once
// The rows of a regression on lagged channels: which samples of which recordings may be predicted from which history.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/learn/arx_fit.hpp"

namespace wisp {

/// One column of a regression: channel `channel` at t − lag. Channels are the outputs, then the inputs; the constant
/// column is channel −1.
struct LaggedChannel {
  int channel = 0;
  int lag = 0;
  friend bool operator==(const LaggedChannel&, const LaggedChannel&) = default;
};
inline constexpr int kConstantChannel = -1;

/// The chosen channels of all recordings. The regression works on (sample − offset)·scale; scales are powers of two
/// near 1/RMS, so that they cost no rounding, and 0 for a channel that never moves.
struct Signals {
  int outputs = 0;
  int inputs = 0;
  std::vector<std::string> names;                             ///< outputs, then inputs
  std::vector<std::vector<std::span<const double>>> samples;  ///< [recording][channel]
  std::vector<std::vector<Episode>> episodes;                 ///< [recording]
  std::vector<double> offset;
  std::vector<double> scale;
  std::vector<double> deviation;  ///< RMS of sample − offset
  bool missing = false;           ///< whether any sample is

  int channels() const { return outputs + inputs; }
};

/// Target rows [begin, end) of one recording, all of them usable.
struct RowRun {
  std::size_t recording = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// All target rows.
struct RowPlan {
  std::vector<RowRun> runs;
  std::size_t rows = 0;
  int first_sample = 0;
  std::size_t episodes_used = 0;
  std::size_t episodes_skipped = 0;
  std::size_t rows_left_out = 0;
};

/// Finds the channels, with offsets 0 and scales 1. Errors: as fit_arx, for recordings and channels.
Result<Signals> find_signals(std::span<const Recording> recordings, const ChannelChoice& channels);

/// Finds the channels and their offsets and scales. Errors: as find_signals, and where a channel has no sample.
Result<Signals> gather_signals(std::span<const Recording> recordings, const ChannelChoice& channels, ArxOffset offset);

/// The lags of each channel that any of `columns` uses, ascending, and lag 0 of every output.
std::vector<std::vector<int>> lags_in_use(const Signals& signals, std::span<const LaggedChannel> columns);

/// The rows whose output and history are all there, from row `first_sample` of every episode on.
RowPlan plan_rows(const Signals& signals, const std::vector<std::vector<int>>& lags, int first_sample);

/// Writes samples [begin, end) of a channel, offset and scaled, to `out`.
void copy_scaled(const Signals& signals, std::size_t recording, int channel, std::size_t begin, std::size_t end,
                 double* out);

}  // namespace wisp
