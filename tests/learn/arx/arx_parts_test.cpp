#include "wisp/learn/parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <thread>

#include "learn/arx/learn_arx.hpp"
#include "learn/arx/made_system.hpp"
#include "learn/judge/judged_fit.hpp"

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
  const auto fit = whole->finish(recipe_of_made());
  ASSERT_TRUE(fit) << fit.error().message;
  expect_same(fit->model, in_memory(recording).model);
  EXPECT_THAT(fit->model.training.sources, testing::ElementsAre(recording.source));
  EXPECT_EQ(fit->report.find("fit_percent.inf"), nullptr);  // no rows to simulate
  EXPECT_GT(fit->model.training.operations_per_frame, 0);
  EXPECT_FALSE(fit->model.training.program.empty());
}

TEST(ArxParts, ARangeWhoseEndIsNoNumberReachesBeyondTheEnd) {
  auto part = ArxPart::create(recipe_of_made());
  ASSERT_TRUE(part);
  const auto added = part->add(record_system(made_system(), 100, 1), {.first = 5, .rows = SIZE_MAX - 3});
  ASSERT_FALSE(added);
  EXPECT_THAT(added.error().message, HasSubstr("reach beyond its end"));
}

TEST(ArxParts, ATableReadAStretchAtATimeMakesTheModelOfItsRangeAndSimulatesIt) {
  const Recording recording = record_system(made_system(), 3000, 1);
  const auto path = std::filesystem::path(testing::TempDir()) / ("parts." + std::to_string(getpid()) + ".csv");
  ASSERT_TRUE(write_csv(path, recording));
  auto part = ArxPart::create(recipe_of_made());
  ASSERT_TRUE(part);
  const auto added = part->add(path, {}, {.first = 100, .rows = 2000});
  const auto beyond = part->add(path, {}, {.first = 100, .rows = 2901});
  const auto fit = part->finish(recipe_of_made());
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

// An output that its input does not move: one step ahead its past tells it, in free simulation nothing does.
TEST(ArxParts, ATableThatSimulatesBadlyIsNotUsableAndWithoutItsRowsTheVerdictSaysSo) {
  Recording recording = record_system(made_system(), 4000, 1);
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  auto& y = recording.channels[*find_channel(recording, "y1")].samples;
  for (std::size_t t = 1; t < y.size(); ++t) y[t] = 0.98 * y[t - 1] + normal(generator);
  const auto path = std::filesystem::path(testing::TempDir()) / ("bad." + std::to_string(getpid()) + ".csv");
  ASSERT_TRUE(write_csv(path, recording));
  ArxPart part = *ArxPart::create(recipe_of_made());
  ASSERT_TRUE(part.add(path));
  const auto fit = part.finish(recipe_of_made());
  const auto sent = ArxPart::from_bytes(part.bytes())->finish(recipe_of_made());
  std::filesystem::remove(path);
  ASSERT_TRUE(fit && sent);
  EXPECT_FALSE(fit->report.verdict->usable);
  EXPECT_THAT(fit->report.verdict->reason, testing::Not(testing::HasSubstr("shows no cause")));  // nobody looked
  EXPECT_THAT(fit->report.verdict->reason, HasSubstr("free simulation from the input fits 'y1'"));
  EXPECT_THAT(sent->report.verdict->reason, HasSubstr("free simulation was not judged"));
  EXPECT_THAT(sent->report.verdict->reason, HasSubstr("no row was held out: validate the model on another recording"));
}

TEST(ArxParts, ABadRecordingLeavesNoTrace) {
  const Recording recording = record_system(made_system(), 1000, 1);
  ArxPart part = part_of(recording, {});
  Recording bad = recording;
  bad.channels[0].samples[500] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(part.add(bad));
  const auto fit = part.finish(recipe_of_made());
  ASSERT_TRUE(fit) << fit.error().message;
  expect_same(fit->model, in_memory(recording).model);
}

// Two outputs, an input, episodes of 1000 rows and one of 2, some missing samples, far from zero.
Recording sample_recording(std::size_t rows = 3000) {
  std::mt19937_64 generator(12);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.source = "sample";
  recording.rate_hz = 60;
  recording.channels = {{"u", "", Role::kInput, std::vector<double>(rows)},
                        {"y1", "", Role::kOutput, std::vector<double>(rows)},
                        {"y2", "", Role::kOutput, std::vector<double>(rows)}};
  auto& u = recording.channels[0].samples;
  auto& y1 = recording.channels[1].samples;
  auto& y2 = recording.channels[2].samples;
  for (std::size_t t = 0; t < rows; ++t) {
    u[t] = normal(generator);
    y1[t] = 0.1 * normal(generator);
    y2[t] = 0.1 * normal(generator);
    if (t >= 2) {
      y1[t] += 1.4 * y1[t - 1] - 0.7 * y1[t - 2] + 0.1 * y2[t - 1] + u[t - 1];
      y2[t] += 0.6 * y2[t - 1] - 0.2 * y1[t - 1] + 0.3 * u[t - 2];
    }
    recording.episode_ids.push_back(t < 1000 ? 0 : t < 1002 ? 1 : 2);
  }
  for (double& sample : y1) sample += 100;
  for (double& sample : u) sample -= 30;
  u[0] = std::numeric_limits<double>::quiet_NaN();
  if (rows > 1500) y1[1500] = std::numeric_limits<double>::quiet_NaN();
  if (rows > 2500) u[2500] = std::numeric_limits<double>::quiet_NaN();
  return recording;
}

ArxRecipe recipe_of_sample(ArxOffset offset = ArxOffset::kMean) {
  ArxRecipe recipe{.inputs = {"u"}, .outputs = {"y1", "y2"}, .na = 3, .nb = 2, .nk = 1};
  recipe.offset = offset;
  recipe.keep_unstable = true;  // a repair magnifies rounding: it ends where a search ends
  return recipe;
}

ArxPart empty() { return *ArxPart::create(recipe_of_sample()); }

// The fit of all rows in memory against that of a part, by what reports say of them.
void expect_fit(const ArxPart& part, const Recording& recording, ArxOffset offset = ArxOffset::kMean) {
  const ArxRecipe recipe = recipe_of_sample(offset);
  const auto got = part.finish(recipe);
  ASSERT_TRUE(got) << got.error().message;
  const auto orders = arx::orders_of(3, 2, 1, Coupling::kFull, {{"u"}, {"y1", "y2"}});
  const auto want = fit_arx({&recording, 1}, {{"u"}, {"y1", "y2"}}, arx::fit_options(recipe, *orders));
  ASSERT_TRUE(want) << want.error().message;
  const auto& model = std::get<ArxModel>(got->model.dynamics);
  const auto list = [&](const char* id) { return std::get<ReportList>(got->report.find(id)->value); };
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t p = 0; p < want->model.theta[i].size(); ++p) {
      EXPECT_NEAR(model.theta[i][p], want->model.theta[i][p], 1e-11);
      EXPECT_NEAR(model.std_error[i][p], want->model.std_error[i][p], 1e-11);
    }
    EXPECT_NEAR(std::get<double>(list("V")[i]) / want->summary.loss[i], 1, 1e-11);
    EXPECT_NEAR(std::get<double>(list("fit_percent.1")[i]), want->summary.fit_percent[i], 1e-9);
    EXPECT_NEAR(model.output_mean[i], want->model.output_mean[i], 1e-12);
    EXPECT_NEAR(model.constant[i], want->model.constant[i], 1e-10);
  }
  const auto number = [&](const char* id) { return std::get<std::int64_t>(got->report.find(id)->value); };
  EXPECT_EQ(number("samples_used"), want->summary.rows);
  EXPECT_EQ(number("first_sample"), want->summary.first_sample);
  EXPECT_EQ(number("rows_left_out"), want->summary.rows_left_out);
  EXPECT_EQ(number("episodes.used"), want->summary.episodes_used);
  EXPECT_EQ(number("episodes.skipped"), want->summary.episodes_skipped);
}

