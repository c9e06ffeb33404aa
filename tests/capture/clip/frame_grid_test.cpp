#include "capture/clip/frame_grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace wisp::frame_grid_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::int64_t> places(FrameGrid& grid, const std::vector<double>& times) {
  std::vector<std::int64_t> out;
  for (const double time : times) out.push_back(grid.place(time));
  return out;
}

TEST(FrameGrid, BeginsWithTheFirstFrameWhateverItsTime) {
  FrameGrid grid(50);
  EXPECT_EQ(grid.last(), -1);
  EXPECT_THAT(places(grid, {7.3, 7.32, 7.34}), ElementsAre(0, 1, 2));
  EXPECT_THAT(grid.warnings("clip"), IsEmpty());
}

TEST(FrameGrid, LeavesThePlacesOfLostFramesEmpty) {
  FrameGrid grid(50);
  EXPECT_THAT(places(grid, {0, 0.02, 0.1, 0.12}), ElementsAre(0, 1, 5, 6));
}

TEST(FrameGrid, PutsFramesThatComeTooCloseInThePlacesAfterThem) {
  FrameGrid grid(50);
  EXPECT_THAT(places(grid, {0, 0.001, 0.002, 0.04}), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(grid.warnings("clip"), ElementsAre(AllOf(HasSubstr("clip: frames come at irregular times"),
                                                       HasSubstr("; only outlines are interpolated"))));
}

TEST(FrameGrid, BearsTheJitterOfACamera) {
  FrameGrid grid(30);
  EXPECT_THAT(places(grid, {0, 0.043, 0.061, 0.108, 0.125}), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(grid.warnings("clip"), IsEmpty());
}

TEST(FrameGrid, ShortensAHoleOfMoreThanTwoSeconds) {
  FrameGrid grid(10);
  EXPECT_THAT(places(grid, {0, 0.1, 60, 60.1}), ElementsAre(0, 1, 22, 23));
  EXPECT_THAT(grid.warnings("clip"), ElementsAre("clip: 1 holes in time were shortened"));
  EXPECT_NEAR(grid.removed(), 60 - 2.2, 1e-9);
}

TEST(FrameGrid, FollowsWhereATimeIsNotKnown) {
  FrameGrid grid(10);
  EXPECT_EQ(grid.follow(), 0);
  EXPECT_EQ(grid.follow(), 1);
}

}  // namespace
}  // namespace wisp::frame_grid_test
