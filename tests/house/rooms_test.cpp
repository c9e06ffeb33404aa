// Within a layer, too, the arrow has one direction.

#include "house/rooms.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "paths.hpp"

namespace wisp::house::rooms_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

TEST(Rooms, NoneIncludesOneThatStandsAbove) { EXPECT_THAT(climbs(WISP_SOURCE_DIR), IsEmpty()); }

TEST(Rooms, AnIncludeOfARoomBelowIsFine) {
  ScratchTree tree;
  tree.add("src/learn/flame/a.cpp", "#include \"learn/numeric/b.hpp\"\n#include \"c.hpp\"\n");
  tree.add("src/learn/flame/c.hpp", "").add("src/learn/numeric/b.hpp", "");
  EXPECT_THAT(climbs(tree.root()), IsEmpty());
}

TEST(Rooms, AnIncludeOfARoomAboveIsFoundHoweverItIsWritten) {
  ScratchTree tree;
  tree.add("src/learn/numeric/a.cpp", "#include \"learn/fit/b.hpp\"\n").add("src/learn/fit/b.hpp", "");
  tree.add("src/run/lanes/a.cpp", "#include \"../bank/b.hpp\"\n").add("src/run/bank/b.hpp", "");
  EXPECT_THAT(climbs(tree.root()), ElementsAre(Pair("learn/numeric -> learn/fit", "src/learn/numeric/a.cpp"),
                                               Pair("run/lanes -> run/bank", "src/run/lanes/a.cpp")));
}

TEST(Rooms, TwoRoomsOfOneFloorDoNotIncludeEachOther) {
  ScratchTree tree;
  tree.add("src/run/chain/a.cpp", "#include \"run/arx/b.hpp\"\n").add("src/run/arx/b.hpp", "");
  EXPECT_THAT(climbs(tree.root()), ElementsAre(Pair("run/chain -> run/arx", "src/run/chain/a.cpp")));
}

TEST(Rooms, AFolderWithoutAFloorIsFound) {
  ScratchTree tree;
  tree.add("src/learn/attic/a.cpp", "").add("src/learn/chain/gusts/b.cpp", "");
  EXPECT_THAT(climbs(tree.root()), ElementsAre(Pair("learn/attic has no floor", "src/learn/attic/a.cpp")));
}

}  // namespace
}  // namespace wisp::house::rooms_test
