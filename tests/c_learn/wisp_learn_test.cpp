#include "wisp/wisp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "wisp/learn/learn.hpp"
#include "wisp/model/file.hpp"

namespace wisp::wisp_learn_test {
namespace {

struct Table {
  std::vector<double> wind, lean;
};

// A swing of two lags that wind drives, with noise.
Table table(std::size_t rows, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Table made{std::vector<double>(rows), std::vector<double>(rows)};
  for (std::size_t t = 0; t < rows; ++t) {
    made.wind[t] = std::sin(0.03 * static_cast<double>(t));
    made.lean[t] = 0.01 * normal(random);
    if (t > 1) made.lean[t] += 1.6 * made.lean[t - 1] - 0.8 * made.lean[t - 2] + 0.1 * made.wind[t - 1];
  }
  return made;
}

wisp_recording* recording_of(const Table& table) {
  wisp_recording* recording = nullptr;
  EXPECT_EQ(wisp_recording_create(50, &recording), WISP_OK);
  EXPECT_EQ(wisp_recording_add(recording, WISP_ROLE_INPUT, "wind", "m/s", table.wind.data(), table.wind.size()),
            WISP_OK);
  EXPECT_EQ(wisp_recording_add(recording, WISP_ROLE_OUTPUT, "lean", nullptr, table.lean.data(), table.lean.size()),
            WISP_OK);
  return recording;
}

Recording same_in_cpp(const Table& table) {
  return {.source = "the recording",
          .rate_hz = 50,
          .channels = {{"wind", "m/s", Role::kInput, table.wind}, {"lean", "", Role::kOutput, table.lean}}};
}

std::vector<std::byte> model_of(const wisp_fit* fit) {
  const void* bytes = nullptr;
  std::size_t size = 0;
  EXPECT_EQ(wisp_fit_get_model(fit, &bytes, &size), WISP_OK) << wisp_last_error();
  const auto* begin = static_cast<const std::byte*>(bytes);
  return {begin, begin + size};
}

class CLearn : public testing::Test {
 protected:
  CLearn() : recording_(recording_of(table(800))) {}
  ~CLearn() override {
    wisp_recording_free(recording_);
    wisp_fit_free(fit_);
  }

  wisp_status learn(const wisp_recipe& recipe, wisp_progress progress = nullptr) {
    return wisp_learn(&recording_, 1, &recipe, progress, nullptr, &fit_);
  }

