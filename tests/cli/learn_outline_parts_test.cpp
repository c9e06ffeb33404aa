// `wisp learn flame --partial` and `--merge`: a flame's fit in parts.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/program.hpp"
#include "learn/outline/made_outline.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::learn_outline_parts_test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class LearnFlameParts : public InFolder {
 protected:
  void SetUp() override {
    for (std::uint64_t seed : {1U, 2U, 3U}) {
      const made::OutlineRecipe recipe{.rows = 700, .wind = true, .seed = seed};
      ASSERT_TRUE(write_csv(at(name(seed)), made::outline_recording(recipe)));
    }
    fs::create_directory(at("whole"));
    fs::create_directory(at("merged"));
  }

  static std::string name(std::uint64_t seed) { return "rec" + std::to_string(seed) + ".csv"; }
  std::string all() const { return at("rec1.csv") + " " + at("rec2.csv") + " " + at("rec3.csv"); }

  void write_part(int k, int count) {
    const std::string share = std::to_string(k) + "/" + std::to_string(count);
    const Said said = wisp("learn flame " + all() + " --part " + share + " --partial " + part(k));
    ASSERT_EQ(said.status, 0) << said.err;
  }

  std::string part(int k) const { return at(std::to_string(k) + ".part"); }

  void expect_refused(const std::string& parts, const std::string& word) {
    const Said said = wisp("learn flame --merge " + parts + " -o " + at("m.wisp"));
    EXPECT_EQ(said.status, 1) << parts;
    EXPECT_THAT(said.err, HasSubstr(word));
    EXPECT_FALSE(fs::exists(at("m.wisp"))) << parts;
  }
};

TEST_F(LearnFlameParts, HoweverTheRecordingsAreSharedTheModelIsTheSameToTheByte) {
  ASSERT_EQ(wisp("learn flame " + all() + " --light -o " + at("whole/f.wisp")).status, 0);
  for (int count : {1, 2, 3}) {
    std::string parts;
    for (int k = 1; k <= count; ++k) {
      write_part(k, count);
      parts = part(k) + " " + parts;  // the last first
    }
    const Said said = wisp("learn flame --merge " + parts + "--expect " + std::to_string(count) + " --light -o " +
                           at("merged/f.wisp"));
    ASSERT_EQ(said.status, 0) << said.err;
    EXPECT_EQ(file_text(at("merged/f.wisp")), file_text(at("whole/f.wisp"))) << count;
  }
}

TEST_F(LearnFlameParts, PartsAreMergedIntoAPart) {
  for (int k : {1, 2, 3}) write_part(k, 3);
  ASSERT_EQ(wisp("learn flame --merge " + part(3) + " " + part(1) + " --partial " + at("13.part")).status, 0);
  const Said said = wisp("learn flame --merge " + at("13.part") + " " + part(2) + " --expect 3 -o " + at("m.wisp"));
  EXPECT_EQ(said.status, 0) << said.err;
}

TEST_F(LearnFlameParts, WhatIsMissingOrThereTwiceIsRefused) {
  for (int k : {1, 2, 3}) write_part(k, 3);
  expect_refused(part(1) + " " + part(3), "share 2/3 of the recordings is in no part");
  expect_refused(part(1) + " " + part(2) + " " + part(1), "share 1/3 is in both");
  expect_refused(part(1) + " " + part(2) + " --expect 3", "found 2 parts, expected 3");
  ASSERT_EQ(wisp("learn flame " + all() + " --part 2/2 --partial " + at("other.part")).status, 0);
  expect_refused(part(1) + " " + at("other.part"), "expected shares of one count");
  ASSERT_EQ(wisp("learn flame " + at("rec2.csv") + " --partial " + at("own.part")).status, 0);
  expect_refused(part(1) + " " + part(2) + " " + part(3) + " " + at("own.part"), "are the same recording");
}

TEST_F(LearnFlameParts, AnythingElseThanAPartIsRefused) {
  write_part(1, 1);
  const std::string text = file_text(part(1));
  const auto write = [&](const std::string& bytes) { std::ofstream(at("bad.part"), std::ios::binary) << bytes; };
  for (const std::size_t kept : {text.size() - 1, text.size() / 2, std::size_t{25}}) {
    write(text.substr(0, kept));
    expect_refused(at("bad.part"), "cut short or was changed");
  }
  std::string changed = text;
  changed[text.size() / 3] ^= 1;
  write(changed);
  expect_refused(at("bad.part"), "cut short or was changed");
  write("wisp-outline-part 7\n");
  expect_refused(at("bad.part"), "another version");
  expect_refused(at("rec1.csv"), "is not a part of an outline's fit");
}

TEST_F(LearnFlameParts, APartTakesWholeRecordings) {
  const Said said = wisp("learn flame " + at("rec1.csv") + " --part 1/2 --partial " + part(1));
  EXPECT_EQ(said.status, 2);
  EXPECT_THAT(said.err, HasSubstr("--part 1/2 of 1 recording"));
  EXPECT_FALSE(fs::exists(part(1)));
}

}  // namespace
}  // namespace wisp::learn_outline_parts_test
