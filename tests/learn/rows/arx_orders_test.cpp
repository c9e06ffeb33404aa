#include "learn/rows/arx_design.hpp"

#include <gtest/gtest.h>

namespace wisp::arx_orders_test {
namespace {

std::vector<int> values(const OrderMatrix& matrix) { return {matrix.values().begin(), matrix.values().end()}; }

TEST(MakeOrders, FullCouplingGivesEveryOutputEveryOther) {
  const ArxOrders orders = make_orders({.outputs = 2, .inputs = 1, .na = 4, .nb = 3, .nk = 2});
  EXPECT_EQ(values(orders.na), std::vector<int>({4, 4, 4, 4}));
  EXPECT_EQ(values(orders.nb), std::vector<int>({3, 3}));
  EXPECT_EQ(values(orders.nk), std::vector<int>({2, 2}));
}

TEST(MakeOrders, DiagonalCouplingKeepsGroupsApart) {
  const ArxOrders orders = make_orders({.outputs = 4, .na = 2, .coupling = Coupling::kDiagonal, .group = 2});
  EXPECT_EQ(values(orders.na), std::vector<int>({2, 2, 0, 0, 2, 2, 0, 0, 0, 0, 2, 2, 0, 0, 2, 2}));
}

TEST(MakeOrders, BandCouplingReachesNearestNeighbours) {
  const ArxOrders orders = make_orders({.outputs = 4, .na = 1, .coupling = Coupling::kBand});
  EXPECT_EQ(values(orders.na), std::vector<int>({1, 1, 0, 0, 1, 1, 1, 0, 0, 1, 1, 1, 0, 0, 1, 1}));
}

}  // namespace
}  // namespace wisp::arx_orders_test