std::filesystem::path table_of(const Recording& recording) {
  const auto path = std::filesystem::path(testing::TempDir()) / ("sample." + std::to_string(getpid()) + ".csv");
  EXPECT_TRUE(write_csv(path, recording));
  return path;
}

TEST(ArxParts, TheFitIsTheSameHoweverTheRowsAreCut) {
  const Recording recording = sample_recording();
  for (ArxOffset offset : {ArxOffset::kMean, ArxOffset::kNone, ArxOffset::kEstimate}) {
    for (std::size_t parts : {1u, 2u, 3u, 8u, 100u}) {
      ArxPart all = empty();
      for (std::size_t k = parts; k-- > 0;) {  // the last first
        ArxPart part = empty();
        ASSERT_TRUE(part.add(recording, {.index = k, .count = parts}));
        ASSERT_TRUE(all.merge(part));
      }
      expect_fit(all, recording, offset);
    }
  }
}

TEST(ArxParts, SharesOfATableAreThoseOfTheRecording) {
  const Recording recording = sample_recording(150000);  // more than two stretches
  const auto path = table_of(recording);
  for (std::size_t count : {1u, 2u, 50u}) {
    ArxPart all = empty();
    for (std::size_t k = 0; k < count; ++k) {
      ArxPart part = empty(), want = empty();
      ASSERT_TRUE(part.add(path, {}, {.index = k, .count = count}));
      ASSERT_TRUE(want.add(recording, {.index = k, .count = count}));
      EXPECT_EQ(part.rows(), want.rows()) << k << " of " << count;
      ASSERT_TRUE(all.merge(part));
    }
    expect_fit(all, recording);
  }
  std::filesystem::remove(path);
}

