// A flame in the round: what the plane model says of it, that it turns with the wind and with who looks, its rings and
// its mesh.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "base/statistics.hpp"
#include "paths.hpp"
#include "run/flame_model.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/body_facet.hpp"
#include "wisp/run/cost.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::round_test {
namespace {

Model shipped_flame() {
  auto model = read_model(WISP_SOURCE_DIR "/apps/web/public/models/flame.wisp");
  EXPECT_TRUE(model) << model.error().message;
  return std::move(model).value();
}

Model round_of(const Model& plane) {
  auto model = in_the_round(plane);
  EXPECT_TRUE(model) << model.error().message;
  return std::move(model).value();
}

// The flame of a wick that stands upright, so that no direction is another one's; its ranges hold it nowhere.
Model upright(Model model) {
  auto& arx = std::get<ArxModel>(model.dynamics);
  ShapeComponents& shape = std::get<OutlineView>(model.view).shape;
  for (std::size_t k = shape.symmetric; k < shape.count(); ++k) arx.constant[k] = 0;
  for (std::size_t k = shape.points(); k < shape.rest.size(); ++k) shape.rest[k] = 0;
  for (auto* ranges : {&shape.components, &shape.coordinates}) {
    for (ValueRange& range : *ranges) range = {range.lowest - 9, range.highest + 9};
  }
  return model;
}

// A flame that follows its rows, as it is learned from films without wind.
Model undriven(Model model) {
  auto& arx = std::get<ArxModel>(model.dynamics);
  const int count = arx.orders.outputs();
  model.inputs.clear();
  model.training.inputs.clear();
  model.extinction.reset();
  arx.orders = {OrderMatrix(count, count), OrderMatrix(count, 0), OrderMatrix(count, 0)};
  for (int i = 0; i < count; ++i) {
    arx.orders.na(i, i) = 1;
    arx.theta[static_cast<std::size_t>(i)] = {-0.8};
  }
  arx.std_error.clear();
  arx.input_mean.clear();
  ResampledResiduals& resampled = arx.noise.resampled;
  resampled.toward = -1;
  resampled.lags.clear(), resampled.winds.clear(), resampled.mirror.clear();
  return model;
}

// Gusts from both sides, calm between, one that blows it out at the end.
float gusts(int frame) {
  if (frame > 1100) return 9.0f;
  if (frame % 300 > 200) return 0;
  return static_cast<float>(std::sin(frame * 0.031) * (0.6 + 0.5 * std::sin(frame * 0.17)));
}

Bank bank_of(const Model& model, int instances = 1) {
  auto bank = Bank::create(model, {.capacity = 16, .seed = 5});
  EXPECT_TRUE(bank) << bank.error().message;
  for (int k = 0; k < instances; ++k) bank->spawn();
  return std::move(bank).value();
}

std::vector<float> outputs_of(const Bank& bank) {
  std::vector<float> values(static_cast<std::size_t>(bank.slots()) * static_cast<std::size_t>(bank.output_count()));
  bank.outputs(values);
  return values;
}

std::vector<float> rings_of(const Bank& bank, InstanceId id) {
  std::vector<float> values(static_cast<std::size_t>(bank.body()->rings()) * kRingNumbers);
  EXPECT_TRUE(bank.body()->read_rings(id, values));
  return values;
}

TEST(InTheRound, WindInThePlaneGivesThePlaneModelsNumbersToTheBit) {
  const Model plane = shipped_flame(), round = round_of(plane);
  for (const int instances : {1, 2, 13}) {
    Bank flat = bank_of(plane, instances), body = bank_of(round, instances);
    ASSERT_EQ(body.input_count(), 2);
    for (int frame = 0; frame < 1300; ++frame) {
      const float wind = gusts(frame);
      const std::array<float, 2> vector{wind, 0};
      flat.set_common_inputs({&wind, 1});
      body.set_common_inputs(vector);
      for (Bank* bank : {&flat, &body}) frame % 3 == 0 ? bank->step() : void(bank->advance(0.013));
      const std::vector<float> want = outputs_of(flat), got = outputs_of(body);
      ASSERT_EQ(std::memcmp(want.data(), got.data(), want.size() * sizeof(float)), 0) << frame;
    }
    EXPECT_EQ(flat.extinction()->state_of(flat.at(0))->lit, body.extinction()->state_of(body.at(0))->lit);
    EXPECT_FALSE(body.extinction()->state_of(body.at(0))->lit);
  }
}

TEST(InTheRound, TurningWindAndViewTurnsThePlay) {
  const Model round = round_of(upright(shipped_flame()));
  Bank still = bank_of(round, 3), turned = bank_of(round, 3);
  const double angle = 0.7;
  const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
  turned.body()->look(c, s);
  double farthest = 0, moved = 0;
  for (int frame = 0; frame < 400; ++frame) {
    const auto x = static_cast<float>(0.3 + 0.5 * std::sin(frame * 0.05)),
               z = static_cast<float>(0.2 * std::cos(frame * 0.07));
    still.set_common_inputs(std::array{x, z});
    turned.set_common_inputs(std::array{c * x - s * z, s * x + c * z});
    still.step(), turned.step();
    const std::vector<float> want = outputs_of(still), got = outputs_of(turned);
    for (std::size_t k = 0; k < want.size(); ++k) {
      farthest = std::max(farthest, std::abs(double{want[k]} - got[k]));
      moved = std::max(moved, std::abs(double{want[k]}));
    }
  }
  EXPECT_LT(farthest, 1e-4);
  EXPECT_GT(moved, 0.5);
}

TEST(InTheRound, WindTowardsTheViewerLeansIntoThePictureAndNotAside) {
  const Model round = round_of(shipped_flame());
  Bank bank = bank_of(round);
  bank.set_noise(0);
  const auto tip = [&](float x, float z) {
    bank.reset();
    bank.set_common_inputs(std::array{x, z});
    for (int frame = 0; frame < 60; ++frame) bank.step();
    const std::vector<float> rings = rings_of(bank, bank.at(0));
    const float* top = &rings[rings.size() - kRingNumbers];
    return std::array{top[0], top[1], top[2]};
  };
  const auto calm = tip(0, 0), aside = tip(0.6f, 0), front = tip(0, 0.6f);
  EXPECT_GT(aside[0] - calm[0], 0.2);
  EXPECT_NEAR(aside[2], calm[2], 1e-6);
  EXPECT_NEAR(front[2] - calm[2], aside[0] - calm[0], 1e-4);
  EXPECT_NEAR(front[0], calm[0], 1e-4);
  EXPECT_NEAR(front[1], aside[1], 0.02);
}

TEST(InTheRound, RingsAreTheOutlinesFromAllSides) {
  Bank bank = bank_of(round_of(shipped_flame()), 9);
  const InstanceId id = bank.at(8);
  bank.set_common_inputs(std::array{0.3f, -0.5f});
  for (int frame = 0; frame < 50; ++frame) bank.step();
  const std::vector<float> rings = rings_of(bank, id);
  std::vector<float> all(static_cast<std::size_t>(bank.slots() * bank.body()->rings()) * kRingNumbers, -1.0f);
  bank.body()->read_rings(all);
  EXPECT_TRUE(std::equal(rings.begin(), rings.end(), all.end() - static_cast<std::ptrdiff_t>(rings.size())));
  std::vector<float> line(static_cast<std::size_t>(2 * bank.polyline_points()));
  for (const double azimuth : {0.0, 0.5, 1.57, 3.14, 5.0}) {
    const auto x = static_cast<float>(std::cos(azimuth)), z = static_cast<float>(-std::sin(azimuth));
    bank.body()->look(x, z);
    bank.polyline(id, line);
    for (int k = 0; k < bank.body()->rings(); ++k) {
      const float* ring = &rings[static_cast<std::size_t>(k) * kRingNumbers];
      const float *left = &line[static_cast<std::size_t>(2 * k)],
                  *right = &line[line.size() - 2 - static_cast<std::size_t>(2 * k)];
      EXPECT_NEAR((left[0] + right[0]) / 2, x * ring[0] + z * ring[2], 1e-5);
      EXPECT_NEAR((left[1] + right[1]) / 2, ring[1], 1e-5);
      EXPECT_NEAR((right[0] - left[0]) / 2, ring[3], 1e-5);
      EXPECT_NEAR((right[1] - left[1]) / 2, x * ring[4] + z * ring[5], 1e-5);
    }
  }
}

TEST(InTheRound, AMeshIsClosedAndItsNormalsPointOutwards) {
  Bank bank = bank_of(round_of(shipped_flame()));
  bank.set_common_inputs(std::array{0.4f, 0.2f});
  for (int frame = 0; frame < 40; ++frame) bank.step();
  const std::vector<float> rings = rings_of(bank, bank.at(0));
  constexpr int kSegments = 12;
  constexpr std::size_t kStride = 8;
  const int count = bank.body()->rings();
  std::vector<float> mesh(static_cast<std::size_t>(count * kSegments) * kStride, -7.0f);
  std::vector<std::uint32_t> triangles(static_cast<std::size_t>(3 * ring_triangle_count(count, kSegments)));
  ring_mesh(rings, kSegments, mesh, kStride);
  ring_triangles(count, kSegments, triangles);
  EXPECT_EQ(mesh[6], -7.0f);
  double volume = 0;
  int agree = 0;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const float* v[3];
    for (int k = 0; k < 3; ++k) v[k] = &mesh[triangles[t + static_cast<std::size_t>(k)] * kStride];
    const auto d = [&](int k, int axis) { return double{v[k][axis]} - v[0][axis]; };
    const double n[3] = {d(1, 1) * d(2, 2) - d(1, 2) * d(2, 1), d(1, 2) * d(2, 0) - d(1, 0) * d(2, 2),
                         d(1, 0) * d(2, 1) - d(1, 1) * d(2, 0)};
    volume += (n[0] * v[0][0] + n[1] * v[0][1] + n[2] * v[0][2]) / 6;
    const double along = n[0] * v[1][3] + n[1] * v[1][4] + n[2] * v[1][5];
    agree += along > 0 ? 1 : 0;
  }
  EXPECT_GT(volume, 0.01);
  EXPECT_LT(volume, 0.2);
  EXPECT_GT(agree, 0.9 * static_cast<double>(triangles.size()) / 3);
}

