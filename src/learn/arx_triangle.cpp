#include "arx_triangle.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <vector>

namespace wisp {
namespace {

// Columns of one block of rows, from one copy of the channels' samples.
class BlockBuilder {
 public:
  BlockBuilder(const Signals& signals, std::span<const LaggedChannel> columns, int history)
      : signals_(signals), columns_(columns), history_(history) {}

  void fill(const RowRun& rows, Eigen::Ref<Eigen::MatrixXd> block) {
    const auto count = static_cast<Eigen::Index>(rows.end - rows.begin);
    samples_.resize(count + history_, signals_.channels());
    for (int c = 0; c < signals_.channels(); ++c) {
      const std::size_t back = std::min<std::size_t>(history_, rows.begin);
      copy_scaled(signals_, rows.recording, c, rows.begin - back, rows.end, samples_.col(c).data() + (history_ - back));
    }
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      const auto [channel, lag] = columns_[j];
      auto column = block.col(static_cast<Eigen::Index>(j));
      if (channel == kConstantChannel) {
        column.setOnes();
      } else {
        column = samples_.col(channel).segment(history_ - lag, count);
      }
    }
    for (int i = 0; i < signals_.outputs; ++i) {
      block.col(static_cast<Eigen::Index>(columns_.size()) + i) = samples_.col(i).segment(history_, count);
    }
  }

 private:
  const Signals& signals_;
  std::span<const LaggedChannel> columns_;
  int history_;
  Eigen::MatrixXd samples_;
};

}  // namespace

Eigen::MatrixXd triangle_by_qr(const Signals& signals, const RowPlan& plan, std::span<const LaggedChannel> columns) {
  int history = 0;
  for (const LaggedChannel& column : columns) history = std::max(history, column.lag);
  const auto width = static_cast<Eigen::Index>(columns.size()) + signals.outputs;
  const Eigen::Index most_rows = std::max<Eigen::Index>(512, 2 * width);
  BlockBuilder builder(signals, columns, history);
  Eigen::MatrixXd stack = Eigen::MatrixXd::Zero(width + most_rows, width);
  for (const RowRun& run : plan.runs) {
    for (std::size_t begin = run.begin; begin < run.end; begin += static_cast<std::size_t>(most_rows)) {
      const std::size_t end = std::min(run.end, begin + static_cast<std::size_t>(most_rows));
      const auto count = static_cast<Eigen::Index>(end - begin);
      builder.fill({run.recording, begin, end}, stack.middleRows(width, count));
      Eigen::Ref<Eigen::MatrixXd> rows = stack.topRows(width + count);
      Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> in_place(rows);
      stack.topRows(width).triangularView<Eigen::StrictlyLower>().setZero();
    }
  }
  return stack.topRows(width);
}

}  // namespace wisp
