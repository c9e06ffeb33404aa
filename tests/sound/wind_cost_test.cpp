// What hearing costs, counted by running the real code on numbers that count.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "sound/wind_listener.hpp"
#include "sound/wind_sounds.hpp"

namespace wisp::wind_cost_test {
namespace {

std::int64_t operations = 0;

/// A float that counts + − × ÷ √. Comparisons, conversions and moves are not arithmetic.
struct Counted {
  float value = 0;
  Counted() = default;
  explicit Counted(float x) : value(x) {}

  friend Counted operator+(Counted a, Counted b) { return ++operations, Counted(a.value + b.value); }
  friend Counted operator-(Counted a, Counted b) { return ++operations, Counted(a.value - b.value); }
  friend Counted operator*(Counted a, Counted b) { return ++operations, Counted(a.value * b.value); }
  friend Counted operator/(Counted a, Counted b) { return ++operations, Counted(a.value / b.value); }
  friend Counted sqrt(Counted a) { return ++operations, Counted(std::sqrt(a.value)); }
  friend bool operator<(Counted a, Counted b) { return a.value < b.value; }
  friend bool operator>(Counted a, Counted b) { return a.value > b.value; }
  friend float plain(Counted a) { return a.value; }
};

/// Operations a second of sound while it blows (the dearest case), with 60 frames a second.
double operations_a_second(const SoundFormat& format) {
  const wind::Design design = wind::design(format, {});
  wind::Listener<Counted> listener(design);
  const sounds::Samples mono = sounds::steady_blowing(3, format.rate_hz, 0.1);
  std::vector<float> one(static_cast<std::size_t>(format.channels));
  const int frame = static_cast<int>(format.rate_hz / 60);
  for (std::size_t i = 0; i < mono.size(); ++i) {
    if (i == static_cast<std::size_t>(frame) * 60) operations = 0;
    for (std::size_t c = 0; c < one.size(); ++c) one[c] = mono[c % 2 == 0 ? i : mono.size() - 1 - i];
    listener.push(one.data());
    if ((i + 1) % static_cast<std::size_t>(frame) == 0) (void)listener.end_frame();
  }
  return static_cast<double>(operations) / 2;
}

TEST(WindCost, CountsEveryOperationOnce) {
  operations = 0;
  const Counted x = (Counted(3) + Counted(1)) * Counted(2) - Counted(1) / Counted(4);
  EXPECT_EQ(plain(sqrt(x)), std::sqrt(7.75F));
  EXPECT_EQ(operations, 5);
}

TEST(WindCost, OneChannelCostsAtMostTwoMillionOperationsASecondAtAnyRate) {
  for (const double rate : {8000.0, 11025.0, 15999.0, 16000.0, 22050.0, 32000.0, 44100.0, 48000.0, 63999.0, 88200.0,
                            96000.0, 176400.0, 192000.0}) {
    const double cost = operations_a_second({rate, 1});
    RecordProperty(std::to_string(static_cast<int>(rate)), std::to_string(cost));
    EXPECT_LT(cost, 2e6) << rate;
    EXPECT_GT(cost, 3e5) << rate;
  }
}

TEST(WindCost, TwoChannelsCostAtMostTwoMillionUpTo48Kilohertz) {
  for (const double rate : {8000.0, 16000.0, 22050.0, 44100.0, 48000.0}) {
    const double cost = operations_a_second({rate, 2});
    RecordProperty("stereo_" + std::to_string(static_cast<int>(rate)), std::to_string(cost));
    EXPECT_LT(cost, 2e6) << rate;
  }
}

}  // namespace
}  // namespace wisp::wind_cost_test
