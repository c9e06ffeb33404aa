#pragma once
// A bank of a chain, and where its instances are.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "wisp/run/bank.hpp"

namespace wisp::poses {

using Pose = std::array<float, 7>;

inline Bank bank_of(const Model& model, int capacity = 1, std::uint64_t seed = 1) {
  auto bank = Bank::create(model, {.capacity = capacity, .seed = seed});
  EXPECT_TRUE(bank) << bank.error().message;
  for (int k = 0; k < capacity; ++k) bank->spawn();
  return std::move(bank).value();
}

inline Pose pose_of(const Bank& bank, int slot = 0) {
  Pose pose{};
  EXPECT_TRUE(bank.outputs(bank.at(slot), std::span(pose).first(bank.output_count())));
  return pose;
}

inline double distance(const Pose& a, const Pose& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

// Cosine of half the angle between two orientations.
inline double agreement(const Pose& a, const Pose& b) {
  return std::abs(a[3] * b[3] + a[4] * b[4] + a[5] * b[5] + a[6] * b[6]);
}

}  // namespace wisp::poses
