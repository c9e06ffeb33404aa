#include "wisp/learn/parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "learn/arx/learn_arx.hpp"
#include "learn/arx/made_system.hpp"

namespace wisp::arx_parts_test {
namespace {

using testing::HasSubstr;

ArxRecipe recipe_of_made() { return {.inputs = {"u1", "u2"}, .outputs = {"y1", "y2"}, .na = 3, .nb = 2, .nk = 1}; }

// Rounding of 1e-16 times the condition number (below 1e3) and a few hundred additions.
void expect_same(const Model& got, const Model& want) {
  const auto &a = std::get<ArxModel>(got.dynamics), &b = std::get<ArxModel>(want.dynamics);
  for (std::size_t i = 0; i < b.theta.size(); ++i) {
    ASSERT_EQ(a.theta[i].size(), b.theta[i].size());
    for (std::size_t p = 0; p < b.theta[i].size(); ++p) EXPECT_NEAR(a.theta[i][p], b.theta[i][p], 1e-11);
  }
  EXPECT_EQ(got.inputs[0].highest, want.inputs[0].highest);
  EXPECT_EQ(got.rate_hz, want.rate_hz);
}

ArxPart part_of(const Recording& recording, const TableShare& share) {
  auto part = ArxPart::create(recipe_of_made());
  EXPECT_TRUE(part) << part.error().message;
  const auto added = part->add(recording, share);
  EXPECT_TRUE(added) << added.error().message;
  return std::move(*part);
}

Fit in_memory(const Recording& recording) {
  auto fit = learn_arx({&recording, 1}, recipe_of_made());
  EXPECT_TRUE(fit) << fit.error().message;
  return std::move(*fit);
}

TEST(ArxParts, SharesThroughBytesMakeTheModelOfAllRows) {
  const Recording recording = record_system(made_system(), 3000, 1);
  auto whole = ArxPart::from_bytes(part_of(recording, {.index = 2, .count = 3}).bytes());
  ASSERT_TRUE(whole) << whole.error().message;
  for (std::size_t index : {0, 1}) {
    const auto part = ArxPart::from_bytes(part_of(recording, {.index = index, .count = 3}).bytes());
    ASSERT_TRUE(part);
    ASSERT_TRUE(whole->merge(*part));
  }
  EXPECT_EQ(whole->rows(), 3000u - 3);
  const auto fit = whole->finish(recipe_of_made(), {"a.part"});
  ASSERT_TRUE(fit) << fit.error().message;
  expect_same(fit->model, in_memory(recording).model);
  EXPECT_THAT(fit->model.training.sources, testing::ElementsAre("a.part"));
  EXPECT_EQ(fit->report.find("fit_percent.inf"), nullptr);  // no rows to simulate
}

TEST(ArxParts, ATableReadAStretchAtATimeMakesTheModelOfItsRangeAndSimulatesIt) {
  const Recording recording = record_system(made_system(), 3000, 1);
  const auto path = std::filesystem::path(testing::TempDir()) / ("parts." + std::to_string(getpid()) + ".csv");
  ASSERT_TRUE(write_csv(path, recording));
  auto part = ArxPart::create(recipe_of_made());
  ASSERT_TRUE(part);
  const auto added = part->add(path, {}, {.first = 100, .rows = 2000});
  const auto beyond = part->add(path, {}, {.first = 100, .rows = 2901});
  const auto fit = part->finish(recipe_of_made(), {path.string()});
  std::filesystem::remove(path);
  ASSERT_TRUE(added) << added.error().message;
  ASSERT_FALSE(beyond);
  EXPECT_THAT(beyond.error().message, HasSubstr("rows 101:3001 were requested, which reach beyond its end"));
  ASSERT_TRUE(fit) << fit.error().message;
  const Fit want = in_memory(slice(recording, 100, 2100));
  expect_same(fit->model, want.model);
  const auto free_run = [](const Fit& of) {
    return std::get<double>(std::get<ReportList>(of.report.find("fit_percent.inf")->value)[0]);
  };
  EXPECT_NEAR(free_run(*fit), free_run(want), 1e-9);
}

TEST(ArxParts, ABadRecordingLeavesNoTrace) {
  const Recording recording = record_system(made_system(), 1000, 1);
  ArxPart part = part_of(recording, {});
  Recording bad = recording;
  bad.channels[0].samples[500] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(part.add(bad));
  const auto fit = part.finish(recipe_of_made(), {});
  ASSERT_TRUE(fit) << fit.error().message;
  expect_same(fit->model, in_memory(recording).model);
}

TEST(ArxParts, WhatNeedsAllRecordingsInMemoryIsRefused) {
  ArxRecipe recipe = recipe_of_made();
  recipe.nk = std::nullopt;
  EXPECT_THAT(ArxPart::create(recipe).error().message, HasSubstr("delays as numbers"));
  recipe = recipe_of_made();
  recipe = recipe_of_made();
  recipe.search = ArxSearch{};
  EXPECT_THAT(ArxPart::create(recipe).error().message, HasSubstr("search first"));
}

}  // namespace
}  // namespace wisp::arx_parts_test
