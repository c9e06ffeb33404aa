// What a recording says of itself: roles and verdict.

#include "wisp/record/recording.hpp"

#include <gmock/gmock.h>

#include <vector>

#include "record/verdict.hpp"

namespace wisp {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Recording two_outputs() {
  return {"film.csv", 30, {{"u", "", Role::kInput, {1}}, {"y", "", Role::kOutput, {2}}, {"z", "", Role::kOutput, {3}}}};
}

TEST(Recording, ChannelsAreFoundByTheirRole) {
  EXPECT_THAT(channels_with_role(two_outputs(), Role::kInput), ElementsAre(0));
  EXPECT_THAT(channels_with_role(two_outputs(), Role::kOutput), ElementsAre(1, 2));
  EXPECT_THAT(channels_with_role(two_outputs(), Role::kMotion), ElementsAre());
}

TEST(Recording, SaysWhetherItsCaptureWasUsable) {
  Recording recording = two_outputs();
  EXPECT_FALSE(verdict_of(recording)) << "nothing captured it";
  EXPECT_FALSE(refused_by_capture({&recording, 1}));
  set_verdict(recording, true, "a flame");
  ASSERT_TRUE(verdict_of(recording));
  EXPECT_TRUE(verdict_of(recording)->usable);
  EXPECT_FALSE(refused_by_capture({&recording, 1}));
  set_verdict(recording, false, "no flame");
  EXPECT_EQ(recording.attributes.size(), 2u) << "the verdict before is gone";
  ASSERT_TRUE(refused_by_capture({&recording, 1}));
  EXPECT_THAT(*refused_by_capture({&recording, 1}), HasSubstr("film.csv was captured as not usable: no flame"));
}

}  // namespace
}  // namespace wisp
