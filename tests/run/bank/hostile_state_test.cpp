// Saved banks that were made to harm: one number of one instance is not what the bank wrote, and the state's own hash
// fits it. Every kind of dynamics is harmed in every number that it saves. Sanitizers see what reads out of bounds.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <ostream>
#include <vector>

#include "base/hash.hpp"
#include "model/sample_chain.hpp"
#include "model/sample_switched.hpp"
#include "run/bank/bits_of.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"

namespace wisp::hostile_state_test {
namespace {

constexpr std::size_t kHeader = 32, kFields = 11 * 8, kSlot = 24;

struct Kind {
  const char* name;
  std::function<Model()> model;
};

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

std::vector<Kind> kinds() {
  return {{"ResampledMirrored", [] { return default_flame_model(); }},
          {"Resampled", [] { return flame_model({.resampled_rows = 60}); }},
          {"Still", [] { return still_flame_model(100); }},
          {"Gaussian", [] { return flame_model({.points = 4}); }},
          {"Markov", [] { return sample_switched(); }},
          {"Positions", [] { return sample_chain(ChainMotion::kPosition); }},
          {"Landing", [] { return sample_chain(); }},
          {"Steered", [] { return steered_chain(); }},
          {"Bounded", [] { return bounded_chain(); }},
          {"Windy", [] { return windy_chain(); }}};
}

class HostileState : public testing::TestWithParam<Kind> {
 protected:
  static Bank bank() {
    auto made = Bank::create(GetParam().model(), {.capacity = 1});
    EXPECT_TRUE(made) << made.error().message;
    made->spawn();
    const std::vector<float> wind(GetParam().model().inputs.size(), 0.75f);
    made->set_common_inputs(wind);
    if (auto* chain = made->chain(); chain && std::string(GetParam().name) == "Landing") chain->set_ground(-0.05f);
    if (auto* chain = made->chain(); chain && chain->can_steer()) {
      chain->steer(made->at(0), {{1, 1, -2}, std::chrono::seconds(2), 0.1f});
    }
    for (int k = 0; k < 11; ++k) made->step();
    return std::move(made).value();
  }

  static std::vector<std::byte> harmed(std::vector<std::byte> bytes, std::size_t at, float number) {
    std::memcpy(&bytes[at], &number, sizeof number);
    const std::uint64_t hash = hash_bytes(std::span(bytes).subspan(kHeader));
    for (int k = 0; k < 8; ++k) bytes[24 + k] = static_cast<std::byte>(hash >> (8 * k));
    return bytes;
  }

  static float number_at(const std::vector<std::byte>& bytes, std::size_t at) {
    float number;
    std::memcpy(&number, &bytes[at], sizeof number);
    return number;
  }
};

INSTANTIATE_TEST_SUITE_P(Kinds, HostileState, testing::ValuesIn(kinds()),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST_P(HostileState, IsRefusedOrLivesFiniteAndSavesWhatRestores) {
  Bank good = bank();
  const std::vector<std::byte> sound = saved(good);
  const float never = std::numeric_limits<float>::quiet_NaN();
  int refused = 0, taken = 0;
  for (std::size_t at = kHeader + kFields + kSlot; at < sound.size(); at += 4) {
    const float was = number_at(sound, at);
    for (float number : {0.5f, 1.0f, 2.5f, -1.0f, was + 0.5f, 1e5f, -2e6f, 1e30f, -0.0f, 1e-40f, never}) {
      Bank hurt = bank();
      if (!hurt.restore(harmed(sound, at, number))) {
        ++refused;
        continue;
      }
      ++taken;
      std::vector<float> values(static_cast<std::size_t>(hurt.output_count()));
      for (int k = 0; k < 40; ++k) {
        hurt.step();
        hurt.outputs(values);
        for (float value : values) ASSERT_TRUE(std::abs(value) < 2.1e6f) << number << " at " << at;
      }
      Bank twin = bank();
      const auto restored = twin.restore(saved(hurt));
      ASSERT_TRUE(restored) << number << " at " << at << ": " << restored.error().message;
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(taken, 0);
}

// Numbers that count or point are never between two whole ones: nothing that a chain draws from may be so.
TEST(HostileChain, WhatFollowsIsAWholeNumber) {
  auto bank = Bank::create(sample_chain(), {.capacity = 1});
  ASSERT_TRUE(bank);
  bank->spawn();
  std::vector<std::byte> bytes(bank->save_bytes());
  bank->save(bytes);
  // Segment, row, state; place, half turn and its scales; then what follows.
  const std::size_t segment = kHeader + kFields + kSlot, row = segment + 4, state = row + 4, next = segment + 12 * 4;
  for (std::size_t at : {segment, row, state, next}) {
    std::vector<std::byte> harm = bytes;
    const float half = 0.5f;
    std::memcpy(&harm[at], &half, sizeof half);
    const std::uint64_t hash = hash_bytes(std::span(harm).subspan(kHeader));
    std::memcpy(&harm[24], &hash, sizeof hash);
    const auto outcome = bank->restore(harm);
    ASSERT_FALSE(outcome) << at;
    EXPECT_NE(outcome.error().message.find("slot 0 holds what no bank can"), std::string::npos);
  }
}

}  // namespace
}  // namespace wisp::hostile_state_test
