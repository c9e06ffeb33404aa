#include "run/chain/systems_program.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "model/sample_chain.hpp"

namespace wisp::systems_program_test {
namespace {

TEST(SystemsProgram, HoldsAllOfEachMode) {
  ModeSystems systems = *std::get<ChainModel>(system_chain(2).dynamics).systems;
  for (int more = 0; more < 3; ++more) systems.modes.push_back(systems.modes[static_cast<std::size_t>(more)]);
  Arena measured;
  make_systems_program(systems, measured);
  std::vector<std::byte> memory(measured.bytes());
  Arena arena(memory);
  const SystemsProgram program = make_systems_program(systems, arena);
  const std::size_t terms = system_terms(2);
  ASSERT_EQ(program.coefficient.size(), 5 * kSystemStates * terms);
  ASSERT_EQ(program.noise.size(), 5 * kSystemStates * kSystemStates);
  ASSERT_EQ(program.range.size(), 5 * kSystemStates * 2);
  ASSERT_EQ(program.steps.size(), 5 * kSystemDurations);
  for (std::size_t mode = 0; mode < 5; ++mode) {
    const ModeSystem& one = systems.modes[mode];
    for (std::size_t k = 0; k < kSystemStates; ++k) {
      const std::size_t at = mode * kSystemStates + k;
      EXPECT_EQ(program.coefficient[at * terms + 3], static_cast<float>(one.coefficient[k * terms + 3]));
      EXPECT_EQ(program.noise[at * kSystemStates + k], static_cast<float>(one.noise[k * kSystemStates + k]));
      EXPECT_EQ(program.range[2 * at], static_cast<float>(one.lowest[k]));
      EXPECT_EQ(program.range[2 * at + 1], static_cast<float>(one.highest[k]));
    }
    for (std::size_t k = 0; k < kSystemDurations; ++k) {
      EXPECT_EQ(program.steps[mode * kSystemDurations + k], one.steps[k]);
    }
  }
}

}  // namespace
}  // namespace wisp::systems_program_test