TEST(InTheRound, AVertexIsItsRingsRimAndASphereHasItsOwnNormals) {
  // Rings of a ball of radius 1 round (0, 1, 0), without its poles.
  std::vector<float> rings;
  for (int k = 1; k < 40; ++k) {
    const double angle = 3.14159265358979 * k / 40;
    for (const double number : {0.0, 1 - std::cos(angle), 0.0, std::sin(angle), 0.0, 0.0}) {
      rings.push_back(static_cast<float>(number));
    }
  }
  std::vector<float> mesh(39 * 32 * kVertexNumbers);
  ring_mesh(rings, 32, mesh);
  for (std::size_t v = 3 * 32 * kVertexNumbers; v < mesh.size() - 3 * 32 * kVertexNumbers; v += kVertexNumbers) {
    EXPECT_NEAR(std::hypot(mesh[v], mesh[v + 1] - 1, mesh[v + 2]), 1, 1e-5);
    const double along = mesh[v] * mesh[v + 3] + (mesh[v + 1] - 1) * mesh[v + 4] + mesh[v + 2] * mesh[v + 5];
    EXPECT_NEAR(along, 1, 1e-3);
  }
}

TEST(InTheRound, ASavedBodyGoesOnWithTheSameBits) {
  const Model round = round_of(shipped_flame());
  Bank bank = bank_of(round, 3), other = bank_of(round);
  const auto blow = [](Bank& one, int frame) {
    one.set_common_inputs(std::array{gusts(frame), gusts(frame + 77)});
    one.step();
  };
  for (int frame = 0; frame < 200; ++frame) blow(bank, frame);
  std::vector<std::byte> bytes(bank.save_bytes());
  bank.save(bytes);
  ASSERT_TRUE(other.restore(bytes));
  for (int frame = 200; frame < 400; ++frame) {
    blow(bank, frame), blow(other, frame);
    ASSERT_EQ(outputs_of(bank), outputs_of(other)) << frame;
  }
  EXPECT_EQ(rings_of(bank, bank.at(1)), rings_of(other, other.at(1)));
}

