// What joins is gathered from many blocks: an instance's bits do not depend on who else joins.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <cstring>
#include <vector>

#include "model/sample_chain.hpp"
#include "run/chain/poses.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"

namespace wisp::chain_crowd_test {
namespace {

using poses::bank_of;

constexpr int kSteps = 240;
constexpr int kCrowd = 301;  // more blocks than go at once, the last one in part
constexpr int kWatched[] = {0, 7, 8, 130, 255, 256, 263, 300};

Model in_the_world(Model model) {
  std::get<ChainModel>(model.dynamics).heading_free = false;
  return model;
}

// The sample, whose segments begin and end at velocities and spins that differ in every number.
Model uneven(Model model) {
  auto& rates = std::get<ChainModel>(model.dynamics).segments.rates;
  for (std::size_t k = 0; k < rates.size(); ++k)
    rates[k] = static_cast<std::int16_t>(rates[k] + 300 * (static_cast<int>(k * 7 % 11) - 5));
  return model;
}

// What happens to a watched instance, whoever is with it; others only fall.
void happen(Bank& bank, InstanceId id, int step) {
  if (step == 50 && bank.chain()->can_steer()) {
    EXPECT_TRUE(bank.chain()->steer(id, {{1, -0.5f, -1}, std::chrono::milliseconds(900)}));
  }
  if (step == 130) {
    const BodyMoment body{
        .position = {0.5f, 1, 2}, .orientation = {0.8f, 0.2f, -0.1f, 0.55f}, .velocity = {0.5f, 0.3f, -0.6f}};
    EXPECT_TRUE(bank.chain()->place(id, body));
  }
}

void blow(Bank& bank, int step) {
  if (bank.input_count() == 0) return;
  bank.set_common_inputs(std::vector<float>{step % 60 < 30 ? 0.0f : 1.0f, 0.25f, -0.125f});
}

std::vector<float> life_alone(const Model& model, int slot) {
  auto bank = Bank::create(model, {.capacity = 1, .seed = 1});
  bank->chain()->set_ground(-1.0f);
  const InstanceId id = bank->spawn(static_cast<std::uint64_t>(slot));
  std::vector<float> all, row(bank->output_count());
  for (int step = 0; step < kSteps; ++step) {
    happen(*bank, id, step);
    blow(*bank, step);
    bank->step();
    EXPECT_TRUE(bank->outputs(id, row));
    all.insert(all.end(), row.begin(), row.end());
  }
  return all;
}

// Of each that is watched, among others of which some end and others come; all are read at once.
std::vector<std::vector<float>> lives_in_a_crowd(const Model& model) {
  auto bank = Bank::create(model, {.capacity = kCrowd, .seed = 1});
  bank->chain()->set_ground(-1.0f);
  std::vector<InstanceId> ids;
  for (int k = 0; k < kCrowd; ++k) ids.push_back(bank->spawn(static_cast<std::uint64_t>(k)));
  const std::size_t outputs = bank->output_count();
  std::vector<std::vector<float>> lives(std::size(kWatched));
  std::vector<float> rows(kCrowd * outputs);
  for (int step = 0; step < kSteps; ++step) {
    for (int slot : kWatched) happen(*bank, ids[slot], step);
    if (step == 20) {
      EXPECT_TRUE(bank->end(ids[9]));
    }
    if (step == 90) bank->spawn(1000);
    blow(*bank, step);
    bank->step();
    bank->outputs(rows);
    for (std::size_t k = 0; k < lives.size(); ++k) {
      const float* row = rows.data() + kWatched[k] * outputs;
      lives[k].insert(lives[k].end(), row, row + outputs);
    }
  }
  return lives;
}

TEST(ChainCrowd, AnInstanceLivesTheSameLifeAmongManyAsAlone) {
  const Model models[] = {sample_chain(),
                          unblended(),
                          sample_chain(ChainMotion::kPosition),
                          in_the_world(sample_chain()),
                          in_the_world(sample_chain(ChainMotion::kPosition)),
                          bounded_chain(),
                          bounded_chain(ChainMotion::kPosition),
                          uneven(sample_chain()),
                          uneven(bounded_chain()),
                          uneven(sample_chain(ChainMotion::kPosition)),
                          windy_chain()};
  for (std::size_t kind = 0; kind < std::size(models); ++kind) {
    const auto lives = lives_in_a_crowd(models[kind]);
    for (std::size_t k = 0; k < lives.size(); ++k) {
      const auto alone = life_alone(models[kind], kWatched[k]);
      ASSERT_EQ(lives[k].size(), alone.size());
      EXPECT_EQ(std::memcmp(lives[k].data(), alone.data(), alone.size() * sizeof(float)), 0)
          << "kind " << kind << ", slot " << kWatched[k];
    }
  }
}

}  // namespace
}  // namespace wisp::chain_crowd_test
