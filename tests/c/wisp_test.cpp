#include "wisp/wisp.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "c/life_in_c.h"
#include "run/flame_model.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"

namespace wisp {
namespace {

std::vector<std::byte> flame_bytes() { return std::move(model_bytes(flame_model())).value(); }

std::string text(const char* wrong) { return wrong ? std::string(wrong) + " · " + wisp_last_error() : ""; }

TEST(C, AWholeLifeIsTheOneThatCppHas) {
  const std::vector<std::byte> bytes = flame_bytes();
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

}  // namespace
}  // namespace wisp