TEST(InTheRound, AWindTowardsTheViewerBlowsItOutAndItsRingsShrink) {
  Bank bank = bank_of(round_of(shipped_flame()));
  bank.set_common_inputs(std::array{0.0f, 9.0f});
  for (int frame = 0; frame < 300; ++frame) bank.step();
  EXPECT_FALSE(bank.extinction()->state_of(bank.at(0))->lit);
  for (const float number : rings_of(bank, bank.at(0))) EXPECT_EQ(number, 0);
}

TEST(InTheRound, AFlameThatNothingDrivesSwaysInDepthToo) {
  Bank bank = bank_of(round_of(undriven(shipped_flame())));
  std::vector<double> x, z;
  for (int frame = 0; frame < 3000; ++frame) {
    bank.step();
    const std::vector<float> rings = rings_of(bank, bank.at(0));
    x.push_back(rings[rings.size() - kRingNumbers]), z.push_back(rings[rings.size() - kRingNumbers + 2]);
  }
  EXPECT_GT(deviation(z), 0.7 * deviation(x));
  EXPECT_LT(deviation(z), 1.4 * deviation(x));
  double like = 0;
  for (std::size_t k = 0; k < x.size(); ++k)
    like += (x[k] - mean(x)) * (z[k] - mean(z)) / static_cast<double>(x.size());
  EXPECT_LT(std::abs(like), 0.4 * deviation(x) * deviation(z));
}

