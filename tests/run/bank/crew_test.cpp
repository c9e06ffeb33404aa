// A bank that several threads step: the same bits as from one.

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "model/sample_chain.hpp"
#include "model/sample_switched.hpp"
#include "run/bank/bits_of.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"

namespace wisp::crew_test {
namespace {

constexpr int kInstances = 531;

// A thread for every part.
struct Threads {
  std::atomic<int> runs = 0;

  Crew crew(int parts) { return {parts, run, this}; }

  static void run(void* pool, int parts, void (*task)(void* of, int part), void* of) {
    ++static_cast<Threads*>(pool)->runs;
    std::vector<std::thread> threads;
    for (int part = 0; part < parts; ++part) threads.emplace_back(task, of, part);
    for (std::thread& thread : threads) thread.join();
  }
};

Bank full_bank(const Model& model) {
  auto bank = Bank::create(model, {.capacity = kInstances});
  EXPECT_TRUE(bank) << bank.error().message;
  for (int k = 0; k < kInstances; ++k) bank->spawn();
  return std::move(bank).value();
}

// All that is seen of all instances in `frames` frames, some of them out and lit again; and what was clamped.
std::vector<float> lives(Bank& bank, int frames) {
  std::vector<float> all, inputs(static_cast<std::size_t>(kInstances) * bank.input_count());
  std::vector<float> outputs(static_cast<std::size_t>(kInstances) * bank.output_count());
  for (int frame = 0; frame < frames; ++frame) {
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      inputs[k] = 0.4f * static_cast<float>((k * 7 + static_cast<std::size_t>(frame)) % 21) - 4.0f;
    }
    bank.set_inputs(inputs);
    bank.advance(std::chrono::milliseconds(40));
    bank.outputs(outputs);
    all.insert(all.end(), outputs.begin(), outputs.end());
  }
  all.push_back(static_cast<float>(bank.clamped().clamped));
  all.push_back(static_cast<float>(bank.clamped().steps));
  return all;
}

TEST(Crew, GivesTheBitsOfOneThread) {
  for (const Model& model : {flame_model({.wind = InputShape::kEvenOdd}), flame_model(), default_flame_model(),
                             windy_chain(), sample_switched()}) {
    Bank alone = full_bank(model);
    const auto expected = lives(alone, 20);
    for (int parts : {2, 3, 100}) {
      Bank bank = full_bank(model);
      Threads threads;
      bank.set_crew(threads.crew(parts));
      EXPECT_TRUE(same_bits(lives(bank, 20), expected)) << model.name << ", " << parts << " parts";
      EXPECT_GT(threads.runs, 0);
    }
  }
}

TEST(Crew, IsNotAskedWhereThereIsLessThanAGroupToStep) {
  auto bank = Bank::create(flame_model(), {.capacity = 64});
  ASSERT_TRUE(bank);
  for (int k = 0; k < 64; ++k) bank->spawn();
  Threads threads;
  bank->set_crew(threads.crew(4));
  bank->step();
  EXPECT_EQ(threads.runs, 0);
}

TEST(Crew, RestsWhileAChainIsSteered) {
  Bank bank = full_bank(windy_chain());
  Threads threads;
  bank.set_crew(threads.crew(2));
  bank.step();
  const int before = threads.runs;
  EXPECT_GT(before, 0);
  ASSERT_TRUE(bank.chain()->steer(bank.at(3), {.position = {1, 2, 3}, .in = std::chrono::seconds(2)}));
  bank.step();
  EXPECT_EQ(threads.runs, before);
  // So does one that was restored.
  std::vector<std::byte> saved(bank.save_bytes());
  bank.save(saved);
  Bank other = full_bank(windy_chain());
  ASSERT_TRUE(other.restore(saved));
  other.set_crew(threads.crew(2));
  other.step();
  EXPECT_EQ(threads.runs, before);
}

TEST(Crew, GoesAndComes) {
  Bank bank = full_bank(flame_model());
  Threads threads;
  bank.set_crew(threads.crew(2));
  bank.step();
  const int before = threads.runs;
  bank.set_crew({});
  bank.step();
  EXPECT_EQ(threads.runs, before);
}

}  // namespace
}  // namespace wisp::crew_test
