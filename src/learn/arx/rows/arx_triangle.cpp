#include "learn/arx/rows/arx_triangle.hpp"

#include <Eigen/QR>
#include <algorithm>

namespace wisp {

void reduce_rows(Eigen::MatrixXd& triangle, const Eigen::MatrixXd& rows) {
  const Eigen::Index width = triangle.cols();
  Eigen::MatrixXd stack(width + rows.rows(), width);
  stack << triangle, rows;
  Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> in_place(stack);
  triangle = stack.topRows(width).triangularView<Eigen::Upper>();
}

Eigen::MatrixXd triangle_by_qr(const Signals& signals, const RowPlan& plan, const LagLayout& layout) {
  Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(layout.size(), layout.size());
  ScaledBlock block(signals, layout.history());
  Eigen::MatrixXd rows;
  for_each_block(plan, [&](const RowRun& run) {
    block.load(run);
    const auto count = static_cast<Eigen::Index>(block.rows());
    rows.resize(count, layout.size());
    rows.col(0).setOnes();
    for (int p = 1; p < layout.size(); ++p) {
      rows.col(p) = Eigen::Map<const Eigen::VectorXd>(block.series(layout[p]), count);
    }
    reduce_rows(triangle, rows);
  });
  return triangle;
}

}  // namespace wisp
