// What a game does with a bank over the C ABI, for every shipped model.

#include <gtest/gtest.h>

#include <cstring>
#include <thread>
#include <vector>

#include "shipped.hpp"
#include "wisp/base/file.hpp"
#include "wisp/wisp.h"

namespace wisp::play_test {
namespace {

// A bank with some instances, and its sizes.
class Played {
 public:
  Played(const std::string& path, uint32_t capacity) {
    const auto bytes = *read_file(path);
    wisp_model* model = nullptr;
    EXPECT_EQ(wisp_model_load(bytes.data(), bytes.size(), &model), WISP_OK) << path;
    wisp_bank_options options = wisp_bank_default_options();
    options.capacity = capacity;
    EXPECT_EQ(wisp_bank_create(model, &options, &bank), WISP_OK) << path;
    wisp_model_free(model);
    ids.resize(capacity);
    for (wisp_instance& id : ids) EXPECT_EQ(wisp_bank_spawn(bank, &id), WISP_OK);
    facts.size = sizeof facts;
    EXPECT_EQ(wisp_bank_get_facts(bank, &facts), WISP_OK);
  }
  ~Played() { wisp_bank_free(bank); }
  Played(const Played&) = delete;
  Played& operator=(const Played&) = delete;

  std::vector<float> outputs() const {
    std::vector<float> values(ids.size() * facts.outputs);
    EXPECT_EQ(wisp_bank_outputs(bank, values.data(), values.size()), WISP_OK) << wisp_last_error();
    return values;
  }

  wisp_bank* bank = nullptr;
  wisp_bank_facts facts{};
  std::vector<wisp_instance> ids;
};

TEST(Play, ABufferOfCapacityRowsServesWhateverHasEnded) {
  for (const std::string& path : shipped_models()) {
    Played play(path, 8);
    std::vector<float> inputs(8 * play.facts.inputs), sizes(8), lines(16 * play.facts.polyline_points);
    for (const std::size_t ended : {7, 3, 6}) {
      ASSERT_EQ(wisp_bank_end(play.bank, play.ids[ended]), WISP_OK);
      EXPECT_EQ(wisp_bank_set_inputs(play.bank, inputs.data(), inputs.size()), WISP_OK) << path << wisp_last_error();
      EXPECT_EQ(wisp_bank_flame_sizes(play.bank, sizes.data(), sizes.size()), WISP_OK) << path;
      if (!lines.empty()) {
        EXPECT_EQ(wisp_bank_polylines(play.bank, lines.data(), lines.size()), WISP_OK) << path;
      }
      EXPECT_EQ(sizes[ended], 0);
      const auto outputs = play.outputs();
      for (std::size_t k = 0; k < play.facts.outputs; ++k)
        EXPECT_EQ(outputs[ended * play.facts.outputs + k], 0) << path;
    }
  }
}

TEST(Play, ManyStepsAtOnceAreAsManySingleOnes) {
  for (const std::string& path : shipped_models()) {
    constexpr uint32_t kSteps = 9;
    Played at_once(path, 3), one_by_one(path, 3);
    const std::size_t in = 3 * at_once.facts.inputs, out = 3 * at_once.facts.outputs;
    std::vector<float> inputs(kSteps * in), outputs(kSteps * out);
    for (std::size_t k = 0; k < inputs.size(); ++k) inputs[k] = 0.1F * static_cast<float>(k % 7);
    ASSERT_EQ(wisp_bank_step_many(at_once.bank, kSteps, inputs.data(), inputs.size(), outputs.data(), outputs.size()),
              WISP_OK)
        << path << wisp_last_error();
    for (uint32_t t = 0; t < kSteps; ++t) {
      wisp_bank_set_inputs(one_by_one.bank, inputs.data() + t * in, in);
      wisp_bank_step(one_by_one.bank);
      const auto single = one_by_one.outputs();
      EXPECT_EQ(std::memcmp(single.data(), outputs.data() + t * out, out * sizeof(float)), 0) << path << " step " << t;
    }
    EXPECT_EQ(wisp_bank_step_many(at_once.bank, kSteps, nullptr, 0, outputs.data(), outputs.size() - 1),
              WISP_BAD_ARGUMENT);
    EXPECT_EQ(wisp_bank_step_many(at_once.bank, 1U << 30, nullptr, 0, nullptr, 0), WISP_BAD_ARGUMENT);
    EXPECT_EQ(wisp_bank_step_many(at_once.bank, 4, nullptr, 0, nullptr, 0), WISP_OK);
  }
}

void share(void* pool, int32_t parts, wisp_crew_task task, void* of) {
  ++*static_cast<int*>(pool);
  std::vector<std::thread> threads;
  for (int32_t part = 0; part < parts; ++part) threads.emplace_back(task, of, part);
  for (std::thread& thread : threads) thread.join();
}

TEST(Play, ACrewStepsTheSameBits) {
  for (const std::string& path : shipped_models()) {
    Played alone(path, 900), shared(path, 900);
    int calls = 0;
    ASSERT_EQ(wisp_bank_set_crew(shared.bank, 3, share, &calls), WISP_OK);
    for (int step = 0; step < 10; ++step) {
      wisp_bank_step(alone.bank);
      wisp_bank_step(shared.bank);
    }
    EXPECT_GE(calls, 10) << path;
    EXPECT_EQ(alone.outputs(), shared.outputs()) << path;
    EXPECT_EQ(wisp_bank_set_crew(shared.bank, 0, share, &calls), WISP_BAD_ARGUMENT);
    EXPECT_EQ(wisp_bank_set_crew(shared.bank, 1, nullptr, nullptr), WISP_OK);
  }
}

TEST(Play, SecondsPass) {
  for (const std::string& path : shipped_models()) {
    Played play(path, 1);
    int32_t steps = -1;
    EXPECT_EQ(wisp_bank_advance_seconds(play.bank, 0.5, &steps), WISP_OK);
    EXPECT_GT(steps, 3) << path;
  }
}

TEST(Play, ALeafIsSteeredWhereItsChainKnowsTheWay) {
  int steered = 0;
  for (const std::string& path : shipped_models()) {
    Played play(path, 1);
    wisp_target target{};
    target.size = sizeof target;
    target.position[2] = -2;
    target.nanoseconds = 2'000'000'000;
    const wisp_status status = wisp_bank_steer(play.bank, play.ids[0], &target);
    EXPECT_EQ(status == WISP_OK, wisp_bank_can_steer(play.bank) == 1) << path << wisp_last_error();
    if (status != WISP_OK) continue;
    ++steered;
    EXPECT_EQ(wisp_bank_release(play.bank, play.ids[0]), WISP_OK);
    target.nanoseconds = 0;
    EXPECT_EQ(wisp_bank_steer(play.bank, play.ids[0], &target), WISP_BAD_ARGUMENT);
    EXPECT_EQ(wisp_bank_steer(play.bank, WISP_NO_INSTANCE, &target), WISP_NOT_ALIVE);
  }
  EXPECT_GT(steered, 0);
}

}  // namespace
}  // namespace wisp::play_test