TEST(ArxParts, SurviveTheirBytes) {
  ArxPart part = empty();
  ASSERT_TRUE(part.add(sample_recording()));
  const auto again = ArxPart::from_bytes(part.bytes());
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->bytes(), part.bytes());
  expect_fit(*again, sample_recording());
}

// The most memory in use while a table of that many rows is read.
std::size_t max_bytes_while_reading(std::size_t rows) {
  const auto path = std::filesystem::path(testing::TempDir()) / ("long." + std::to_string(getpid()) + ".csv");
  std::ofstream out(path);
  std::mt19937 random(4);
  double y1 = 0, y2 = 0;
  out << "# wisp-recording 1\n# rate_hz 60\nu:u,y:y1,y:y2\n";
  for (std::size_t row = 0; row < rows; ++row) {
    const auto u = static_cast<double>(random() % 1000), before = y1;
    y1 = 0.5 * y1 - 0.2 * y2 + u + static_cast<double>(random() % 100);
    y2 = 0.3 * y2 + 0.1 * before + static_cast<double>(random() % 100);
    out << u << "," << y1 << "," << y2 << "\n";
  }
  out.close();
  std::atomic<std::size_t> most = 0;
  std::atomic<bool> done = false;
  std::thread watch([&] {
    for (; !done; std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
      const struct mallinfo2 heap = mallinfo2();
      most = std::max(most.load(), heap.uordblks + heap.hblkhd);
    }
  });
  ArxPart part = empty();
  EXPECT_TRUE(part.add(path));
  done = true;
  watch.join();
  std::filesystem::remove(path);
  EXPECT_EQ(part.rows(), rows - 3);
  return most;
}

TEST(ArxParts, MemoryDoesNotGrowWithTheTable) {
  max_bytes_while_reading(200000);  // whatever is allocated once and kept
  const std::size_t some = max_bytes_while_reading(200000);
  const std::size_t many = max_bytes_while_reading(1600000);
  // The rows between would be 34 MB as numbers.
  EXPECT_LT(many, some + 2'000'000);  // looked at every millisecond
}

