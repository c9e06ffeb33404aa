#include "learn/arx/fit/residual_pass.hpp"

#include "learn/numeric/stream_kernels.hpp"

namespace wisp {
namespace {

class Pass {
 public:
  Pass(const Signals& signals, const ArxDesign& design, const GroupThetas& theta)
      : design_(design), theta_(theta), block_(signals, design.layout.history()) {
    residuals_.resize(signals.outputs, std::vector<double>(kBlockRows));
    products_.gram = Eigen::MatrixXd::Zero(signals.outputs, signals.outputs);
    for (const Eigen::MatrixXd& part : theta) {
      products_.gradient.push_back(Eigen::MatrixXd::Zero(part.rows(), part.cols()));
    }
    ones_.assign(kBlockRows, 1.0);
  }

  void add_block(const RowRun& rows) {
    block_.load(rows);
    for (std::size_t g = 0; g < design_.groups.size(); ++g) add_group(g);
    for (std::size_t i = 0; i < residuals_.size(); ++i) {
      series_.clear();
      for (std::size_t j = 0; j <= i; ++j) series_.push_back(residuals_[j].data());
      Eigen::VectorXd sums = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(i) + 1);
      add_products(residuals_[i].data(), series_, block_.rows(), sums.data());
      products_.gram.row(static_cast<Eigen::Index>(i)).head(sums.size()) += sums.transpose();
    }
  }

  ResidualProducts finish() {
    products_.gram.triangularView<Eigen::StrictlyUpper>() = products_.gram.transpose();
    return std::move(products_);
  }

 private:
  void add_group(std::size_t g) {
    const SharedRows& group = design_.groups[g];
    series_.clear();
    for (int column : group.columns) {
      series_.push_back(column == 0 ? ones_.data() : block_.series(design_.layout[column]));
    }
    for (std::size_t k = 0; k < group.outputs.size(); ++k) {
      const auto index = static_cast<Eigen::Index>(k);
      const Eigen::VectorXd weight = -theta_[g].col(index);
      std::vector<double>& residual = residuals_[group.outputs[k]];
      combine(block_.series({group.outputs[k], 0}), series_, {weight.data(), series_.size()}, block_.rows(),
              residual.data());
      Eigen::VectorXd sums = Eigen::VectorXd::Zero(weight.size());
      add_products(residual.data(), series_, block_.rows(), sums.data());
      products_.gradient[g].col(index) += sums;
    }
  }

  const ArxDesign& design_;
  const GroupThetas& theta_;
  ScaledBlock block_;
  std::vector<std::vector<double>> residuals_;
  std::vector<double> ones_;
  std::vector<const double*> series_;
  ResidualProducts products_;
};

}  // namespace

ResidualProducts residual_products(const Signals& signals, const RowPlan& plan, const ArxDesign& design,
                                   const GroupThetas& theta) {
  Pass pass(signals, design, theta);
  for_each_block(plan, [&](const RowRun& rows) { pass.add_block(rows); });
  return pass.finish();
}

}  // namespace wisp
