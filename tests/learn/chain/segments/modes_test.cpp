#include "learn/chain/segments/modes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace wisp::chain::modes_test {
namespace {

// What follows mode b after mode a.
std::vector<double> after(const ModeChain& chain, std::size_t a, std::size_t b) {
  const std::size_t modes = chain.initial.size();
  const auto row = chain.probabilities.begin() + static_cast<long>((modes * (1 + a) + b) * modes);
  return {row, row + static_cast<long>(modes)};
}

TEST(ModeChain, ProbabilitiesAreCounts) {
  const ModeChain chain = counted_chain({{0, 1, 0, 1, 1}, {1, 0}}, 2, 1);
  EXPECT_EQ(chain.initial, (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(chain.probabilities, (std::vector<double>{0, 1, 2.0 / 3, 1.0 / 3}));
}

TEST(ModeChain, PairsCountWhatFollowedThem) {
  const ModeChain chain = counted_chain({{0, 1, 0, 1, 1}, {1, 0}}, 2, 2);
  EXPECT_EQ(after(chain, 0, 1), (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(after(chain, 1, 0), (std::vector<double>{0, 1}));
}

TEST(ModeChain, PairsThatWereNeverFollowedGoOnAsTheirLastMode) {
  const ModeChain chain = counted_chain({{0, 1, 0, 1, 1}, {1, 0}}, 2, 2);
  EXPECT_EQ(after(chain, 0, 0), (std::vector<double>{0, 1}));
  EXPECT_EQ(after(chain, 1, 1), (std::vector<double>{2.0 / 3, 1.0 / 3}));
}

TEST(ModeChain, AModeThatOnlyEndsRecordingsGoesOnAsModesDoOnTheWhole) {
  const ModeChain chain = counted_chain({{0, 1}, {0, 1}}, 2, 1);
  EXPECT_EQ(chain.probabilities, (std::vector<double>{0, 1, 0.5, 0.5}));
}

TEST(ModeChain, LikelihoodIsTheMeanLogarithmOfATransition) {
  const ModeChain chain = counted_chain({{0, 1}, {0, 0}}, 2, 1);
  EXPECT_NEAR(log_likelihood(chain, {{0, 1}, {0, 0}}), std::log(0.5), 1e-12);
  EXPECT_TRUE(std::isnan(log_likelihood(chain, {{0}, {1}})));
}

}  // namespace
}  // namespace wisp::chain::modes_test
