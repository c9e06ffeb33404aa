#include "wisp/wisp.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <thread>
#include <vector>

#include "c/frames_in_c.h"
#include "c/life_in_c.h"
#include "c/live_in_c.h"
#include "model/sample_chain.hpp"
#include "paths.hpp"
#include "run/flame_model.hpp"
#include "wisp/base/file.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/cost.hpp"

namespace wisp::wisp_test {
namespace {

std::vector<std::byte> flame_bytes() { return std::move(model_bytes(flame_model())).value(); }

std::string text(const char* wrong) { return wrong ? std::string(wrong) + " · " + wisp_last_error() : ""; }

TEST(C, AWholeLifeIsTheOneThatCppHas) {
  Model learned = flame_model();
  const Cost counted = count_operations(learned).value();
  learned.training.multiply_adds_per_frame = counted.multiply_adds_per_frame;
  learned.training.operations_per_frame = counted.operations_per_frame;
  const std::vector<std::byte> bytes = model_bytes(learned).value();
  std::vector<float> from_c(16), from_cpp(16);
  ASSERT_EQ(text(whole_life(bytes.data(), bytes.size(), from_c.data())), "");
  auto bank = Bank::create(flame_model(), {.capacity = 1, .seed = 3});
  ASSERT_TRUE(bank);
  const InstanceId id = bank->spawn();
  bank->set_inputs(id, std::vector<float>{0.5f});
  for (int step = 0; step < 50; ++step) bank->step();
  bank->outputs(id, from_cpp);
  EXPECT_EQ(from_c, from_cpp);
}

TEST(C, ABankLivesInMemoryThatTheCallerGives) {
  const std::vector<std::byte> bytes = flame_bytes();
  EXPECT_EQ(text(life_in_given_memory(bytes.data(), bytes.size())), "");
}

TEST(C, EveryMisuseHasItsStatusAndItsSentence) {
  const std::vector<std::byte> bytes = flame_bytes();
  EXPECT_EQ(text(misuse(bytes.data(), bytes.size())), "");
}

TEST(C, StructsOfOlderAndNewerCallersWork) {
  const std::vector<std::byte> bytes = flame_bytes();
  EXPECT_EQ(text(structs_of_other_sizes(bytes.data(), bytes.size())), "");
}

TEST(C, AFlameGoesOutStaysOutAndIsLitAgain) {
  Model mortal = flame_model();
  mortal.extinction.emplace();
  const std::vector<std::byte> bytes = *model_bytes(mortal);
  EXPECT_EQ(text(death_in_c(bytes.data(), bytes.size())), "");
}

TEST(C, EachThreadHasItsOwnLastError) {
  wisp_model* model = nullptr;
  ASSERT_EQ(wisp_model_load("x", 1, &model), WISP_BAD_DATA);
  const std::string here = wisp_last_error();
  std::string there = "not asked";
  std::thread([&] { there = wisp_last_error(); }).join();
  EXPECT_EQ(there, "");
  EXPECT_NE(here, "");
}

TEST(C, AModelWithoutAnOutlineSaysSo) {
  Model plain = flame_model();
  plain.view = PlainView{};
  const std::vector<std::byte> bytes = *model_bytes(plain);
  wisp_model* model = nullptr;
  wisp_bank* bank = nullptr;
  ASSERT_EQ(wisp_model_load(bytes.data(), bytes.size(), &model), WISP_OK);
  ASSERT_EQ(wisp_bank_create(model, nullptr, &bank), WISP_OK);
  wisp_instance instance = WISP_NO_INSTANCE;
  ASSERT_EQ(wisp_bank_spawn(bank, &instance), WISP_OK);
  float values[2] = {};
  EXPECT_EQ(wisp_bank_polyline(bank, instance, values, 0), WISP_BAD_ARGUMENT);
  EXPECT_STREQ(wisp_last_error(), "wisp_bank_polyline: the model's outputs are not an outline");
  wisp_bank_free(bank);
  wisp_model_free(model);
}

// A flame that never goes out is no chain either.
TEST(C, WhatAModelDoesNotHaveIsABadArgument) {
  const std::vector<std::byte> bytes = flame_bytes();
  wisp_model* model = nullptr;
  wisp_bank* bank = nullptr;
  ASSERT_EQ(wisp_model_load(bytes.data(), bytes.size(), &model), WISP_OK);
  ASSERT_EQ(wisp_bank_create(model, nullptr, &bank), WISP_OK);
  wisp_instance instance = WISP_NO_INSTANCE;
  ASSERT_EQ(wisp_bank_spawn(bank, &instance), WISP_OK);
  EXPECT_EQ(wisp_bank_extinguish(bank, instance), WISP_BAD_ARGUMENT);
  EXPECT_STREQ(wisp_last_error(), "wisp_bank_extinguish: the model has no rule of extinction");
  EXPECT_EQ(wisp_bank_relight(bank, instance), WISP_BAD_ARGUMENT);
  EXPECT_EQ(wisp_bank_set_ground(bank, 0), WISP_BAD_ARGUMENT);
  EXPECT_STREQ(wisp_last_error(), "wisp_bank_set_ground: the model's dynamics are not a chain");
  EXPECT_EQ(wisp_bank_clear_ground(bank), WISP_BAD_ARGUMENT);
  wisp_chain_settings settings{};
  settings.size = sizeof settings;
  EXPECT_EQ(wisp_bank_get_chain_settings(bank, &settings), WISP_BAD_ARGUMENT);
  wisp_flame_state state{};
  state.size = sizeof state;
  EXPECT_EQ(wisp_bank_get_flame_state(bank, instance, &state), WISP_OK);
  EXPECT_EQ(state.lit, 1U);
  wisp_bank_free(bank);
  wisp_model_free(model);
}

Model made_up_flame() {
  Model model = flame_model({.wind = InputShape::kEvenOdd});
  model.extinction = Extinction{.level = 1.3, .seconds = 0.15, .haste = 2, .recovery = 0.3};
  model.training = {"wisp 0.1.0", {"clip.mp4"}, {{"order", "4"}}, {{"fit", 61.5}}, {true, "made up"}};
  return model;
}

Model made_up_leaf() {
  Model model = sample_chain();
  GustResponse gust;
  gust.ground = {0.75, 0.25, 0.125};
  gust.vertical = {0.5, 0.125, 0.25};
  std::get<ChainModel>(model.dynamics).gust = gust;
  for (const char* name : {"wind.x", "wind.y", "wind.z"}) model.inputs.push_back({name, "m/s", -2, 2});
  model.name = "made-up leaf";
  return model;
}

std::string path_of(const std::string& name) { return WISP_SOURCE_DIR "/tests/c/models/" + name + ".wisp"; }

std::vector<std::byte> bytes_of(const std::string& name) { return *read_file(path_of(name)); }

// C, WebAssembly and the browsers play these files.
TEST(C, TheModelsOfTheseTestsAreTheMadeUpOnes) {
  if (std::getenv("WISP_WRITE_GOLDEN")) {
    ASSERT_TRUE(write_model(path_of("flame"), made_up_flame()));
    ASSERT_TRUE(write_model(path_of("leaf"), made_up_leaf()));
  }
  EXPECT_EQ(bytes_of("flame"), *model_bytes(made_up_flame()));
  EXPECT_EQ(bytes_of("leaf"), *model_bytes(made_up_leaf()));
}

TEST(C, AModelGivesAnAccountOfItself) {
  const std::vector<std::byte> flame = bytes_of("flame"), leaf = bytes_of("leaf");
  EXPECT_EQ(text(account_of_a_flame(flame.data(), flame.size())), "");
  EXPECT_EQ(text(account_of_a_leaf(leaf.data(), leaf.size())), "");
}

TEST(C, ALeafIsThrownIntoTheWorldAndBlownAlong) {
  const std::vector<std::byte> leaf = bytes_of("leaf");
  EXPECT_EQ(text(leaf_in_the_world(leaf.data(), leaf.size())), "");
}

TEST(C, AMicrophoneHearsTheWind) { EXPECT_EQ(text(wind_in_c()), ""); }

TEST(C, EveryMisuseOfTheWindHasItsStatusAndItsSentence) { EXPECT_EQ(text(misuse_of_wind()), ""); }

TEST(C, AModelCutAtAnyLengthIsBadData) {
  for (const char* name : {"flame", "leaf"}) {
    const std::vector<std::byte> bytes = bytes_of(name);
    EXPECT_EQ(text(cut_at_each_length(bytes.data(), bytes.size())), "");
  }
}

// What the hashes must be: name, count (of frames, or of seconds) and the hash, as WebAssembly is held to it too.
struct Golden {
  std::uint32_t count = 0;
  std::uint32_t hash[2] = {};
};

std::map<std::string, Golden> golden_hashes() {
  std::map<std::string, Golden> all;
  std::ifstream file(WISP_SOURCE_DIR "/tests/c/models/bits.txt");
  std::string name;
  Golden one;
  while (file >> name >> std::dec >> one.count >> std::hex >> one.hash[0] >> one.hash[1]) all[name] = one;
  return all;
}

std::string hex(const std::uint32_t hash[2]) {
  char text[18];
  std::snprintf(text, sizeof text, "%08x %08x", hash[0], hash[1]);
  return text;
}

TEST(C, ALifeOf100000FramesHasTheBitsThatItHasEverywhere) {
  const auto golden = golden_hashes();
  for (const std::string name : {"flame", "leaf"}) {
    const std::vector<std::byte> bytes = bytes_of(name);
    std::uint32_t hash[2];
    ASSERT_EQ(text(hash_of_life(bytes.data(), bytes.size(), golden.at(name).count, hash)), "");
    EXPECT_EQ(golden.at(name).count, 100000U);
    EXPECT_EQ(hex(hash), hex(golden.at(name).hash)) << name;
  }
}

TEST(C, TheWindOfASoundHasTheBitsThatItHasEverywhere) {
  const Golden golden = golden_hashes().at("wind");
  std::uint32_t hash[2];
  ASSERT_EQ(text(hash_of_wind(golden.count, hash)), "");
  EXPECT_EQ(hex(hash), hex(golden.hash));
}

}  // namespace
}  // namespace wisp::wisp_test
