#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "base/hash.hpp"
#include "model/sample_chain.hpp"
#include "model/sample_model.hpp"
#include "run/bank/bits_of.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::bank_save_test {
namespace {

using std::chrono::nanoseconds;
using testing::HasSubstr;

Bank bank_of(const Model& model, int capacity, std::uint64_t seed = 1) {
  auto bank = Bank::create(model, {.capacity = capacity, .seed = seed});
  EXPECT_TRUE(bank) << bank.error().message;
  return std::move(bank).value();
}

std::vector<float> outputs_of(const Bank& bank) {
  std::vector<float> values(static_cast<std::size_t>(bank.slots()) * bank.output_count());
  bank.outputs(values);
  return values;
}

// A bank in the middle of its life: gaps, different winds and ages, a scaled noise, time between two steps.
Bank lived_in_bank() {
  Bank bank = bank_of(flame_model({.wind = InputShape::kEvenOdd}), 20, 7);
  std::vector<InstanceId> ids;
  for (int k = 0; k < 12; ++k) {
    ids.push_back(bank.spawn());
    bank.set_inputs(ids.back(), std::vector<float>{0.1f * static_cast<float>(k) - 0.5f});
    bank.advance(nanoseconds(20'000'000));
  }
  bank.end(ids[3]);
  bank.end(ids[8]);
  bank.set_noise(0.5f);
  bank.advance(nanoseconds(123'456'789));
  return bank;
}

std::string error_of(Bank& bank, std::span<const std::byte> bytes) {
  const auto outcome = bank.restore(bytes);
  return outcome ? "" : outcome.error().message;
}

void mend_hash(std::vector<std::byte>& bytes) {
  const std::uint64_t hash = hash_bytes(std::span(bytes).subspan(32));
  for (int k = 0; k < 8; ++k) bytes[24 + k] = static_cast<std::byte>(hash >> (8 * k));
}

// Slots that nobody lives in are saved too: what they hold must not depend on what is not.
TEST(SavedBank, ItsTwinSavesTheSameBytesWhereSlotsAreEmpty) {
  const Model model = flame_model({.points = 4, .wind = InputShape::kEvenOdd});
  Bank bank = bank_of(model, 4), twin = bank_of(model, 4, 99);
  for (int k = 0; k < 4; ++k) bank.spawn();
  for (int k = 0; k < 20; ++k) bank.step();
  for (int slot = 1; slot < 4; ++slot) bank.end(bank.at(slot));
  ASSERT_TRUE(twin.restore(saved(bank)));
  for (int k = 0; k < 4; ++k) {
    bank.step();
    twin.step();
  }
  EXPECT_EQ(saved(bank), saved(twin));
}

TEST(SavedBank, GoesOnWithTheSameBits) {
  Bank bank = lived_in_bank();
  Bank other = bank_of(flame_model({.wind = InputShape::kEvenOdd}), 20, 99);
  for (int k = 0; k < 17; ++k) other.spawn();
  other.step();
  ASSERT_TRUE(other.restore(saved(bank)));
  EXPECT_EQ(other.size(), bank.size());
  EXPECT_EQ(other.noise(), bank.noise());
  EXPECT_EQ(other.clamped().steps, bank.clamped().steps);
  for (int k = 0; k < 100; ++k) {
    ASSERT_EQ(outputs_of(other), outputs_of(bank)) << k;
    EXPECT_EQ(bank.advance(nanoseconds(17'000'000)), other.advance(nanoseconds(17'000'000)));
    if (k == 50) {
      EXPECT_EQ(bank.spawn(), other.spawn());
    }
  }
}

TEST(SavedBank, ShowsWhatWasShownAfterARawStepToo) {
  Bank bank = lived_in_bank();
  bank.step();
  Bank other = bank_of(flame_model({.wind = InputShape::kEvenOdd}), 20);
  ASSERT_TRUE(other.restore(saved(bank)));
  EXPECT_EQ(outputs_of(other), outputs_of(bank));
}

TEST(SavedBank, IdsStayWhatTheyWere) {
  Bank bank = bank_of(flame_model(), 4);
  const InstanceId gone = bank.spawn(), kept = bank.spawn();
  bank.end(gone);
  const std::vector<std::byte> bytes = saved(bank);
  Bank other = bank_of(flame_model(), 4);
  ASSERT_TRUE(other.restore(bytes));
  EXPECT_TRUE(other.valid(kept));
  EXPECT_FALSE(other.valid(gone));
  EXPECT_NE(other.spawn(), gone);
}

TEST(SavedBank, TheSameStateGivesTheSameBytes) {
  const Bank bank = lived_in_bank();
  Bank other = bank_of(flame_model({.wind = InputShape::kEvenOdd}), 20);
  ASSERT_TRUE(other.restore(saved(bank)));
  EXPECT_EQ(saved(other), saved(bank));
}

// Leaves numbers behind on the stack, for whoever reads what nobody wrote.
void leave_behind(unsigned number) {
  volatile unsigned left[4096];
  for (volatile unsigned& one : left) one = number;
}

TEST(SavedBank, OfPositionsAloneKeepsNothingThatNobodyWrote) {
  const Model model = sample_chain(ChainMotion::kPosition);
  Bank one = bank_of(model, 4), other = bank_of(model, 4);
  for (Bank* bank : {&one, &other}) {
    for (int k = 0; k < 4; ++k) bank->spawn();
  }
  for (int step = 0; step < 400; ++step) {
    leave_behind(0x3f800000U);
    one.step();
    leave_behind(0x40490fdbU);
    other.step();
  }
  EXPECT_EQ(saved(one), saved(other));
}

TEST(SavedBank, AnotherModelOrCapacityIsRefused) {
  const std::vector<std::byte> bytes = saved(lived_in_bank());
  Bank sample = bank_of(sample_model(), 20);
  EXPECT_THAT(error_of(sample, bytes), HasSubstr("of another model"));
  Model slightly = flame_model({.wind = InputShape::kEvenOdd});
  std::get<ArxModel>(slightly.dynamics).theta[5][2] += 1e-6;
  Bank similar = bank_of(slightly, 20);
  EXPECT_THAT(error_of(similar, bytes), HasSubstr("of another model"));
  Bank larger = bank_of(flame_model({.wind = InputShape::kEvenOdd}), 21);
  EXPECT_THAT(error_of(larger, bytes), HasSubstr("capacity 20, the bank to restore has 21"));
}

TEST(SavedBank, EveryTruncationIsAnErrorAndChangesNothing) {
  Bank bank = bank_of(sample_model(), 2);
  bank.spawn();
  bank.step();
  const std::vector<std::byte> bytes = saved(bank);
  bank.step();
  const std::vector<std::byte> now = saved(bank);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ASSERT_NE(error_of(bank, std::span(bytes).first(size)), "") << size;
  }
  std::vector<std::byte> longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_NE(error_of(bank, longer), "");
  EXPECT_EQ(saved(bank), now);
}

