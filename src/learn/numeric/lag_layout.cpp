#include "learn/numeric/lag_layout.hpp"

#include <algorithm>

namespace wisp {

LagLayout::LagLayout(int outputs, int inputs, std::span<const LaggedChannel> used)
    : outputs_(outputs), lags_(outputs + inputs), columns_{{kConstantChannel, 0}} {
  for (int i = 0; i < outputs; ++i) lags_[i].push_back(0);
  for (const LaggedChannel& column : used) {
    if (column.channel != kConstantChannel) lags_[column.channel].push_back(column.lag);
  }
  for (int c = 0; c < channels(); ++c) {
    std::sort(lags_[c].begin(), lags_[c].end());
    lags_[c].erase(std::unique(lags_[c].begin(), lags_[c].end()), lags_[c].end());
    first_.push_back(size());
    for (int lag : lags_[c]) columns_.push_back({c, lag});
    if (!lags_[c].empty()) history_ = std::max(history_, lags_[c].back());
  }
}

int LagLayout::find(LaggedChannel column) const {
  if (column.channel == kConstantChannel) return 0;
  const auto& lags = lags_[column.channel];
  const auto place = std::lower_bound(lags.begin(), lags.end(), column.lag);
  if (place == lags.end() || *place != column.lag) return -1;
  return first_[column.channel] + static_cast<int>(place - lags.begin());
}

}  // namespace wisp
