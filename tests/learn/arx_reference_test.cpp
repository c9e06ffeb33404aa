// The fit against reference estimates of classic identification sets, made with numpy's lstsq on the explicit regressor
// and agreeing with GNU Octave's arx.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "learn/shared_files.hpp"
#include "wisp/learn/arx_fit.hpp"
#include "wisp/learn/arx_orders.hpp"
#include "wisp/learn/prediction.hpp"

namespace wisp {
namespace {

ChannelChoice channels_of(const Recording& recording) {
  ChannelChoice choice;
  for (const Channel& channel : recording.channels) {
    (channel.name.front() == 'u' ? choice.inputs : choice.outputs).push_back(channel.name);
  }
  return choice;
}

ArxFit fit_case(const Recording& recording, const shared::Json& want) {
  const ChannelChoice choice = channels_of(recording);
  ArxOptions options;
  options.stabilise = false;
  options.orders = make_orders({.outputs = static_cast<int>(choice.outputs.size()),
                                .inputs = static_cast<int>(choice.inputs.size()),
                                .na = static_cast<int>(want["na"].number),
                                .nb = static_cast<int>(want["nb"].number),
                                .nk = static_cast<int>(want["nk"].number),
                                .coupling = want["coupling"].text == "full" ? Coupling::kFull : Coupling::kDiagonal});
  auto fit = fit_arx({&recording, 1}, choice, options);
  if (!fit) throw std::runtime_error(fit.error().message);
  return *fit;
}

// Largest difference over the largest magnitude wanted.
double relative_difference(const std::vector<double>& got, const std::vector<double>& want) {
  EXPECT_EQ(got.size(), want.size());
  double difference = 0;
  double largest = 0;
  for (std::size_t k = 0; k < want.size(); ++k) {
    difference = std::max(difference, std::abs(got[k] - want[k]));
    largest = std::max(largest, std::abs(want[k]));
  }
  return difference / largest;
}

// A row of the reference in our order. For full coupling it lists the own output's A, then B, then the other outputs as
// if they were inputs, that is with the other sign.
std::vector<double> in_our_order(const ArxOrders& orders, int i, std::vector<double> row, double other_sign) {
  const auto na = static_cast<std::size_t>(orders.na(i, i));
  std::size_t b_size = 0;
  for (int k = 0; k < orders.inputs(); ++k) b_size += static_cast<std::size_t>(orders.nb(i, k));
  const std::vector<double> own(row.begin(), row.begin() + na);
  const std::vector<double> b(row.begin() + na, row.begin() + na + b_size);
  std::size_t others = na + b_size;
  std::vector<double> out;
  for (int j = 0; j < orders.outputs(); ++j) {
    if (j == i) {
      out.insert(out.end(), own.begin(), own.end());
    } else {
      for (int lag = 0; lag < orders.na(i, j); ++lag) out.push_back(other_sign * row[others++]);
    }
  }
  out.insert(out.end(), b.begin(), b.end());
  return out;
}

class ArxReference : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(shared::reference("arx.json")) || !std::filesystem::exists(shared::data("sysid"))) {
      GTEST_SKIP() << "reference files or recordings are not on this machine";
    }
  }
};

TEST_F(ArxReference, CoefficientsErrorsAndCriteriaAgreeOnAllSets) {
  const shared::Json reference = shared::JsonReader(shared::reference("arx.json")).read();
  ASSERT_EQ(reference["cases"].items.size(), 13u);
  for (const shared::Json& want : reference["cases"].items) {
    SCOPED_TRACE(want["data"].text + " na " + std::to_string(want["na"].number));
    const Recording whole = shared::read_sysid(want["data"].text);
    const auto samples = want["samples"].numbers();
    const Recording recording =
        slice(whole, static_cast<std::size_t>(samples[0]) - 1, static_cast<std::size_t>(samples[1]));
    const ArxFit fit = fit_case(recording, want);
    const std::size_t ny = want["rows"].items.size();
    ASSERT_EQ(fit.model.theta.size(), ny);
    for (std::size_t i = 0; i < ny; ++i) {
      const shared::Json& row = want["rows"][i];
      const auto theta = in_our_order(fit.model.orders, static_cast<int>(i), row["theta"].numbers(), -1);
      const auto std_error = in_our_order(fit.model.orders, static_cast<int>(i), row["stderr"].numbers(), 1);
      EXPECT_LT(relative_difference(fit.model.theta[i], theta), 1e-9);
      // The reference inverts XᵀX, which costs it the condition squared (exact rational arithmetic on the flutter set
      // agrees with us to 2e-12 and with the reference to 3e-7).
      const double inverse_error = row["cond"].number * row["cond"].number * 2.2e-16;
      EXPECT_LT(relative_difference(fit.model.std_error[i], std_error), 1e-9 + inverse_error);
      EXPECT_NEAR(fit.summary.loss[i] / row["V"].number, 1, 1e-9);
      EXPECT_NEAR(fit.summary.row_fpe[i] / row["fpe"].number, 1, 1e-9);
      EXPECT_NEAR(fit.summary.condition[i] / row["cond"].number, 1, 1e-7);
      EXPECT_EQ(fit.summary.samples_used, static_cast<std::size_t>(row["n"].number));
      for (std::size_t j = 0; j < ny; ++j) {
        EXPECT_NEAR(fit.summary.noise_covariance[i * ny + j], want["noise_covariance"][i][j].number,
                    1e-9 * std::abs(want["noise_covariance"][i][i].number));
      }
    }
    EXPECT_NEAR(fit.summary.fpe_total / want["fpe_det"].number, 1, 1e-8);
    const double n = static_cast<double>(fit.summary.samples_used);
    EXPECT_NEAR(fit.summary.aic / n, want["naic"].number, 1e-9 * std::abs(want["naic"].number));
  }
}

TEST_F(ArxReference, PredictionErrorsOfTheHairDryerAgreeForTwentySteps) {
  const shared::Json extra = shared::JsonReader(shared::reference("hairdryer_extra.json")).read();
  const Recording whole = shared::read_sysid("hairdryer");
  const ChannelChoice choice = channels_of(whole);
  const Recording estimation = slice(whole, 0, 500);
  const Recording validation = slice(whole, 500, 1000);
  ArxOptions options;
  options.orders = make_orders({.outputs = 1, .inputs = 1, .na = 2, .nb = 2, .nk = 3});
  auto fit = fit_arx({&estimation, 1}, choice, options);
  ASSERT_TRUE(fit);
  const auto mean = [](const Recording& recording, const char* name) {
    double sum = 0;
    for (double sample : recording.channels[*find_channel(recording, name)].samples) sum += sample;
    return sum / static_cast<double>(recording.rows());
  };
  fit->model.output_mean = {mean(validation, "y1")};  // the reference removes each window's own means
  fit->model.input_mean = {mean(validation, "u1")};
  FigureOptions figures;
  figures.steps.clear();
  for (int k = 1; k <= 20; ++k) figures.steps.push_back(k);
  const auto got = prediction_figures(fit->model, {&validation, 1}, choice, figures);
  ASSERT_TRUE(got);
  const auto want = extra["Jk_val"].numbers();
  for (std::size_t k = 0; k < 20; ++k) EXPECT_NEAR((*got)[k].mean_square[0] / want[k], 1, 1e-10) << k + 1;
}

}  // namespace
}  // namespace wisp
