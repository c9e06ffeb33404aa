#include "draw/flame/flame_layers.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace wisp::drawing::light_field_test {
namespace {

double total(const Plane& plane) { return std::accumulate(plane.values.begin(), plane.values.end(), 0.0); }

TEST(LightField, AHaloHoldsTheLightThatItSpreads) {
  for (const float sigma : {1.0F, 3.0F, 9.0F, 25.0F}) {
    LightField field(257, 255);
    field.add(128, 127, {1, 1, 1});
    const HaloRing ring{sigma, {0.5F, 0, 0}};
    add_halo(field, std::span(&ring, 1));
    // Coarse grids lose nothing; the Gaussian is cut at three standard deviations and made whole again.
    EXPECT_NEAR(total(field.red), 1.5, 0.02) << "sigma " << sigma;
    EXPECT_NEAR(total(field.green), 1.0, 1e-4) << "sigma " << sigma;
  }
}

TEST(LightField, AHaloIsRoundAndFallsOff) {
  LightField field(201, 201);
  field.add(100, 100, {100, 100, 100});
  const HaloRing ring{12, {1, 1, 1}};
  add_halo(field, std::span(&ring, 1));
  float last = field.red.row(100)[102];
  for (int x = 104; x < 136; x += 2) {
    EXPECT_LT(field.red.row(100)[x], last) << "at " << x;
    last = field.red.row(100)[x];
  }
  const float across = field.red.row(100)[120];
  const float down = field.red.row(120)[100];
  const float aslant = field.red.row(114)[114];
  EXPECT_NEAR(down / across, 1, 0.05);
  EXPECT_NEAR(aslant / across, 1, 0.08);
}

TEST(LightField, AHaloFollowsItsLightBetweenTheCellsOfItsGrid) {
  const HaloRing ring{30, {1, 1, 1}};
  for (int place = 120; place < 136; ++place) {
    LightField field(256, 64);
    field.add(place, 32, {1, 1, 1});
    add_halo(field, std::span(&ring, 1));
    double sum = 0, weighted = 0;
    for (int x = 0; x < 256; ++x) {
      sum += field.green.row(32)[x];
      weighted += static_cast<double>(field.green.row(32)[x]) * x;
    }
    EXPECT_NEAR(weighted / sum, place, 0.5);
  }
}

TEST(LightField, NoLightLeavesThePictureAsItIs) {
  Image image(40, 30, {13, 77, 201, 255});
  const Image before = image;
  add_light(image, LightField(40, 30));
  EXPECT_EQ(image, before);
}

TEST(LightField, LightOnlyBrightens) {
  Image image(64, 1);
  for (int x = 0; x < 64; ++x) image.row(0)[x] = 0xFF000000U | static_cast<std::uint32_t>(x * 4) * 0x010101U;
  const Image before = image;
  LightField field(64, 1);
  for (int x = 0; x < 64; ++x) field.add(x, 0, {0.001F, 0.1F, 10});
  add_light(image, field);
  for (int x = 0; x < 64; ++x) {
    EXPECT_GE(image.at(x, 0).red, before.at(x, 0).red);
    EXPECT_GT(image.at(x, 0).green + 1, before.at(x, 0).green);
    EXPECT_GT(image.at(x, 0).blue, 250);
  }
}

}  // namespace
}  // namespace wisp::drawing::light_field_test