  wisp_recording* recording_ = nullptr;
  wisp_fit* fit_ = nullptr;
};

TEST_F(CLearn, FromArraysIsWhatCppLearnsToTheByte) {
  wisp_recipe recipe = wisp_recipe_default(WISP_RECIPE_ARX);
  recipe.na = 2;
  recipe.nb = 1;
  recipe.name = "swing";
  ASSERT_EQ(learn(recipe), WISP_OK) << wisp_last_error();
  const auto fit = wisp::learn(same_in_cpp(table(800)),
                               ArxRecipe{.name = "swing", .inputs = {"wind"}, .outputs = {"lean"}, .na = 2, .nb = 1});
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(model_of(fit_), *model_bytes(fit->model));
  EXPECT_EQ(wisp_fit_usable(fit_), fit->model.training.usable.verdict ? 1 : 0);
  EXPECT_EQ(wisp_fit_reason(fit_), fit->model.training.usable.reason);
}

TEST_F(CLearn, EpisodesAndSeveralRecordingsCount) {
  std::vector<std::int64_t> ids(800, 0);
  std::fill(ids.begin() + 400, ids.end(), 1);
  ASSERT_EQ(wisp_recording_set_episodes(recording_, ids.data(), ids.size()), WISP_OK);
  ASSERT_EQ(wisp_recording_set_attribute(recording_, "pair", "a"), WISP_OK);
  wisp_recording* second = recording_of(table(600, 2));
  const wisp_recording* both[] = {recording_, second};
  const wisp_recipe recipe = wisp_recipe_default(WISP_RECIPE_ARX);
  ASSERT_EQ(wisp_learn(both, 2, &recipe, nullptr, nullptr, &fit_), WISP_OK) << wisp_last_error();
  wisp_recording_free(second);
  std::vector<Recording> recordings{same_in_cpp(table(800)), same_in_cpp(table(600, 2))};
  recordings[0].source += " 0";
  recordings[1].source += " 1";
  recordings[0].episode_ids = ids;
  recordings[0].attributes = {{"pair", "a"}};
  const auto fit = wisp::learn(recordings, ArxRecipe{.inputs = {"wind"}, .outputs = {"lean"}});
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(model_of(fit_), *model_bytes(fit->model));
}

TEST_F(CLearn, ProgressStopsIt) {
  const auto stop = [](void*, const char*, double) -> std::int32_t { return 0; };
  wisp_recipe recipe = wisp_recipe_default(WISP_RECIPE_FLICKER);
  wisp_recording* light = nullptr;
  Table made = table(4000);
  for (double& value : made.lean) value = 1 + 0.3 * value;
  ASSERT_EQ(wisp_recording_create(50, &light), WISP_OK);
  ASSERT_EQ(wisp_recording_add(light, WISP_ROLE_OUTPUT, "brightness", "", made.lean.data(), made.lean.size()), WISP_OK);
  EXPECT_EQ(wisp_learn(&light, 1, &recipe, stop, nullptr, &fit_), WISP_STOPPED) << wisp_last_error();
  EXPECT_STREQ(wisp_last_error(), "stopped");
  EXPECT_EQ(fit_, nullptr);
  wisp_recording_free(light);
}

TEST_F(CLearn, BadDataAreOneSentence) {
  const auto sentence = [&](wisp_recipe recipe) {
    EXPECT_EQ(learn(recipe), WISP_BAD_DATA);
    return std::string(wisp_last_error());
  };
  EXPECT_NE(sentence(wisp_recipe_default(WISP_RECIPE_FLAME)).find("the recording"), std::string::npos);
  EXPECT_NE(sentence(wisp_recipe_default(WISP_RECIPE_LEAF)).find("the recording"), std::string::npos);
  const double infinite[] = {1, std::numeric_limits<double>::infinity()};
  wisp_recording* other = nullptr;
  ASSERT_EQ(wisp_recording_create(50, &other), WISP_OK);
  EXPECT_EQ(wisp_recording_add(other, WISP_ROLE_INPUT, "wind", "", infinite, 2), WISP_BAD_DATA);
  EXPECT_EQ(wisp_recording_add(other, WISP_ROLE_INPUT, "wind", "", infinite, 1), WISP_OK);
  EXPECT_EQ(wisp_recording_add(other, WISP_ROLE_OUTPUT, "wind", "", infinite, 1), WISP_BAD_DATA) << "the name twice";
  wisp_recording_free(other);
}

TEST_F(CLearn, MisuseHasItsStatus) {
  EXPECT_EQ(learn(wisp_recipe_default(77)), WISP_BAD_ARGUMENT);
  wisp_recipe chain = wisp_recipe_default(WISP_RECIPE_CHAIN);
  chain.event = "never";
  EXPECT_EQ(learn(chain), WISP_BAD_ARGUMENT);
  EXPECT_EQ(wisp_learn(nullptr, 1, &chain, nullptr, nullptr, &fit_), WISP_BAD_ARGUMENT);
  EXPECT_EQ(wisp_learn(&recording_, 0, &chain, nullptr, nullptr, &fit_), WISP_BAD_ARGUMENT);
  wisp_recording* none = nullptr;
  EXPECT_EQ(wisp_recording_create(-1, &none), WISP_BAD_ARGUMENT);
  EXPECT_EQ(wisp_recording_create(2e9, &none), WISP_BAD_ARGUMENT);
  EXPECT_STREQ(wisp_last_error(), "wisp_recording_create was given 2e+09 samples a second, expected 0 to 1e9");
  const double one = 1;
  EXPECT_EQ(wisp_recording_add(recording_, WISP_ROLE_INPUT, "b", "", &one, 1), WISP_BAD_ARGUMENT) << "another length";
  EXPECT_EQ(wisp_recording_add(recording_, 7, "b", "", &one, 800), WISP_BAD_ARGUMENT);
  EXPECT_EQ(wisp_fit_get_model(nullptr, nullptr, nullptr), WISP_BAD_ARGUMENT);
  EXPECT_EQ(wisp_fit_usable(nullptr), 0);
  wisp_fit_free(nullptr);
  wisp_recording_free(nullptr);
}

}  // namespace
}  // namespace wisp::wisp_learn_test
