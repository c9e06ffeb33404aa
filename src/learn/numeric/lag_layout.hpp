#pragma once
// Columns of a regression: channels with their lags, and the position of each column.

#include <span>
#include <vector>

namespace wisp {

/// A column of a regression: channel `channel` at t − lag. Channels are the outputs, then the inputs; the constant
/// column is channel −1.
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

}  // namespace wisp
