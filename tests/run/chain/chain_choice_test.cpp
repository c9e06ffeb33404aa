#include "run/chain/chain_choice.hpp"

#include <gtest/gtest.h>

#include <array>

namespace wisp::chain_choice_test {
namespace {

TEST(ChainChoice, OfModesThatAreAsLikelyTheFirstIsTaken) {
  std::array<std::uint32_t, 4> threshold{0x20000000U, 0x80000000U, 0xe0000000U, 0xffffffffU};
  ChainProgram program;
  program.modes = 4;
  program.threshold = threshold;
  ChainChoice choice;
  choice.set_chance(false);
  EXPECT_EQ(choice.mode(program, 0, {}), 1U);
}

TEST(ChainChoice, AModeWithoutProbabilityIsNeverDrawn) {
  std::array<std::uint32_t, 2> threshold{0xffffffffU, 0xffffffffU};
  ChainProgram program;
  program.modes = 2;
  program.threshold = threshold;
  EXPECT_EQ(ChainChoice().mode(program, 0, {0xffffffffU, 0}), 0U);
}

}  // namespace
}  // namespace wisp::chain_choice_test
