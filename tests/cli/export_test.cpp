// `wisp export`: what is written, and what cannot be.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "cli/program.hpp"
#include "model/sample_chain.hpp"
#include "wisp/model/file.hpp"

namespace wisp::export_test {
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
    const std::string height = name == "a.glb" ? "" : name == "a.png" ? " --size 128 --columns 4" : " --size 48";
    const std::string arguments = "export " + kFlame + " --loop 0.5" + height + " -o ";
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

TEST_F(Export, AnAtlasIsSixtyFourFramesInASquareUnlessAskedOtherwise) {
  const auto meta_of = [&](const std::string& flags) {
    EXPECT_EQ(wisp("export " + kFlame + " --loop 2" + flags + " -o " + at("a.png")).status, 0) << flags;
    return nlohmann::json::parse(file_text(at("a.atlas.json")));
  };
  const auto usual = meta_of("");
  EXPECT_EQ(usual["frames"].size(), 64u);
  EXPECT_EQ(usual["meta"]["size"]["w"], 1024);
  EXPECT_EQ(usual["meta"]["size"]["h"], 1024);
  EXPECT_EQ(usual["meta"]["rate_hz"], 32);
  const auto asked = meta_of(" --frames 20 --columns 5 --size 320");
  EXPECT_EQ(asked["frames"].size(), 20u);
  EXPECT_EQ(asked["frames"][0]["frame"]["w"], 64);
  EXPECT_EQ(asked["meta"]["rows"], 4);
}

// A blow that puts the flame out: it burns in the first frame, and nothing is left in the last.
TEST_F(Export, AScheduleOfWindBlowsTheFlameOut) {
  std::ofstream table(at("blow.csv"));
  const Model model = *read_model(kFlame);
  for (std::size_t k = 0; k < model.inputs.size(); ++k) table << (k > 0 ? "," : "") << model.inputs[k].name;
  for (int row = 0; row < 180; ++row) {
    table << "\n";
    for (std::size_t k = 0; k < model.inputs.size(); ++k) table << (k > 0 ? "," : "") << (row < 30 ? 0 : 9);
  }
  table << "\n";
  table.close();
  const Said said =
      wisp("export " + kFlame + " --input " + at("blow.csv") + " --size 48 -o " + at("a.apng") + " --json");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(said.json()["frames"], 180);
  const std::string ffmpeg = "ffmpeg -v error -i " + at("a.apng") + " -f rawvideo -pix_fmt rgba " + at("raw");
  ASSERT_EQ(std::system(ffmpeg.c_str()), 0);
  const std::string pixels = file_text(at("raw"));
  const std::size_t frame = pixels.size() / 180;
  const auto brightest = [&](std::size_t k) {
    int most = 0;
    for (std::size_t at = 3; at < frame; at += 4)
      most = std::max<int>(most, static_cast<unsigned char>(pixels[k * frame + at]));
    return most;
  };
  EXPECT_GT(brightest(0), 200);
  EXPECT_LT(brightest(179), 40);
}

TEST_F(Export, AVertexTextureHoldsEveryFramesOutline) {
  const Said said = wisp("export " + kFlame + " --loop 1 -o " + at("a.vat.png") + " --json");
  ASSERT_EQ(said.status, 0) << said.err;
  const auto meta = nlohmann::json::parse(file_text(at("a.vat.json")));
  EXPECT_EQ(meta["points"], 144);
  EXPECT_EQ(meta["frames"], 60);
  EXPECT_EQ(meta["loop"], true);
  EXPECT_EQ(meta["triangles"].size(), 852u);
  const std::string ffmpeg = "ffmpeg -v error -i " + at("a.vat.png") + " -f rawvideo -pix_fmt rgb24 " + at("raw");
  ASSERT_EQ(std::system(ffmpeg.c_str()), 0);
  EXPECT_EQ(file_text(at("raw")).size(), 144u * 120 * 3);
  EXPECT_EQ(wisp("export " + kLeaf + " --loop 3 -o " + at("b.vat.png")).status, 0);
}

TEST_F(Export, ALeafsRoundSaysHowFarItLeads) {
  const Said said = wisp("export " + kLeaf + " --loop 3 -o " + at("a.glb") + " --json");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_LT(said.json()["travel"][0][2].get<double>(), -1);
}

TEST_F(Export, APictureOfAFlameEndsInNothing) {
  ASSERT_EQ(wisp("export " + kFlame + " --seconds 0.1 --size 64 -o " + at("a.apng")).status, 0);
  const std::string ffprobe =
      "ffprobe -v error -show_entries stream=width -of csv=p=0 " + at("a.apng") + " >" + at("width");
  ASSERT_EQ(std::system(ffprobe.c_str()), 0);
  const std::string ffmpeg =
      "ffmpeg -v error -i " + at("a.apng") + " -frames:v 1 -f rawvideo -pix_fmt rgba " + at("raw");
  ASSERT_EQ(std::system(ffmpeg.c_str()), 0);
  const std::size_t width = std::stoul(file_text(at("width")));
  const std::string pixels = file_text(at("raw"));
  ASSERT_EQ(pixels.size(), width * 64 * 4);
  int edge = 0, middle = 0;
  for (std::size_t k = 0; k < width * 64; ++k) {
    const std::size_t x = k % width, y = k / width;
    int& brightest = x == 0 || y == 0 || x + 1 == width || y == 63 ? edge : middle;
    brightest = std::max(brightest, static_cast<int>(static_cast<unsigned char>(pixels[4 * k + 3])));
  }
  EXPECT_EQ(edge, 0);
  EXPECT_GT(middle, 200);
}

TEST_F(Export, AFlagThatWouldDoNothingIsWrongUsage) {
  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const Said said = wisp("export " + arguments);
    EXPECT_EQ(said.status, 2) << arguments;
    EXPECT_THAT(said.err, HasSubstr(words)) << arguments;
  };
  refused(kFlame + " --loop 2 -o " + at("a.c"), "--loop does nothing to a .c file");
  refused(kFlame + " --size 99 -o " + at("a.glb"), "--size does nothing to a .glb file");
  refused(kFlame + " --columns 9 -o " + at("a.webm"), "--columns does nothing to a .webm file");
  refused(kFlame + " --instances 2 -o " + at("a.json"), "--instances does nothing to a .json file");
  ASSERT_TRUE(write_model(at("calm.wisp"), sample_chain()));
  refused(at("calm.wisp") + " --wind 1 -o " + at("a.glb"), "has none");
  refused(kFlame + " --input wind.csv --wind 1 -o " + at("a.glb"), "--wind is constant, and --input is not");
  refused(kFlame + " --input wind.csv --loop 1 -o " + at("a.glb"), "--loop does not go with --input");
  refused(at("calm.wisp") + " --input wind.csv -o " + at("a.glb"), "--input drives a model's inputs");
  EXPECT_FALSE(fs::exists(at("a.c")) || fs::exists(at("a.glb")) || fs::exists(at("a.json")));
}

