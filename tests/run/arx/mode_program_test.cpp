#include "run/arx/mode_lanes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "model/sample_switched.hpp"

namespace wisp::mode_program_test {
namespace {

// No word leads to a mode whose probability is 0, however sums of probabilities are rounded.
TEST(ModeProgram, TheLastModeThatCanFollowTakesAllWordsThatAreLeft) {
  Model model = sample_switched();
  auto& switched = std::get<SwitchedArxModel>(model.dynamics);
  switched.transitions = {0.25, 0.75, 0, 0, 0.5, 0.5, 1, 0, 0};
  Arena measured;
  make_mode_program(switched, measured);
  std::vector<std::byte> memory(measured.bytes());
  Arena arena(memory);
  const ModeProgram program = make_mode_program(switched, arena);
  constexpr std::uint32_t kQuarter = 0x40000000U, kHalf = 0x80000000U;
  EXPECT_THAT(program.thresholds, testing::ElementsAre(kQuarter, kAnyWord, kAnyWord, 0U, kHalf, kAnyWord, kAnyWord,
                                                       kAnyWord, kAnyWord, 0U, kHalf, kAnyWord));
}

}  // namespace
}  // namespace wisp::mode_program_test
