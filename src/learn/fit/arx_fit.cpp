#include "learn/fit/arx_fit.hpp"

#include <algorithm>

namespace wisp {
namespace {

constexpr int kMaxOrder = 4096;

std::string shape(int rows, int columns) { return std::to_string(rows) + " × " + std::to_string(columns); }

Result<void> check_matrix(const char* name, const OrderMatrix& matrix, int rows, int columns) {
  if (matrix.rows() != rows || matrix.columns() != columns) {
    return Error{std::string(name) + " is " + shape(matrix.rows(), matrix.columns()) + ", expected " +
                 shape(rows, columns) + ": one row an output, one column " +
                 (name[1] == 'a' ? "an output" : "an input")};
  }
  for (int order : matrix.values()) {
    if (order < 0 || order > kMaxOrder) {
      return Error{std::string(name) + " holds " + std::to_string(order) + ", expected 0 to " +
                   std::to_string(kMaxOrder)};
    }
  }
  return {};
}

}  // namespace

Result<void> check_orders(const ArxOrders& orders, const ChannelChoice& channels) {
  const auto ny = static_cast<int>(channels.outputs.size());
  const auto nu = static_cast<int>(channels.inputs.size());
  if (auto ok = check_matrix("na", orders.na, ny, ny); !ok) return ok;
  if (auto ok = check_matrix("nb", orders.nb, ny, nu); !ok) return ok;
  return check_matrix("nk", orders.nk, ny, nu);
}

Result<void> check_options(const ArxOptions& options, const ChannelChoice& channels) {
  if (auto ok = check_orders(options.orders, channels); !ok) return ok;
  if (!(options.stability_margin > 0 && options.stability_margin < 1)) {
    return Error{"the stability margin must lie between 0 and 1"};
  }
  return {};
}

Result<void> check_rows(const RowCounts& plan, const ArxDesign& design) {
  if (plan.rows == 0) {
    return Error{"no row can be predicted: the first sample is " + std::to_string(plan.first_sample) +
                 " (the longest lag), and no episode has that many rows and one more without "
                 "gaps; use lower orders or delays (na, nb, nk), or a longer recording"};
  }
  std::size_t most = 0;
  for (const SharedRows& rows : design.groups) most = std::max(most, rows.columns.size());
  if (plan.rows <= most) {
    return Error{std::to_string(most) + " coefficients an output cannot be learned from " + std::to_string(plan.rows) +
                 " rows; use lower orders (na, nb) or a longer recording"};
  }
  return {};
}

}  // namespace wisp
