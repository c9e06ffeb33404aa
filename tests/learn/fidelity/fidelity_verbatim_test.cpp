#include "learn/fidelity/fidelity_verbatim.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace wisp::fidelity_verbatim_test {
namespace {

TEST(FidelityVerbatim, ACopiedRunIsFoundWhereverItStands) {
  const std::vector real{Stretch{1, {0, 3, 1, 4, 1, 5, 9, 2, 6}}};
  const std::vector copy{Stretch{1, {7, 7, 7, 4, 1, 5, 9, 7, 7}}};
  EXPECT_EQ(longest_verbatim_run(real, copy, 0), 4u);
}

TEST(FidelityVerbatim, EveryChannelMustAgree) {
  const std::vector real{Stretch{2, {0, 0, 1, 1, 2, 2, 3, 3}}};
  const std::vector half{Stretch{2, {0, 9, 1, 9, 2, 9, 3, 9}}};
  EXPECT_EQ(longest_verbatim_run(real, half, 0), 0u);
}

TEST(FidelityVerbatim, ToleranceIsAShareOfTheStandardDeviation) {
  const std::vector real{Stretch{1, {-1, 1, -1, 1}}};
  const std::vector near{Stretch{1, {-0.95, 1.04}}};
  EXPECT_EQ(longest_verbatim_run(real, near, 0.06), 2u);
  EXPECT_EQ(longest_verbatim_run(real, near, 0.03), 0u);
}

TEST(FidelityVerbatim, ARunDoesNotCrossFromOneStretchToTheNext) {
  const std::vector real{Stretch{1, {1, 2, 3, 4}}};
  const std::vector cut{Stretch{1, {1, 2}}, Stretch{1, {3, 4}}};
  EXPECT_EQ(longest_verbatim_run(real, cut, 0), 2u);
}

}  // namespace
}  // namespace wisp::fidelity_verbatim_test
