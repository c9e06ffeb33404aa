// How a chain goes from one segment to the next: neither place nor attitude jumps.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "model/sample_chain.hpp"
#include "model/sample_model.hpp"
#include "run/chain/chain_stepper.hpp"
#include "run/chain/poses.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"

namespace wisp::chain_joins_test {
namespace {

using poses::agreement;
using poses::bank_of;
using poses::distance;
using poses::Pose;
using poses::pose_of;

TEST(ChainBank, PositionNeverJumps) {
  for (const Model& model : {sample_chain(), unblended(), sample_chain(ChainMotion::kPosition)}) {
    Bank bank = bank_of(model);
    Pose before = pose_of(bank);
    for (int step = 0; step < 2000; ++step) {
      bank.step();
      const Pose now = pose_of(bank);
      // A step of the sample is 16 to 17 mm; while a join fades, the difference of rates is added.
      EXPECT_LT(distance(before, now), 0.025) << step;
      before = now;
    }
  }
}

TEST(ChainBank, HeadingIsCarriedOverJoins) {
  // Two segments that turn on and on: the turn over a long walk is what all its segments turned.
  Bank bank = bank_of(sample_chain());
  const auto heading = [](const Pose& pose) { return 2 * std::atan2(pose[6], pose[3]); };
  double turned = 0, expected = 0;
  double before = heading(pose_of(bank));
  for (int step = 0; step < 3000; ++step) {
    const std::uint32_t segment = bank.chain()->place_of(bank.at(0))->segment;
    bank.step();
    const double now = heading(pose_of(bank));
    turned += std::remainder(now - before, 2 * std::acos(-1.0));
    expected += sample_turn(segment);
    before = now;
  }
  EXPECT_NEAR(turned, expected, 0.02 * expected);
}

TEST(ChainBank, AWorldFramedChainKeepsItsHeading) {
  Model model = unblended();
  std::get<ChainModel>(model.dynamics).heading_free = false;
  Bank bank = bank_of(model);
  for (int step = 0; step < 300; ++step) {
    const Pose before = pose_of(bank);
    bank.step();
    // Every step of every segment of the sample goes 10 mm along x.
    EXPECT_NEAR(pose_of(bank)[0] - before[0], 0.01, 1e-4);
  }
}

TEST(ChainBank, BlendedOrientationDoesNotJumpAndAnUnblendedOneDoes) {
  const auto min_agreement = [](const Model& model) {
    Bank bank = bank_of(model);
    Pose before = pose_of(bank);
    double least = 1;
    for (int step = 0; step < 3000; ++step) {
      bank.step();
      const Pose now = pose_of(bank);
      least = std::min(least, agreement(before, now));
      before = now;
    }
    return least;
  };
  EXPECT_LT(min_agreement(unblended()), std::cos(0.09));
  EXPECT_GT(min_agreement(sample_chain()), std::cos(0.09));
}

// The tilt of a pose: joins turn a segment about z, which leaves it.
double tilt_of(const Pose& pose) { return 1 - 2 * (pose[4] * pose[4] + pose[5] * pose[5]); }

// Tilt as a segment has it at a row.
double stored_tilt(const ChainModel& chain, std::uint32_t segment, std::uint32_t row) {
  const std::int16_t* q = chain.segments.rows.data() + 7 * (segment_rows(chain.segments)[segment] + row) + 3;
  double square = 0;
  for (std::size_t k = 0; k < 4; ++k) square += static_cast<double>(q[k]) * q[k];
  return 1 - 2 * (static_cast<double>(q[1]) * q[1] + static_cast<double>(q[2]) * q[2]) / square;
}

TEST(ChainBank, NeighboursMeetHalfWay) {
  constexpr int kInstances = 3;
  for (const int blend : {2, 6, 4096}) {  // shorter than half of any segment, than half of some, and longer
    Model model = sample_chain();
    auto& chain = std::get<ChainModel>(model.dynamics);
    chain.blend_steps = blend;
    Bank bank = bank_of(model, kInstances);
    std::array<std::uint32_t, kInstances> segment{};
    for (int slot = 0; slot < kInstances; ++slot) segment[slot] = bank.chain()->place_of(bank.at(slot))->segment;
    int joins = 0;
    for (int step = 0; step < 2000; ++step) {
      bank.step();
      for (int slot = 0; slot < kInstances; ++slot) {
        const ChainPlace place = *bank.chain()->place_of(bank.at(slot));
        if (place.step != 0) continue;
        // Each segment of the sample is tilted all along, by an angle of its own.
        const double before = std::acos(stored_tilt(chain, segment[slot], chain.segments.steps[segment[slot]]));
        const double after = std::acos(stored_tilt(chain, place.segment, 0));
        EXPECT_NEAR(std::acos(tilt_of(pose_of(bank, slot))), (before + after) / 2, 2e-3) << blend << ' ' << step;
        if (segment[slot] != place.segment) ++joins;
        segment[slot] = place.segment;
      }
    }
    EXPECT_GT(joins, 300);
  }
}

TEST(ChainBank, AJoinReachesNoFurtherThanItsBlendOnEitherSide) {
  Model model = sample_chain();
  auto& chain = std::get<ChainModel>(model.dynamics);
  chain.blend_steps = 2;
  Bank bank = bank_of(model);
  for (int step = 0; step < 2000; ++step) {
    bank.step();
    const ChainPlace place = *bank.chain()->place_of(bank.at(0));
    const std::uint32_t steps = chain.segments.steps[place.segment];
    if (place.step < 2 || place.step > steps - 2) continue;
    EXPECT_NEAR(tilt_of(pose_of(bank)), stored_tilt(chain, place.segment, place.step), 1e-4) << step;
  }
}

TEST(ChainBank, AJoinSpreadsItsDifferenceOfVelocity) {
  Model model = sample_chain(ChainMotion::kPosition);
  auto& chain = std::get<ChainModel>(model.dynamics);
  chain.heading_free = false;
  // Segments move at 0.6, 0.9 and 0.6 m/s along x, all along.
  const auto first = segment_rows(chain.segments);
  for (std::uint32_t row = first[1]; row < first[2]; ++row) {
    chain.segments.rows[3 * row] = static_cast<std::int16_t>(1500 * (row - first[1]));
  }
  for (std::size_t end : {0U, 1U}) chain.segments.rates[3 * (2 + end)] = 9000;
  Bank bank = bank_of(model);
  double before = 0, speed = 0, most = 0;
  for (int step = 0; step < 2000; ++step) {
    bank.step();
    const double now = pose_of(bank)[0];
    if (step > 0) most = std::max(most, std::abs((now - before) * 60 - speed));
    speed = (now - before) * 60;
    before = now;
  }
  // 0.15 m/s are taken off over 5 steps at least, 0.06 m/s in the two halves of steps beside a join.
  EXPECT_GT(most, 0.02);
  EXPECT_LT(most, 0.075);
}

TEST(ChainBank, QuaternionsStayUnitAndTheirSignNeverFlips) {
  Bank bank = bank_of(sample_chain());
  Pose before = pose_of(bank);
  for (int step = 0; step < 100'000; ++step) {
    bank.step();
    const Pose q = pose_of(bank);
    const double square = q[3] * q[3] + q[4] * q[4] + q[5] * q[5] + q[6] * q[6];
    // Sixteen bits a component, and single precision.
    ASSERT_NEAR(square, 1, 2e-4) << step;
    ASSERT_GT(before[3] * q[3] + before[4] * q[4] + before[5] * q[5] + before[6] * q[6], 0) << step;
    before = q;
  }
}

// No step turns far, and none to the same attitude's other sign.
void expect_steady_attitude(Bank& bank) {
  Pose before = pose_of(bank);
  for (int step = 0; step < 2000; ++step) {
    bank.step();
    const Pose q = pose_of(bank);
    ASSERT_GT(before[3] * q[3] + before[4] * q[4] + before[5] * q[5] + before[6] * q[6], 0.9) << step;
    before = q;
  }
}

TEST(ChainBank, AWorldFramedQuaternionsSignNeverFlips) {
  Model model = sample_chain();
  auto& chain = std::get<ChainModel>(model.dynamics);
  chain.heading_free = false;
  // Segment 1 says the same with the other sign.
  for (std::size_t row = 9; row < 9 + 6; ++row) {
    for (std::size_t k = 3; k < 7; ++k) chain.segments.rows[7 * row + k] *= -1;
  }
  Bank bank = bank_of(model);
  expect_steady_attitude(bank);
}

// Segments that keep their attitude, one of which is stored with the other sign, or heads the other way.
TEST(ChainBank, AJoinTurnsBackHowASegmentIsStored) {
  for (const bool about : {false, true}) {
    Model model = sample_chain();
    auto& segments = std::get<ChainModel>(model.dynamics).segments;
    const auto first = segment_rows(segments);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int16_t* of = &segments.rows[7 * first[k] + 3];
      const std::array<std::int16_t, 4> q{of[0], of[1], 0, 0};
      std::array<int, 4> stored{q[0], q[1], 0, 0};
      if (k == 1) stored = about ? std::array<int, 4>{0, 0, q[1], q[0]} : std::array<int, 4>{-q[0], -q[1], 0, 0};
      for (std::size_t row = first[k]; row < first[k + 1]; ++row)
        std::copy_n(stored.begin(), 4, &segments.rows[7 * row + 3]);
    }
    for (std::size_t end = 0; end < 6; ++end) segments.rates[6 * end + 5] = 0;
    Bank bank = bank_of(model);
    expect_steady_attitude(bank);
  }
}

// What moves without an attitude heads where it moves.
TEST(ChainBank, APositionsHeadingAtTheEndOfASegmentIsThatOfTheNext) {
  Model model = sample_chain(ChainMotion::kPosition);
  auto& chain = std::get<ChainModel>(model.dynamics);
  chain.blend_steps = 0;
  for (std::size_t k = 0; k < 3; ++k) {  // ends a right angle to the left of how it began
    std::int16_t* rates = &chain.segments.rates[6 * k];
    rates[3] = static_cast<std::int16_t>(-rates[1]);
    rates[4] = rates[0];
  }
  Bank bank = bank_of(model);
  Pose before = pose_of(bank);
  double heading = 0;
  int joins = 0;
  for (int step = 0; step < 500; ++step) {
    bank.step();
    const Pose now = pose_of(bank);
    const double next = std::atan2(now[1] - before[1], now[0] - before[0]);
    if (bank.chain()->place_of(bank.at(0))->step == 1) {
      if (joins > 0) {
        EXPECT_NEAR(std::remainder(next - heading - std::acos(0.0), 4 * std::acos(0.0)), 0, 1e-3);
      }
      heading = next;
      ++joins;
    }
    before = now;
  }
  EXPECT_GT(joins, 30);
}

}  // namespace
}  // namespace wisp::chain_joins_test
