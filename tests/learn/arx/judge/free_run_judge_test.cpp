#include "learn/arx/judge/free_run_judge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <sstream>

#include "learn/arx/rows/arx_orders.hpp"

namespace wisp::free_run_judge_test {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// Five stretches of rows. The simulation goes on over the end of the first; around that of the second the input has
// gaps, around the third's an episode ends, around the fourth's an output is missing.
Recording long_recording() {
  constexpr std::size_t kRows = 270000;
  std::mt19937_64 generator(21);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.source = "long";
  recording.rate_hz = 60;
  recording.channels = {{"u", "", Role::kInput, std::vector<double>(kRows)},
                        {"y", "", Role::kOutput, std::vector<double>(kRows)}};
  auto &u = recording.channels[0].samples, &y = recording.channels[1].samples;
  for (std::size_t t = 0; t < kRows; ++t) {
    u[t] = normal(generator);
    y[t] = 0.3 * normal(generator);
    // Slow enough that a simulation that started anew would be seen.
    if (t >= 2) y[t] += 1.99 * y[t - 1] - 0.991 * y[t - 2] + 0.05 * u[t - 1];
    recording.episode_ids.push_back(t < 196606 ? 1 : 2);
  }
  u[131066] = u[131071] = u[131077] = kMissing;
  y[262143] = y[100] = kMissing;
  return recording;
}

TEST(FreeRunJudge, SimulatesATableReadInStretchesAsIfItWereWhole) {
  const Recording recording = long_recording();
  const ChannelChoice channels{{"u"}, {"y"}};
  ArxOptions options;
  options.orders = make_orders({.outputs = 1, .inputs = 1, .na = 2, .nb = 2, .nk = 1});
  const auto fit = fit_arx({&recording, 1}, channels, options);
  ASSERT_TRUE(fit);
  FigureOptions figure_options;
  figure_options.steps = {kFreeRun};
  const auto whole = prediction_figures(fit->model, {&recording, 1}, channels, figure_options);
  ASSERT_TRUE(whole);

  std::istringstream stream(csv_text(recording));
  auto reader = CsvReader::open(stream, "long");
  ASSERT_TRUE(reader);
  FreeRunJudge judge(fit->model, channels);
  ASSERT_TRUE(judge.add(*reader));
  const auto figures = judge.figures();
  ASSERT_TRUE(figures);
  EXPECT_EQ(figures->rows, whole->front().rows);
  EXPECT_NEAR(figures->mean_square[0] / whole->front().mean_square[0], 1, 1e-9);
  EXPECT_NEAR(figures->fit_percent[0], whole->front().fit_percent[0], 1e-7);
  EXPECT_NEAR(figures->fit_percent[0], fit->summary.free_run_fit_percent[0], 1e-7);
}

TEST(FreeRunJudge, WarnsAsTheFitOfWholeRecordingsDoes) {
  ArxSummary summary;
  summary.usable = {true, "fine"};
  summary.fit_percent = {98.1};
  PredictionFigures figures;
  figures.fit_percent = {11.1};
  add_free_run(figures, {{"u"}, {"arm"}}, summary);
  ASSERT_EQ(summary.warnings.size(), 1u);
  EXPECT_EQ(summary.warnings[0],
            "output 'arm': one step ahead the fit is 98.1 %, but free simulation from the input fits only 11.1 %; "
            "judge this model by simulation, and try other orders or delays");
  EXPECT_TRUE(summary.usable.verdict);
  EXPECT_EQ(summary.usable.reason, "fine");
}

TEST(FreeRunJudge, NothingThatCanBeSimulatedIsAnError) {
  ArxModel model;
  model.orders = make_orders({.outputs = 1, .inputs = 1, .na = 2, .nb = 2, .nk = 1});
  model.theta = {{0.1, 0.1, 1, 1}};
  model.constant = model.output_mean = model.input_mean = {0};
  std::istringstream stream("# wisp-recording 1\n# rate_hz 1\nu:u,y:y\n1,1\n2,2\n");
  auto reader = CsvReader::open(stream, "short");
  ASSERT_TRUE(reader);
  FreeRunJudge judge(model, {{"u"}, {"y"}});
  ASSERT_TRUE(judge.add(*reader));
  EXPECT_FALSE(judge.figures());
}

}  // namespace
}  // namespace wisp::free_run_judge_test
