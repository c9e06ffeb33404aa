#include "run/state/channels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "wisp/model/input_curve.hpp"

namespace wisp::channels_test {
namespace {

// The pieces of a curve, as a bank has them.
class Pieces {
 public:
  explicit Pieces(const InputCurve& curve) {
    model_.inputs = {{"u", "", curve.at.front(), curve.at.back(), InputShape::kCurve, curve}};
    const double mean = 0;
    const OperatingPoint point{{}, {&mean, 1}};
    Arena measured;
    make_channels(model_, point, measured);
    memory_.resize(measured.bytes());
    Arena arena(memory_);
    pieces_ = make_channels(model_, point, arena).regressors[0].curve;
  }

  float operator()(float input) const { return bend(pieces_, input); }

 private:
  Model model_;
  std::vector<std::byte> memory_;
  std::span<const CurvePiece> pieces_;
};

// Calls use(x) for floats around `middle`, as near to each other as floats are.
template <class Use>
void around(double middle, Use use) {
  auto x = static_cast<float>(middle);
  for (int k = 0; k < 8; ++k) x = std::nextafter(x, -std::numeric_limits<float>::max());
  for (int k = 0; k < 16; ++k, x = std::nextafter(x, std::numeric_limits<float>::max())) use(x);
}

TEST(Curve, IsTheCurveWithinRounding) {
  const InputCurve curve{{-0.4, 0.3, 0.55, 0.8, 1}, {-0.4, 0.07, 0.32, 0.9, 1}};
  const Pieces bent(curve);
  for (float x = -2; x < 2; x += 0.001f) EXPECT_NEAR(bent(x), value_at(curve, x), 1e-6) << x;
}

TEST(Channels, UnitsArePowersOfTwoWhereARangeIsFarFromOne) {
  EXPECT_EQ(channel_scale(-0.5, 0.5), 1.0);
  EXPECT_EQ(channel_scale(0, 128), 1.0);
  EXPECT_EQ(channel_scale(0, 1.0 / 128), 1.0);
  EXPECT_EQ(channel_scale(-100, 100), 128.0);
  EXPECT_EQ(channel_scale(0, 0.001), 0x1p-10);
  EXPECT_EQ(channel_scale(3, 3), 1.0);
}

// Knots that single precision can hardly distinguish, and slopes up to a million, are the hard case.
TEST(Curve, NeverFallsNotEvenByRounding) {
  const std::vector<InputCurve> curves{
      {{0, 0.3, 0.55, 0.8, 1}, {0, 0.07, 0.32, 0.9, 1}},
      {{0, 1.0 / 3, 1.0 / 3 + 1e-6, 1}, {0, 0, 1, 1}},
      {{-1000.02, 33.3, 40}, {-1000.02, 30, 40}},
      {{1000, 1000.1, 1000.1001, 1001}, {1000, 1000, 1001, 1001}},
      {{1000, 1000.1, 1000.100002, 1001}, {1000, 1000, 1001, 1001}},
  };
  for (const InputCurve& curve : curves) {
    const Pieces bent(curve);
    for (double knot : curve.at) {
      float before = -std::numeric_limits<float>::max();
      around(knot, [&](float x) {
        EXPECT_GE(bent(x), before) << "at " << x << ", the knot is " << knot;
        before = bent(x);
      });
    }
    EXPECT_LE(bent(static_cast<float>(curve.at.back())), curve.value.back() * (1 + 1e-5));
  }
}

}  // namespace
}  // namespace wisp::channels_test