TEST_F(Export, WhatCannotBeWrittenIsOneSentenceAndNoFile) {
  expect_error(kFlame + " -o " + at("a.fbx"),
               "expected a name that ends in .glb, .json, .png, .apng, .webm, .c, .m or .py");
  expect_error(kFlame + " -o " + at("a.m"), "the model is no plant");
  expect_error(kLeaf + " -o " + at("a.json"), "a body's motion goes into a .glb");
  expect_error(kLeaf + " -o " + at("a.png"), "no flame to draw");
  expect_error(kFlame + " --seconds 0 -o " + at("a.glb"), "expected above 0");
  expect_error(kFlame + " --size 40 -o " + at("a.png"), "expected 16 to 2048");
  expect_error(kFlame + " --loop 1 --frames 0 -o " + at("a.png"), "--frames is 0, expected at least 1");
  expect_error(kFlame + " --instances 5000 -o " + at("a.glb"), "expected 1 to 1000");
  expect_error(kFlame + " --wind 9 --seconds 2 -o " + at("a.glb"), "goes out");
  expect_error(at("none.wisp") + " -o " + at("a.glb"), "cannot be opened");
  EXPECT_FALSE(fs::exists(at("a.glb")) || fs::exists(at("a.png")) || fs::exists(at("a.json")));
}

}  // namespace
}  // namespace wisp::export_test
