#include "learn/rows/lag_gram.hpp"

#include <Eigen/QR>

#include "learn/numeric/stream_kernels.hpp"

namespace wisp {
namespace {

// A column, and the columns whose products with it are summed over all rows.
struct Products {
  int column = 0;
  std::vector<int> with;
};

class GramBuilder {
 public:
  GramBuilder(const Signals& signals, const LagLayout& layout, const ChannelPairs& wanted)
      : layout_(layout),
        block_(signals, layout.history()),
        before_(layout.size()),
        ends_(layout.size(), layout.size()) {
    for (int p = 0; p < layout.size(); ++p) before_[p] = layout.find({layout[p].channel, layout[p].lag - 1});
    for (int p = 1; p < layout.size(); ++p) {
      Products products{p, {}};
      for (int q = p; q < layout.size(); ++q) {
        if (wanted(layout[p].channel, layout[q].channel) && (before_[p] < 0 || before_[q] < 0))
          products.with.push_back(q);
      }
      if (!products.with.empty()) products_.push_back(std::move(products));
    }
    sums_ = Eigen::MatrixXd::Zero(layout.size(), layout.size());
    ends_.setZero();
  }

  void add_block(const RowRun& rows) {
    block_.load(rows);
    for (const Products& products : products_) {
      series_.clear();
      for (int q : products.with) series_.push_back(block_.series(layout_[q]));
      totals_.assign(products.with.size(), 0.0);
      add_products(block_.series(layout_[products.column]), series_, block_.rows(), totals_.data());
      for (std::size_t k = 0; k < totals_.size(); ++k) sums_(products.column, products.with[k]) += totals_[k];
    }
    for (int p = 1; p < layout_.size(); ++p) {
      if (before_[p] < 0) sums_(0, p) += sum(block_.series(layout_[p]));
    }
    sums_(0, 0) += static_cast<double>(block_.rows());
  }

  /// Adds the end corrections of a run: a sum of products at lags l and l′ is the sum at l − 1 and l′ − 1, plus the
  /// product in row run.begin, minus the product in row run.end.
  void add_ends(const RowRun& run) {
    block_.load({run.recording, run.begin, run.begin});
    ends_.selfadjointView<Eigen::Upper>().rankUpdate(row_at_load(), 1.0);
    block_.load({run.recording, run.end, run.end});
    ends_.selfadjointView<Eigen::Upper>().rankUpdate(row_at_load(), -1.0);
  }

  Eigen::MatrixXd finish() {
    for (int q = 1; q < layout_.size(); ++q) {
      if (before_[q] >= 0) sums_(0, q) = sums_(0, before_[q]) + ends_(0, q);
      for (int p = 1; p <= q; ++p) {
        if (before_[p] >= 0 && before_[q] >= 0) sums_(p, q) = sums_(before_[p], before_[q]) + ends_(p, q);
      }
    }
    sums_.triangularView<Eigen::StrictlyLower>() = sums_.transpose();
    return std::move(sums_);
  }

 private:
  double sum(const double* series) const { return Eigen::Map<const Eigen::VectorXd>(series, size()).sum(); }
  Eigen::Index size() const { return static_cast<Eigen::Index>(block_.rows()); }

  // Values of all columns in the row after the (empty) loaded block; 0 at lag 0, which needs no correction.
  Eigen::VectorXd row_at_load() const {
    Eigen::VectorXd row(layout_.size());
    row[0] = 1;
    for (int p = 1; p < layout_.size(); ++p) row[p] = layout_[p].lag == 0 ? 0.0 : *block_.series(layout_[p]);
    return row;
  }

  const LagLayout& layout_;
  ScaledBlock block_;
  std::vector<int> before_;  // index of the column one lag shorter, or −1
  std::vector<Products> products_;
  std::vector<const double*> series_;
  std::vector<double> totals_;
  Eigen::MatrixXd sums_;
  Eigen::MatrixXd ends_;
};

}  // namespace

Eigen::MatrixXd lag_gram(const Signals& signals, const RowPlan& plan, const LagLayout& layout,
                         const ChannelPairs& wanted) {
  GramBuilder builder(signals, layout, wanted);
  for_each_block(plan, [&](const RowRun& rows) { builder.add_block(rows); });
  for (const RowRun& run : plan.runs) builder.add_ends(run);
  return builder.finish();
}

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
