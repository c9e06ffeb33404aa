// One instance's bits do not depend on its company. What compilers make of them is tested by bits/bits.cmake.

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "model/sample_model.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::bank_bits_test {
namespace {

const Model kFlame = flame_model({.wind = InputShape::kEvenOdd});

Bank bank_of(int capacity, std::uint64_t seed = 11) {
  auto bank = Bank::create(kFlame, {.capacity = capacity, .seed = seed});
  EXPECT_TRUE(bank) << bank.error().message;
  return std::move(bank).value();
}

float wind_of(std::uint64_t stream, int frame) {
  return static_cast<float>((stream * 37 + static_cast<std::uint64_t>(frame) * 11) % 100) / 50.0f - 1.0f;
}

// The outputs of 200 frames of one instance of `stream` in `bank`, whose other rows have winds of their own.
std::vector<float> life(Bank& bank, InstanceId id, std::uint64_t stream) {
  std::vector<float> all, wind(bank.slots()), row(bank.output_count());
  for (int frame = 0; frame < 200; ++frame) {
    for (std::size_t k = 0; k < wind.size(); ++k) wind[k] = wind_of(k + 1000, frame);
    wind[id.slot] = wind_of(stream, frame);
    bank.set_inputs(wind);
    bank.advance(std::chrono::nanoseconds(21'000'000));
    EXPECT_TRUE(bank.outputs(id, row));
    all.insert(all.end(), row.begin(), row.end());
  }
  return all;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

std::vector<float> life_alone(std::uint64_t stream) {
  Bank bank = bank_of(1);
  return life(bank, bank.spawn(stream), stream);
}

TEST(BankBits, AnInstanceLivesTheSameLifeInABankOfAnySize) {
  for (int capacity : {2, 7, 8, 9, 31, 1000}) {
    for (int slot : {0, capacity / 2, capacity - 1}) {
      Bank bank = bank_of(capacity);
      InstanceId watched;
      for (int k = 0; k < capacity; ++k) {
        const InstanceId id = bank.spawn(k == slot ? 5 : 100 + k);
        if (k == slot) watched = id;
      }
      EXPECT_TRUE(same_bits(life(bank, watched, 5), life_alone(5))) << capacity << " " << slot;
    }
  }
}

// Several blocks are stepped at once: each goes by the ages of its own instances.
TEST(BankBits, AnInstanceBornLaterThanTheBlocksBesideItLivesTheSameLife) {
  for (int slot : {9, 17, 31}) {
    Bank bank = bank_of(32);
    for (int k = 0; k < 32; ++k) bank.spawn(100 + k);
    for (int frame = 0; frame < 30; ++frame) bank.step();
    ASSERT_TRUE(bank.end(bank.at(slot)));
    const InstanceId id = bank.spawn(5);
    ASSERT_EQ(id.slot, static_cast<std::uint32_t>(slot));
    EXPECT_TRUE(same_bits(life(bank, id, 5), life_alone(5))) << slot;
  }
}

TEST(BankBits, ANewbornDoesNotHearTheWindOfWhatLivedInItsSlot) {
  Bank bank = bank_of(1), fresh = bank_of(1);
  bank.spawn(1);
  bank.set_inputs(std::vector<float>{0.8f});
  bank.end(bank.at(0));
  const InstanceId id = bank.spawn(5), other = fresh.spawn(5);
  std::vector<float> a(bank.output_count()), b(a.size());
  for (int frame = 0; frame < 10; ++frame) {
    bank.step();
    fresh.step();
  }
  ASSERT_TRUE(bank.outputs(id, a) && fresh.outputs(other, b));
  EXPECT_TRUE(same_bits(a, b));
}

TEST(BankBits, ItsLifeDoesNotDependOnWhatLivedInItsSlotBefore) {
  Bank bank = bank_of(3);
  for (int k = 0; k < 3; ++k) bank.spawn(k);
  for (int frame = 0; frame < 30; ++frame) bank.step();
  bank.reset();  // the bank's time too, so that frames fall between the same steps
  ASSERT_TRUE(bank.end(bank.at(1)));
  const InstanceId id = bank.spawn(5);
  EXPECT_EQ(id.slot, 1U);
  EXPECT_TRUE(same_bits(life(bank, id, 5), life_alone(5)));
}

TEST(BankBits, StreamsAndSeedsGiveOtherLives) {
  EXPECT_FALSE(same_bits(life_alone(5), life_alone(6)));
  Bank other_seed = bank_of(1, 12);
  EXPECT_FALSE(same_bits(life(other_seed, other_seed.spawn(5), 5), life_alone(5)));
}

TEST(BankBits, SpawnsWithoutAStreamAreCounted) {
  Bank counted = bank_of(3), named = bank_of(3);
  for (std::uint64_t k = 0; k < 3; ++k) {
    counted.spawn();
    named.spawn(k);
  }
  std::vector<float> a(3 * counted.output_count()), b(a.size());
  for (int frame = 0; frame < 20; ++frame) {
    counted.step();
    named.step();
  }
  counted.outputs(a);
  named.outputs(b);
  EXPECT_TRUE(same_bits(a, b));
}

// More than 2^16 steps: an age in too few bits would repeat itself.
TEST(BankBits, NoiseDoesNotRepeatItself) {
  Bank bank = bank_of(1);
  const InstanceId id = bank.spawn();
  std::vector<float> first(bank.output_count()), later(bank.output_count());
  bank.step();
  bank.outputs(id, first);
  for (int step = 1; step < 70'000; ++step) {
    bank.step();
    bank.outputs(id, later);
    ASSERT_NE(first, later) << step;
  }
}

}  // namespace
}  // namespace wisp::bank_bits_test
