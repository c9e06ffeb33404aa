#include "learn/arx/search/search_windows.hpp"

#include <cmath>

#include "learn/arx/rows/arx_triangle.hpp"
#include "learn/arx/rows/lag_gram.hpp"

namespace wisp {

SearchWindows::SearchWindows(const Signals& signals, const LagLayout& layout, int earliest, int latest)
    : signals_(signals),
      layout_(layout),
      earliest_(earliest),
      latest_(latest),
      plan_(plan_rows(signals, layout, latest)),
      rows_(static_cast<std::size_t>(latest - earliest) + 1),
      gram_(rows_.size()) {
  const ChannelPairs all = ChannelPairs::Constant(layout.channels(), layout.channels(), true);
  rows_.back() = plan_.rows;
  gram_.back() = lag_gram(signals, plan_, layout, all);
  for (int first = latest - 1; first >= earliest; --first) {
    const Eigen::MatrixXd more = earlier_rows(first);
    rows_[index(first)] = rows_[index(first + 1)] + static_cast<std::size_t>(more.rows());
    gram_[index(first)] = gram_[index(first + 1)];
    gram_[index(first)].noalias() += more.transpose() * more;
  }
}

// Row `first_sample` of every episode that has it, without what is missing.
Eigen::MatrixXd SearchWindows::earlier_rows(int first_sample) const {
  const auto first = static_cast<std::size_t>(first_sample);
  Eigen::MatrixXd rows(0, layout_.size());
  Eigen::RowVectorXd row(layout_.size());
  for (std::size_t r = 0; r < signals_.samples.size(); ++r) {
    for (const Episode& episode : signals_.episodes[r]) {
      if (episode.size() <= first) continue;
      row[0] = 1;
      for (int p = 1; p < layout_.size(); ++p) {
        const auto [channel, lag] = layout_[p];
        const std::size_t t = episode.begin + first - static_cast<std::size_t>(lag);
        const bool there = lag <= first_sample;
        row[p] = there ? (signals_.samples[r][channel][t] - signals_.offset[channel]) * signals_.scale[channel] : 0.0;
      }
      if (row.hasNaN()) continue;
      rows.conservativeResize(rows.rows() + 1, Eigen::NoChange);
      rows.bottomRows(1) = row;
    }
  }
  return rows;
}

const Eigen::MatrixXd& SearchWindows::triangle(int first_sample) {
  const auto found = triangle_.find(first_sample);
  if (found != triangle_.end()) return found->second;
  if (first_sample == latest_) return triangle_[latest_] = triangle_by_qr(signals_, plan_, layout_);
  Eigen::MatrixXd later = triangle(first_sample + 1);
  reduce_rows(later, earlier_rows(first_sample));
  return triangle_[first_sample] = std::move(later);
}

}  // namespace wisp
