// The fit against numbers that numpy and scipy found, on made data that stand in the tree: tools/arx_reference.py.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "learn/choose/order_search.hpp"
#include "learn/fit/made_sets.hpp"
#include "learn/judge/judged_fit.hpp"
#include "learn/judge/prediction.hpp"
#include "learn/judge/response.hpp"
#include "learn/rows/arx_design.hpp"
#include "learn/shared_files.hpp"
#include "paths.hpp"

namespace wisp::arx_made_reference_test {
namespace {

using shared::Json;

const Json& reference() {
  static const Json read =
      shared::JsonReader(std::filesystem::path(WISP_SOURCE_DIR) / "tests/learn/fit/arx_made.json").read();
  return read;
}

ChannelChoice channels_of(const Recording& recording) {
  ChannelChoice choice;
  for (const Channel& channel : recording.channels) {
    (channel.role == Role::kInput ? choice.inputs : choice.outputs).push_back(channel.name);
  }
  return choice;
}

int whole(const Json& json) { return static_cast<int>(json.number); }

Recording recording_of(const Json& want) {
  const auto rows = want["rows"].numbers();
  return slice(made::recording_of(made::sets().at(want["set"].text)), static_cast<std::size_t>(rows[0]),
               static_cast<std::size_t>(rows[1]));
}

ArxFit fit_of(const Recording& recording, const Json& want, ArxKernel kernel = ArxKernel::kNone) {
  const ChannelChoice choice = channels_of(recording);
  ArxOptions options;
  options.stabilise = false;
  options.orders = make_orders({.outputs = static_cast<int>(choice.outputs.size()),
                                .inputs = static_cast<int>(choice.inputs.size()),
                                .na = whole(want["na"]),
                                .nb = whole(want["nb"]),
                                .nk = whole(want["nk"]),
                                .coupling = want["coupling"].text == "full" ? Coupling::kFull : Coupling::kDiagonal});
  options.kernel = kernel;
  auto fit = fit_arx({&recording, 1}, choice, options);
  if (!fit) throw std::runtime_error(fit.error().message);
  return *fit;
}

// Two ways of least squares differ by rounding times the condition number; between them the sets' own numbers, made by
// two compilers of which one may fuse products and sums, by as much again.
double rounding(double condition) { return 1e-13 + 100 * 2.2e-16 * condition; }

void expect_near(const std::vector<double>& got, const std::vector<double>& want, double relative) {
  ASSERT_EQ(got.size(), want.size());
  double largest = 0;
  for (double value : want) largest = std::max(largest, std::abs(value));
  for (std::size_t k = 0; k < want.size(); ++k) EXPECT_NEAR(got[k], want[k], relative * largest) << k;
}

// One test a case of the file.
class ArxMadeReference : public ::testing::TestWithParam<int> {
 protected:
  const Json& want() const { return reference()["cases"][static_cast<std::size_t>(GetParam())]; }
};

INSTANTIATE_TEST_SUITE_P(Cases, ArxMadeReference, ::testing::Range(0, 7));

TEST(ArxMadeSets, AreThoseOfTheReference) {
  ASSERT_EQ(reference()["cases"].items.size(), 7u);
  for (const auto& [name, want] : reference()["sets"].fields) {
    const Recording recording = made::recording_of(made::sets().at(name));
    std::vector<double> last;
    for (const Channel& channel : recording.channels) last.push_back(channel.samples.back());
    EXPECT_EQ(recording.rows(), static_cast<std::size_t>(want["rows"].number)) << name;
    expect_near(last, want["last"].numbers(), 1e-13);
  }
}

TEST_P(ArxMadeReference, CoefficientsStandardErrorsAndLossAgree) {
  const ArxFit fit = fit_of(recording_of(want()), want());
  const auto& estimates = want()["estimates"].items;
  ASSERT_EQ(fit.model.theta.size(), estimates.size());
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    const Json& row = estimates[i];
    const double tolerance = rounding(row["condition"].number);
    expect_near(fit.model.theta[i], row["theta"].numbers(), tolerance);
    expect_near(fit.model.std_error[i], row["std_error"].numbers(), tolerance);
    EXPECT_NEAR(fit.summary.loss[i] / row["V"].number, 1, tolerance);
    EXPECT_NEAR(fit.summary.row_fpe[i] / row["fpe"].number, 1, tolerance);
    // Where normal equations are solved, it is that of their triangle, which knows it to rounding times its square.
    const double square = row["condition"].number * row["condition"].number;
    EXPECT_NEAR(fit.summary.condition[i] / row["condition"].number, 1, 1e-13 + 2.2e-16 * square);
    EXPECT_EQ(fit.summary.rows, static_cast<std::size_t>(row["n"].number));
  }
}

TEST_P(ArxMadeReference, NoiseCovarianceAndCriteriaAgree) {
  const ArxFit fit = fit_of(recording_of(want()), want());
  const double tolerance = rounding(want()["estimates"][0]["condition"].number);
  const std::size_t ny = fit.model.theta.size();
  for (std::size_t i = 0; i < ny; ++i) {
    for (std::size_t j = 0; j < ny; ++j) {
      EXPECT_NEAR(fit.summary.noise_covariance[i * ny + j], want()["noise_covariance"][i][j].number,
                  tolerance * want()["noise_covariance"][i][i].number);
    }
  }
  EXPECT_NEAR(fit.summary.fpe_total / want()["fpe"].number, 1, 10 * tolerance);
  const double n = static_cast<double>(fit.summary.rows);
  EXPECT_NEAR(fit.summary.aic, want()["aic"].number, 10 * n * tolerance);
  EXPECT_NEAR(fit.summary.bic, want()["bic"].number, 10 * n * tolerance);
}

// The likelihood is flat at its top, where the two searches stop at different places: the coefficients differ by little
// of what the kernel leaves open.
TEST(ArxMadeKernels, CoefficientsAgreeWithThePosteriorMean) {
  ASSERT_EQ(reference()["kernels"].items.size(), 3u);
  for (const Json& want : reference()["kernels"].items) {
    const ArxFit fit = fit_of(recording_of(want), want, ArxKernel::kTc);
    for (std::size_t i = 0; i < fit.model.theta.size(); ++i) {
      SCOPED_TRACE(want["set"].text + " " + std::to_string(i));
      expect_near(fit.model.theta[i], want["estimates"][i]["theta"].numbers(), 0.02);
      EXPECT_LT(fit.summary.effective[i], 0.7 * static_cast<double>(fit.model.theta[i].size()));
      EXPECT_GT(fit.summary.effective[i], 2);
    }
  }
}

TEST_P(ArxMadeReference, PredictionsAgreeWithTheEquationRunForward) {
  if (!want().fields.contains("mean_square")) return;  // a set with holes
  const Recording recording = recording_of(want());
  const ArxFit fit = fit_of(recording, want());
  const auto got =
      prediction_figures(fit.model, {&recording, 1}, channels_of(recording), {.steps = {1, 3, 10, kFreeRun}});
  ASSERT_TRUE(got) << got.error().message;
  const double tolerance = 1e3 * rounding(want()["estimates"][0]["condition"].number);  // errors add up over the memory
  for (const PredictionFigures& figures : *got) {
    const std::string steps = figures.steps == kFreeRun ? "inf" : std::to_string(figures.steps);
    expect_near(figures.mean_square, want()["mean_square"][steps].numbers(), tolerance);
  }
}

TEST_P(ArxMadeReference, StepResponseAndRadiusAgree) {
  if (!want().fields.contains("step")) return;  // more than one output
  const ArxFit fit = fit_of(recording_of(want()), want());
  expect_near(step_response(fit.model, 0, 0, 40).value, want()["step"].numbers(),
              1e3 * rounding(want()["estimates"][0]["condition"].number));
  // Coefficients are rounded to single precision, 6e-8, for it, and roots that lie together move by a thousand times
  // that.
  EXPECT_NEAR(fit.summary.stable.radius, want()["radius"].number, 6e-5);
}

TEST(ArxMadeReference, AGridOfOrdersAgreesInAllRows) {
  const Recording dryer = made::recording_of(made::sets().at("dryer"));
  const Recording first = slice(dryer, 0, 500), second = slice(dryer, 500, 1000);
  SearchOptions options;
  options.na = {1, 4}, options.nb = {1, 4}, options.nk = {0, 4};
  options.by = OrderCriterion::kValidation;
  const auto search = search_orders({&first, 1}, {&second, 1}, channels_of(dryer), options);
  ASSERT_TRUE(search) << search.error().message;
  ASSERT_EQ(search->candidates.size(), reference()["grid"].items.size());
  for (const Json& item : reference()["grid"].items) {
    const auto row = item.numbers();
    const auto got = std::find_if(search->candidates.begin(), search->candidates.end(), [&](const OrderCandidate& one) {
      return one.na == row[0] && one.nb == row[1] && one.nk == row[2];
    });
    ASSERT_NE(got, search->candidates.end());
    EXPECT_NEAR(got->loss[0] / row[3], 1, 1e-10);
    EXPECT_NEAR(got->fpe / row[4], 1, 1e-10);
    EXPECT_NEAR(got->loss_validation[0] / row[5], 1, 1e-10);
  }
  const auto& grid = reference()["grid"].items;
  const auto best = std::min_element(grid.begin(), grid.end(), [](const Json& a, const Json& b) {
                      return a[5].number < b[5].number;
                    })->numbers();
  const OrderCandidate& got = search->candidates[search->best];
  EXPECT_EQ((std::vector<double>{1.0 * got.na, 1.0 * got.nb, 1.0 * got.nk}),
            (std::vector<double>(best.begin(), best.begin() + 3)));
}

}  // namespace
}  // namespace wisp::arx_made_reference_test
