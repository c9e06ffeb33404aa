#include "run/state/arena.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace wisp::arena_test {
namespace {

TEST(Arena, AnArrayTakesWholeCacheLinesAndNoMore) {
  for (const auto& [count, bytes] :
       std::vector<std::pair<std::size_t, std::size_t>>{{0, 0}, {1, 64}, {16, 64}, {17, 128}}) {
    Arena measured;
    measured.take<float>(count);
    EXPECT_EQ(measured.bytes(), bytes + kArenaAlignment);  // what a start that is not aligned may cost
    std::vector<std::byte> memory(measured.bytes());
    Arena arena(memory);
    EXPECT_EQ(arena.take<float>(count).size(), count);
    EXPECT_LE(arena.bytes(), measured.bytes());
  }
}

}  // namespace
}  // namespace wisp::arena_test
