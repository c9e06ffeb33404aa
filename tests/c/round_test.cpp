// A flame in the round over the C ABI.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "paths.hpp"
#include "wisp/base/file.hpp"
#include "wisp/wisp.h"

namespace wisp::round_c_test {
namespace {

constexpr const char* kFlame = WISP_SOURCE_DIR "/apps/web/public/models/flame.wisp";

wisp_model* load(const std::string& path) {
  const auto bytes = *read_file(path);
  wisp_model* model = nullptr;
  EXPECT_EQ(wisp_model_load(bytes.data(), bytes.size(), &model), WISP_OK) << wisp_last_error();
  return model;
}

wisp_bank* bank_of(const wisp_model* model) {
  wisp_bank* bank = nullptr;
  wisp_instance id = 0;
  EXPECT_EQ(wisp_bank_create(model, nullptr, &bank), WISP_OK) << wisp_last_error();
  EXPECT_EQ(wisp_bank_spawn(bank, &id), WISP_OK);
  return bank;
}

TEST(RoundInC, AWindFromBehindLeansTowardsTheViewer) {
  wisp_model *plane = load(kFlame), *round = nullptr;
  ASSERT_EQ(wisp_model_in_the_round(plane, &round), WISP_OK) << wisp_last_error();
  wisp_bank* bank = bank_of(round);
  const wisp_instance id = wisp_bank_at(bank, 0);
  const float wind[] = {0, 0.6f};
  ASSERT_EQ(wisp_bank_set_common_inputs(bank, wind, 2), WISP_OK) << wisp_last_error();
  for (int k = 0; k < 60; ++k) wisp_bank_step(bank);
  std::vector<float> rings(16 * 6), mesh(16 * 8 * 7, -3.0f), line(64);
  ASSERT_EQ(wisp_bank_rings(bank, id, rings.data(), rings.size()), WISP_OK) << wisp_last_error();
  EXPECT_GT(rings[15 * 6 + 2], 0.2);
  ASSERT_EQ(wisp_bank_look(bank, 0, -1), WISP_OK);
  wisp_bank_polyline(bank, id, line.data(), line.size());
  EXPECT_NEAR((line[30] + line[32]) / 2, -rings[15 * 6 + 2], 1e-5);
  ASSERT_EQ(wisp_ring_mesh(rings.data(), 16, 8, mesh.data(), mesh.size(), 7), WISP_OK) << wisp_last_error();
  EXPECT_EQ(mesh[6], -3.0f);
  EXPECT_NEAR(mesh[0], rings[0] + rings[3], 1e-6);
  std::vector<uint32_t> triangles(3 * (2 * 16 * 8 - 4));
  ASSERT_EQ(wisp_ring_triangles(16, 8, triangles.data(), triangles.size()), WISP_OK) << wisp_last_error();
  for (const uint32_t index : triangles) EXPECT_LT(index, 16u * 8);
  EXPECT_EQ(wisp_ring_triangles(16, 8, triangles.data(), 5), WISP_BAD_ARGUMENT);
  EXPECT_EQ(wisp_ring_triangles(1, 8, triangles.data(), triangles.size()), WISP_BAD_ARGUMENT);
  EXPECT_EQ(wisp_ring_mesh(rings.data(), 16, 2, mesh.data(), mesh.size(), 7), WISP_BAD_ARGUMENT);
  EXPECT_EQ(wisp_ring_mesh(rings.data(), 16, 8, mesh.data(), mesh.size(), 5), WISP_BAD_ARGUMENT);
  EXPECT_EQ(wisp_ring_mesh(rings.data(), 16, 8, mesh.data(), 700, 7), WISP_BAD_ARGUMENT);
  EXPECT_EQ(wisp_ring_mesh(nullptr, 16, 8, mesh.data(), mesh.size(), 7), WISP_BAD_ARGUMENT);
  wisp_flame_state state{};
  state.size = sizeof state;
  ASSERT_EQ(wisp_bank_get_flame_state(bank, id, &state), WISP_OK);
  EXPECT_GT(state.light[2], 0.05);
  EXPECT_NEAR(state.kelvin, 1900, 40);
  EXPECT_NEAR(state.intensity, 1, 0.4);
  EXPECT_EQ(state.events, 0u);
  wisp_bank_extinguish(bank, id);
  wisp_bank_get_flame_state(bank, id, &state);
  EXPECT_EQ(state.events, WISP_WENT_OUT);
  EXPECT_EQ(wisp_bank_rings(bank, id, rings.data(), 5), WISP_BAD_ARGUMENT);
  EXPECT_EQ(wisp_bank_rings(bank, id + 1, rings.data(), rings.size()), WISP_NOT_ALIVE);
  EXPECT_EQ(wisp_bank_look(nullptr, 1, 0), WISP_BAD_ARGUMENT);
  wisp_bank_free(bank);
  wisp_model_free(round);
  wisp_model_free(plane);
}

TEST(ChainInC, AnInstanceTellsHowItMovesAndWhenItHasLanded) {
  wisp_model* leaf = load(WISP_SOURCE_DIR "/apps/web/public/models/leaf.wisp");
  wisp_bank* bank = bank_of(leaf);
  const wisp_instance id = wisp_bank_at(bank, 0);
  wisp_bank_set_ground(bank, -1.5f);
  float before[7], after[7];
  wisp_chain_place place{};
  place.size = sizeof place;
  int landings = 0, frames = 0;
  while (place.lies == 0 && ++frames < 2000) {
    wisp_bank_outputs(bank, before, 7);
    wisp_bank_step(bank);
    wisp_bank_outputs(bank, after, 7);
    ASSERT_EQ(wisp_bank_get_chain_place(bank, id, &place), WISP_OK);
    wisp_model_facts facts{};
    facts.size = sizeof facts;
    wisp_model_get_facts(leaf, &facts);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(place.velocity[axis], (after[axis] - before[axis]) * facts.rate_hz, 1e-2);
    }
    landings += static_cast<int>(place.landed);
  }
  EXPECT_EQ(place.lies, 1u);
  EXPECT_EQ(landings, 1);
  wisp_bank_step(bank);
  wisp_bank_get_chain_place(bank, id, &place);
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(place.velocity[axis], 0);
  wisp_bank_options options = wisp_bank_default_options();
  options.longest = 100;
  wisp_bank* short_steps = nullptr;
  int32_t steps = 0;
  ASSERT_EQ(wisp_bank_create(leaf, &options, &short_steps), WISP_OK);
  wisp_bank_advance_seconds(short_steps, 5, &steps);
  EXPECT_LE(steps, 12);
  wisp_bank_free(short_steps);
  wisp_bank_free(bank);
  wisp_model_free(leaf);
}

TEST(RoundInC, WhatIsNotInTheRoundSaysSo) {
  wisp_model *made_up = load(WISP_SOURCE_DIR "/tests/c/models/flame.wisp"), *plane = load(kFlame), *round = nullptr;
  EXPECT_EQ(wisp_model_in_the_round(made_up, &round), WISP_BAD_ARGUMENT);
  EXPECT_EQ(round, nullptr);
  wisp_bank* bank = bank_of(plane);
  float rings[96];
  EXPECT_EQ(wisp_bank_rings(bank, wisp_bank_at(bank, 0), rings, 96), WISP_BAD_ARGUMENT);
  EXPECT_STREQ(wisp_last_error(), "wisp_bank_rings: the model is not in the round");
  wisp_bank_free(bank);
  wisp_model_free(plane);
  wisp_model_free(made_up);
}

}  // namespace
}  // namespace wisp::round_c_test