TEST(SavedBank, EverySingleBitFlipIsAnErrorAndChangesNothing) {
  Bank bank = bank_of(sample_model(), 1);
  bank.spawn();
  bank.step();
  std::vector<std::byte> bytes = saved(bank);
  bank.step();
  const std::vector<std::byte> now = saved(bank);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
    ASSERT_NE(error_of(bank, bytes), "") << "bit " << bit;
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
  }
  EXPECT_EQ(saved(bank), now);
}

TEST(SavedBank, AnotherVersionIsNamed) {
  Bank bank = bank_of(sample_model(), 1);
  std::vector<std::byte> bytes = saved(bank);
  for (const int version : {1, 9}) {
    bytes[8] = static_cast<std::byte>(version);
    EXPECT_THAT(error_of(bank, bytes), HasSubstr("has version " + std::to_string(version) + ", this build reads 4"));
  }
}

// Damage behind a mended hash reaches the checks of meaning: what they let through must be a state that a bank can
// live.
TEST(SavedBank, DamageBehindAGoodHashNeverLeavesTheRange) {
  const Model model = sample_model();
  Bank bank = bank_of(model, 3);
  bank.spawn();
  bank.spawn();
  bank.step();
  const std::vector<std::byte> good = saved(bank);
  std::mt19937 random(1);
  int refused = 0;
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::byte> bytes = good;
    const std::size_t at = 32 + random() % (bytes.size() - 32);
    const std::uint32_t word = round % 3 == 0 ? 0x7fc00000U : static_cast<std::uint32_t>(random());
    std::memcpy(&bytes[std::min(at, bytes.size() - 4)], &word, 4);
    mend_hash(bytes);
    if (!bank.restore(bytes)) {
      ++refused;
      continue;
    }
    for (int k = 0; k < 3; ++k) bank.step();
    const std::vector<float> values = outputs_of(bank);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Output& output = model.outputs[i % 8];
      ASSERT_TRUE(std::abs(values[i]) <= 2 * output.highest) << round;
    }
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace wisp::bank_save_test
