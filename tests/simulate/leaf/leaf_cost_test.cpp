// What the leaf's equations cost.

#include "simulate/leaf/leaf_cost.hpp"

#include <gtest/gtest.h>

namespace wisp::leaf_cost_test {
namespace {

TEST(LeafCost, OfAnEvaluationIsAFewHundredOperations) {
  const LeafCost cost = count_leaf_operations({}, LeafMethod::kRalston);
  // By hand: the rotation 36, its three uses 45, turning the attitude 28, four cross products 36, and about a hundred
  // for forces, torques and sums.
  EXPECT_GT(cost.evaluation, 200);
  EXPECT_LT(cost.evaluation, 300);
}

TEST(LeafCost, OfAStepIsItsEvaluationsAndALittle) {
  const struct {
    LeafMethod method;
    int evaluations, sums;
  } table[] = {{LeafMethod::kMidpoint, 2, 2}, {LeafMethod::kRalston, 3, 5}, {LeafMethod::kClassical, 4, 7}};
  for (const auto& row : table) {
    const LeafCost cost = count_leaf_operations({}, row.method);
    // A sum of states is 13 products and 13 additions; bringing the attitude to length 1 takes 13.
    const long long beside = cost.step - row.evaluations * cost.evaluation - row.sums * 26 - 13;
    EXPECT_GE(beside, 0);
    EXPECT_LE(beside, 10);
  }
}

}  // namespace
}  // namespace wisp::leaf_cost_test