TEST(InTheRound, CostsAtMostSixTenthsMore) {
  const Model plane = shipped_flame();
  const auto flat = count_operations(plane, 32), body = count_operations(round_of(plane), 32);
  ASSERT_TRUE(flat && body);
  RecordProperty("plane", static_cast<int>(flat->operations_per_frame));
  RecordProperty("round", static_cast<int>(body->operations_per_frame));
  EXPECT_LE(static_cast<double>(body->operations_per_frame), 1.6 * static_cast<double>(flat->operations_per_frame))
      << flat->operations_per_frame << " " << body->operations_per_frame;
}

TEST(InTheRound, AFileHoldsIt) {
  const Model round = round_of(shipped_flame());
  const auto bytes = model_bytes(round);
  ASSERT_TRUE(bytes) << bytes.error().message;
  const auto again = parse_model(*bytes, "round");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_TRUE(is_in_the_round(*again));
  Bank bank = bank_of(round), other = bank_of(*again);
  for (Bank* one : {&bank, &other}) one->set_common_inputs(std::array{0.5f, 0.3f}), one->step(50);
  EXPECT_EQ(outputs_of(bank), outputs_of(other));
}

TEST(InTheRound, WhatIsNoFlameOfTwoKindsOrHasHalfAVectorIsRefused) {
  EXPECT_FALSE(in_the_round(flame_model()));
  EXPECT_FALSE(in_the_round(coupled_flame_model()));
  EXPECT_EQ(bank_of(shipped_flame()).body(), nullptr);
  const Model round = round_of(shipped_flame());
  Model half = round;
  half.inputs.pop_back();
  EXPECT_FALSE(check(half));
  Model askew = round;
  askew.inputs[1].highest *= 2;
  EXPECT_FALSE(check(askew));
  Model few = round;
  std::get<ArxModel>(few.dynamics).noise.resampled.across -= 1;
  EXPECT_FALSE(check(few));
  Model torn = undriven(shipped_flame());
  auto& rows = std::get<ArxModel>(torn.dynamics).noise.resampled;
  rows.across = 1, rows.scale.pop_back();
  rows.rows.resize(rows.row_count() * rows.scale.size());
  EXPECT_FALSE(check(torn));
  Model wide = round;
  wide.inputs[1].lowest *= 2, wide.inputs[1].highest *= 2;
  EXPECT_FALSE(check(wide));
  Model meant = round;
  std::get<ArxModel>(meant.dynamics).input_mean[7] = 0.1;
  EXPECT_FALSE(Bank::create(meant));
}

}  // namespace
}  // namespace wisp::round_test
