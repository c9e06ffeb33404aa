// The fit against reference estimates of classic identification sets, made with numpy's lstsq on the explicit regressor
// and agreeing with GNU Octave's arx.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "learn/choose/order_search.hpp"
#include "learn/judge/judged_fit.hpp"
#include "learn/judge/prediction.hpp"
#include "learn/rows/arx_design.hpp"
#include "learn/shared_files.hpp"

namespace wisp::arx_reference_test {
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
      EXPECT_EQ(fit.summary.rows, static_cast<std::size_t>(row["n"].number));
      for (std::size_t j = 0; j < ny; ++j) {
        EXPECT_NEAR(fit.summary.noise_covariance[i * ny + j], want["noise_covariance"][i][j].number,
                    1e-9 * std::abs(want["noise_covariance"][i][i].number));
      }
    }
    EXPECT_NEAR(fit.summary.fpe_total / want["fpe_det"].number, 1, 1e-8);
    const double n = static_cast<double>(fit.summary.rows);
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

std::vector<std::vector<double>> read_table(const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::string line;
  std::getline(stream, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(stream, line)) {
    std::istringstream cells(line);
    auto& row = rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
  }
  return rows;
}

TEST_F(ArxReference, GridOfTheHairDryerAgreesInAllRows) {
  const Recording whole = shared::read_sysid("hairdryer");
  const Recording estimation = slice(whole, 0, 500);
  const Recording validation = slice(whole, 500, 1000);
  SearchOptions options;
  options.by = OrderCriterion::kValidation;
  const auto search = search_orders({&estimation, 1}, {&validation, 1}, channels_of(whole), options);
  ASSERT_TRUE(search) << search.error().message;
  const auto want = read_table(shared::reference("hairdryer_grid400.csv"));
  ASSERT_EQ(want.size(), 400u);
  ASSERT_EQ(search->candidates.size(), 400u);
  std::size_t found = 0;
  for (const auto& row : want) {
    for (const OrderCandidate& got : search->candidates) {
      if (got.na != row[0] || got.nb != row[1] || got.nk != row[2]) continue;
      ++found;
      // The table has twelve digits.
      EXPECT_NEAR(got.loss[0] / row[3], 1, 1e-11);
      EXPECT_NEAR(got.fpe / row[4], 1, 1e-11);
      EXPECT_NEAR(got.loss_validation[0] / row[5], 1, 1e-11);
    }
  }
  EXPECT_EQ(found, 400u);
  options.nk = {3, 3};
  const auto with_delay = search_orders({&estimation, 1}, {&validation, 1}, channels_of(whole), options);
  ASSERT_TRUE(with_delay);
  const OrderCandidate& best = with_delay->candidates[with_delay->best];
  EXPECT_EQ(std::vector<int>({best.na, best.nb, best.nk}), std::vector<int>({10, 4, 3}));
}

TEST_F(ArxReference, HairDryerHasItsPublishedModelAndDelay) {
  const Recording whole = shared::read_sysid("hairdryer");
  const Recording first = slice(whole, 0, 300);
  ArxOptions options;
  options.orders = make_orders({.outputs = 1, .inputs = 1, .na = 2, .nb = 2, .nk = 3});
  const auto fit = fit_arx({&first, 1}, channels_of(whole), options);
  ASSERT_TRUE(fit);
  const std::vector<double> published{-1.274, 0.3935, 0.06662, 0.04448};
  const std::vector<double> half_a_digit{5e-4, 5e-5, 5e-6, 5e-6};
  for (std::size_t p = 0; p < 4; ++p) EXPECT_NEAR(fit->model.theta[0][p], published[p], half_a_digit[p]);
  const auto delays = estimate_delays({&first, 1}, channels_of(whole));
  ASSERT_TRUE(delays) << delays.error().message;
  EXPECT_EQ(delays->nk(0, 0), 3);
}

TEST_F(ArxReference, OneStepFitOfRobotArmAndFlutterHidesBadFreeSimulationAndIsWarnedOf) {
  for (const auto& [name, order] : {std::pair{"robotarm", 4}, {"flutter", 6}}) {
    const Recording recording = shared::read_sysid(name);
    ArxOptions options;
    options.orders = make_orders({.outputs = 1, .inputs = 1, .na = order, .nb = order, .nk = 1});
    const auto fit = fit_arx({&recording, 1}, channels_of(recording), options);
    ASSERT_TRUE(fit);
    EXPECT_GT(fit->summary.fit_percent[0], 97.5);
    EXPECT_LT(fit->summary.free_run_fit_percent[0], 55);
    ASSERT_EQ(fit->summary.warnings.size(), 1u) << name;
    EXPECT_THAT(fit->summary.warnings[0], ::testing::HasSubstr("free simulation"));
  }
}

}  // namespace
}  // namespace wisp::arx_reference_test
