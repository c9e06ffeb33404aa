// `wisp export`: what is written, and what cannot be.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/program.hpp"

namespace wisp {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

const std::string kModels = WISP_SOURCE_DIR "/apps/web/public/models/";
const std::string kFlame = kModels + "flame-2.wisp", kLeaf = kModels + "leaf.wisp";

class Export : public InFolder {
 protected:
  void expect_error(const std::string& arguments, const std::string& words) {
    const Said said = wisp("export " + arguments);
    EXPECT_EQ(said.status, 1) << arguments;
    EXPECT_THAT(said.err, HasSubstr(words)) << arguments;
    EXPECT_EQ(std::count(said.err.begin(), said.err.end(), '\n'), 1) << said.err;
  }
};

TEST_F(Export, WritesEveryKindAndTheSameBytesAgain) {
  for (const std::string name : {"a.glb", "a.json", "a.png", "a.apng", "a.webm"}) {
    const std::string arguments = "export " + kFlame + " --loop 0.5 --height 48 -o ";
    const Said said = wisp(arguments + at(name) + " --json");
    ASSERT_EQ(said.status, 0) << said.err;
    EXPECT_EQ(said.json()["frames"], 30);
    EXPECT_EQ(said.json()["loop"], true);
    fs::create_directory(folder_ / "again");
    ASSERT_EQ(wisp(arguments + at("again/" + name)).status, 0);
    const bool same = file_text(at(name)) == file_text(at("again/" + name));
    EXPECT_TRUE(same || name == "a.webm") << name;  // Matroska files carry a random number
  }
  EXPECT_TRUE(fs::exists(at("a.atlas.json")));
}

TEST_F(Export, ALeafsRoundSaysHowFarItLeads) {
  const Said said = wisp("export " + kLeaf + " --loop 3 -o " + at("a.glb") + " --json");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_LT(said.json()["travel"][0][2].get<double>(), -1);
}

TEST_F(Export, WhatCannotBeWrittenIsOneSentenceAndNoFile) {
  expect_error(kFlame + " -o " + at("a.fbx"), "expected a name that ends in .glb, .json, .png, .apng, .webm or .c");
  expect_error(kLeaf + " -o " + at("a.json"), "a body's motion goes into a .glb");
  expect_error(kLeaf + " -o " + at("a.png"), "no flame to draw");
  expect_error(kFlame + " --seconds 0 -o " + at("a.glb"), "expected above 0");
  expect_error(kFlame + " --height 4 -o " + at("a.png"), "expected 16 to 2048");
  expect_error(kFlame + " --instances 5000 -o " + at("a.glb"), "expected 1 to 1000");
  expect_error(kFlame + " --wind 9 --seconds 2 -o " + at("a.glb"), "goes out");
  expect_error(at("none.wisp") + " -o " + at("a.glb"), "cannot be opened");
  EXPECT_FALSE(fs::exists(at("a.glb")) || fs::exists(at("a.png")) || fs::exists(at("a.json")));
}

}  // namespace
}  // namespace wisp