TEST(ArxParts, KnowRangesAndRate) {
  const Recording recording = sample_recording();
  ArxPart first = empty(), second = empty();
  ASSERT_TRUE(first.add(recording, {.index = 0, .count = 2}));
  ASSERT_TRUE(second.add(recording, {.index = 1, .count = 2}));
  ASSERT_TRUE(second.merge(first));
  const auto fit = second.finish(recipe_of_sample());
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->model.rate_hz, 60);
  for (const Output& output : fit->model.outputs) {
    auto samples = recording.channels[*find_channel(recording, output.name)].samples;
    std::erase_if(samples, [](double sample) { return std::isnan(sample); });
    EXPECT_EQ(output.lowest, *std::min_element(samples.begin(), samples.end()));
    EXPECT_EQ(output.highest, *std::max_element(samples.begin(), samples.end()));
  }
}

TEST(ArxParts, EveryChangedByteAndEveryCutIsNoticed) {
  ArxPart part = empty();
  ASSERT_TRUE(part.add(sample_recording(50)));
  const std::vector<std::byte> bytes = part.bytes();
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    std::vector<std::byte> changed = bytes;
    changed[k] ^= std::byte{4};
    EXPECT_FALSE(ArxPart::from_bytes(changed)) << k;
    EXPECT_FALSE(ArxPart::from_bytes(std::span(bytes).first(k))) << k;
  }
}

TEST(ArxParts, OfAnotherModelOrOfTheSameRowsAreRefused) {
  ArxRecipe recipe = recipe_of_sample();
  recipe.na = 4;
  ArxPart part = empty();
  EXPECT_THAT(part.merge(*ArxPart::create(recipe)).error().message, HasSubstr("their orders differ"));
  ASSERT_TRUE(part.add(sample_recording()));
  EXPECT_THAT(part.add(sample_recording(), {.index = 1, .count = 2}).error().message,
              HasSubstr("sample: rows 1501:3000 of sample are in both"));
}

TEST(ArxParts, InOtherUnitsAreRefusedAndAfterAClockThatDiffersALittleAreNot) {
  Recording first = record_system(made_system(), 300, 1), second = record_system(made_system(), 300, 2);
  first.channels[2].unit = "m", second.rate_hz *= 1.0003;
  ArxPart part = part_of(first, {});
  EXPECT_TRUE(part.merge(part_of(second, {})));
  second = record_system(made_system(), 300, 3);
  second.channels[2].unit = "cm";
  EXPECT_THAT(part.add(second).error().message, HasSubstr("their units (m, cm) differ"));
}

TEST(ArxParts, WithoutRowsCannotBeFinished) {
  EXPECT_FALSE(empty().finish(recipe_of_sample()));
  ArxPart part = empty();
  ASSERT_TRUE(part.add(sample_recording(), {.rows = 5}));
  EXPECT_FALSE(part.finish(recipe_of_sample()));
}

TEST(ArxParts, SharesAreOfAllRowsOnceAndEven) {
  std::size_t rows = 0;
  for (std::size_t k = 0; k < 7; ++k) {
    auto part = ArxPart::create({.outputs = {"y1"}, .na = 1, .nb = 0, .nk = 1});
    ASSERT_TRUE(part);
    Recording recording = sample_recording(101);
    recording.episode_ids.clear();
    ASSERT_TRUE(part->add(recording, {.index = k, .count = 7}));
    EXPECT_GE(part->rows(), 14u);
    EXPECT_LE(part->rows(), 15u);
    rows += part->rows();
  }
  EXPECT_EQ(rows, 100u);
}

TEST(ArxParts, WhatNeedsAllRecordingsInMemoryIsRefused) {
  ArxRecipe recipe = recipe_of_made();
  recipe.nk = std::nullopt;
  EXPECT_THAT(ArxPart::create(recipe).error().message, HasSubstr("delays as numbers"));
  recipe = recipe_of_made();
  recipe.search = ArxSearch{};
  EXPECT_THAT(ArxPart::create(recipe).error().message, HasSubstr("search first"));
}

}  // namespace
}  // namespace wisp::arx_parts_test
