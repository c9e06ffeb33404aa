#include "learn/choose/order_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <limits>

#include "learn/arx/made_system.hpp"
#include "learn/judge/judged_fit.hpp"
#include "learn/judge/prediction.hpp"

namespace wisp::order_search_test {
namespace {

using ::testing::HasSubstr;

const ChannelChoice kChannels{{"u1", "u2"}, {"y1", "y2"}};

ArxOptions fit_options(const OrderCandidate& candidate, const SearchOptions& search) {
  ArxOptions options;
  options.orders = candidate.orders;
  options.offset = search.offset;
  options.stabilise = false;
  options.judge_free_run = false;
  return options;
}

// The criteria are differences of large sums: relative to n, as they are compared.
void expect_same(const OrderCandidate& got, const ArxFit& want) {
  const ArxSummary& summary = want.summary;
  const double n = static_cast<double>(summary.rows);
  EXPECT_EQ(got.rows, summary.rows);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(got.loss[i] / summary.loss[i], 1, 1e-10);
  EXPECT_NEAR(got.fpe / summary.fpe, 1, 1e-10);
  EXPECT_NEAR(got.aic / n, summary.aic / n, 1e-10);
  EXPECT_NEAR(got.aicc / n, summary.aicc / n, 1e-10);
  EXPECT_NEAR(got.bic / n, summary.bic / n, 1e-10);
}

TEST(OrderSearch, EveryCandidateIsTheFitOnItsOwn) {
  Recording recording = record_system(made_system(), 3000, 1);
  for (std::size_t t = 0; t < 3000; ++t) recording.episode_ids.push_back(t < 1200 ? 0 : t < 1204 ? 1 : 2);
  for (ArxOffset offset : {ArxOffset::kMean, ArxOffset::kNone, ArxOffset::kEstimate}) {
    SearchOptions options{.na = {0, 5}, .nb = {1, 3}, .nk = {0, 2}, .offset = offset};
    const auto search = search_orders({&recording, 1}, {}, kChannels, options);
    ASSERT_TRUE(search) << search.error().message;
    ASSERT_EQ(search->candidates.size(), 6u * 3 * 3);
    for (const OrderCandidate& candidate : search->candidates) {
      const auto fit = fit_arx({&recording, 1}, kChannels, fit_options(candidate, options));
      ASSERT_TRUE(fit);
      expect_same(candidate, *fit);
    }
  }
}

TEST(OrderSearch, AMissingSampleOfTheLongestHistoryCostsAllCandidatesItsRows) {
  Recording recording = record_system(made_system(), 1000, 3);
  recording.channels[2].samples[500] = std::numeric_limits<double>::quiet_NaN();
  const SearchOptions options{.na = {1, 4}, .nb = {1, 1}, .nk = {1, 1}};
  const auto search = search_orders({&recording, 1}, {}, kChannels, options);
  ASSERT_TRUE(search);
  for (const OrderCandidate& candidate : search->candidates) {
    EXPECT_EQ(candidate.rows, 1000u - static_cast<unsigned>(candidate.na) - 5);
  }
}

TEST(OrderSearch, ValidationIsByAnyNumberOfStepsOrBySimulation) {
  const Recording recording = record_system(made_system(), 1500, 4);
  Recording other = record_system(made_system(), 800, 5);
  for (int steps : {1, 2, 12, kFreeRun}) {
    const SearchOptions options{.na = {1, 3},
                                .nb = {1, 3},
                                .nk = {0, 1},
                                .by = OrderCriterion::kValidation,
                                .steps = steps,
                                .offset = ArxOffset::kNone};
    const auto search = search_orders({&recording, 1}, {&other, 1}, kChannels, options);
    ASSERT_TRUE(search) << search.error().message;
    double least = std::numeric_limits<double>::infinity();
    std::size_t best = 0;
    for (std::size_t c = 0; c < search->candidates.size(); ++c) {
      const OrderCandidate& candidate = search->candidates[c];
      const auto fit = fit_arx({&recording, 1}, kChannels, fit_options(candidate, options));
      ASSERT_TRUE(fit);
      FigureOptions figures;
      figures.steps = {steps};
      const auto want = prediction_figures(fit->model, {&other, 1}, kChannels, figures);
      ASSERT_TRUE(want);
      double value = 0;
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(candidate.loss_validation[i] / want->front().mean_square[i], 1, 1e-8) << steps;
        value += std::log(want->front().mean_square[i]);
      }
      if (value < least) least = value, best = c;
    }
    EXPECT_EQ(search->best, best);
  }
}

TEST(OrderSearch, BicFindsTheOrdersThatMadeTheData) {
  const auto uniform =
      make_orders({.outputs = 2, .inputs = 2, .na = 2, .nb = 2, .nk = 2, .coupling = Coupling::kDiagonal});
  ArxModel model = made_system();
  model.orders = uniform;
  model.theta = {{-1.2, 0.5, 0.4, 0.3, -0.5, 0.2}, {-0.8, 0.4, 0.3, -0.4, 0.6, 0.5}};
  const Recording recording = record_system(model, 5000, 6);
  const SearchOptions options{
      .na = {1, 6}, .nb = {1, 6}, .nk = {0, 4}, .coupling = Coupling::kDiagonal, .by = OrderCriterion::kBic};
  const auto search = search_orders({&recording, 1}, {}, kChannels, options);
  ASSERT_TRUE(search);
  const OrderCandidate& best = search->candidates[search->best];
  EXPECT_EQ(best.orders, uniform);
  EXPECT_EQ(best.na, 2);
  EXPECT_EQ(best.nb, 2);
  EXPECT_EQ(best.nk, 2);
}

TEST(OrderSearch, AnOutputThatRepeatsAnotherDoesNotHideTheBestOrders) {
  Recording recording = record_system(made_system(), 2000, 6);
  const SearchOptions options{.na = {1, 4}, .nb = {1, 3}, .nk = {0, 2}, .coupling = Coupling::kDiagonal};
  const auto alone = search_orders({&recording, 1}, {}, {{"u1", "u2"}, {"y1"}}, options);
  ASSERT_TRUE(alone) << alone.error().message;
  recording.channels.push_back(recording.channels[*find_channel(recording, "y1")]);
  recording.channels.back().name = "twice";
  for (double& y : recording.channels.back().samples) y *= 2;
  const auto both = search_orders({&recording, 1}, {}, {{"u1", "u2"}, {"y1", "twice"}}, options);
  ASSERT_TRUE(both) << both.error().message;
  EXPECT_GT(both->best, 0u);
  EXPECT_EQ(both->candidates[both->best].orders.nk(0, 0), alone->candidates[alone->best].orders.nk(0, 0));
  for (const OrderCandidate& candidate : both->candidates) EXPECT_TRUE(std::isfinite(candidate.bic));
}

TEST(OrderSearch, UnitsOfTheOutputsDoNotMatter) {
  Recording recording = record_system(made_system(), 1000, 6);
  const SearchOptions options{.na = {1, 4}, .nb = {1, 3}, .nk = {0, 2}};
  const auto search = search_orders({&recording, 1}, {}, kChannels, options);
  ASSERT_TRUE(search) << search.error().message;
  for (const char* output : {"y1", "y2"}) {
    for (double& y : recording.channels[*find_channel(recording, output)].samples) y *= 0x1p-300;
  }
  const auto small = search_orders({&recording, 1}, {}, kChannels, options);
  ASSERT_TRUE(small) << small.error().message;
  EXPECT_GT(search->best, 0u);
  EXPECT_EQ(small->best, search->best);
}

TEST(OrderSearch, EveryOutputMayHaveOrdersOfItsOwn) {
  ArxModel model = made_system();
  model.orders = make_orders({.outputs = 2, .inputs = 2, .na = 3, .nb = 1, .nk = 1, .coupling = Coupling::kDiagonal});
  model.theta = {{-1.2, 0.8, -0.3, 0.5, 0.4}, {-0.5, 0, 0, 0.6, 0.5}};  // the second is of order 1
  const Recording recording = record_system(model, 5000, 7);
  const SearchOptions options{
      .na = {1, 5}, .nb = {1, 1}, .nk = {1, 1}, .coupling = Coupling::kDiagonal, .by = OrderCriterion::kBic};
  const auto search = search_orders({&recording, 1}, {}, kChannels, options);
  ASSERT_TRUE(search);
  EXPECT_EQ(search->candidates[search->best_of_row[0]].na, 3);
  EXPECT_EQ(search->candidates[search->best_of_row[1]].na, 1);
}

TEST(OrderSearch, OrdersOfThirtyAreSearched) {
  ArxModel model = made_system();
  model.orders = make_orders({.outputs = 1, .inputs = 1, .na = 28, .nb = 1, .nk = 1});
  model.theta = {std::vector<double>(29)};
  model.theta[0][0] = -0.5;
  model.theta[0][27] = 0.4;
  model.theta[0][28] = 1;
  model.constant = {0};
  const Recording recording = record_system(model, 4000, 8);
  const SearchOptions options{.na = {1, 32}, .nb = {1, 2}, .nk = {0, 1}, .by = OrderCriterion::kBic};
  const auto search = search_orders({&recording, 1}, {}, {{"u1"}, {"y1"}}, options);
  ASSERT_TRUE(search) << search.error().message;
  EXPECT_EQ(search->candidates[search->best].na, 28);
  EXPECT_EQ(search->candidates[search->best].nk, 1);
}

TEST(OrderSearch, SaysWhatIsWrong) {
  const Recording recording = record_system(made_system(), 60, 10);
  const auto complaint = [&](const SearchOptions& options) {
    const auto search = search_orders({&recording, 1}, {}, kChannels, options);
    return search ? std::string("no complaint") : search.error().message;
  };
  EXPECT_THAT(complaint({.na = {3, 2}}), HasSubstr("the range of na is 3:2"));
  EXPECT_THAT(complaint({.na = {1, 4000}, .nb = {1, 4000}}), HasSubstr("more than a million candidates"));
  EXPECT_THAT(complaint({.by = OrderCriterion::kValidation}), HasSubstr("without validation recordings"));
  EXPECT_THAT(complaint({.steps = 200000}), HasSubstr("200000 steps ahead"));
  EXPECT_THAT(complaint({.na = {1, 20}, .nb = {1, 1}, .nk = {0, 0}}),
              HasSubstr("candidate na 20, nb 1, nk 0 has 42 coefficients an output and only 40 rows"));
}

// Bytes that malloc had to take from the system for some work: it gives none back here, so this is the most in use.
template <class Work>
std::size_t max_bytes(Work work) {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  malloc_trim(0);
  const std::size_t before = mallinfo2().uordblks;
  work();
  return mallinfo2().arena - before;
}

TEST(OrderSearch, MemoryDoesNotGrowWithTheNumberOfCandidates) {
  const Recording recording = record_system(made_system(), 20000, 11);
  const SearchOptions one{.na = {20, 20}, .nb = {20, 20}, .nk = {0, 0}};
  const SearchOptions all{.na = {1, 20}, .nb = {1, 20}, .nk = {0, 0}};
  const auto search = [&](const SearchOptions& options) {
    EXPECT_TRUE(search_orders({&recording, 1}, {&recording, 1}, kChannels, options));
  };
  const std::size_t few = max_bytes([&] { search(one); });
  const std::size_t many = max_bytes([&] { search(all); });
  // What is returned for each of the 400: three order matrices and some figures, below 1 kB, twice where the list
  // grows; and a Gram matrix for each of the 19 further windows of either recording. One of each candidate would be
  // 21 MB.
  EXPECT_LT(many, few + 400 * 2000 + 2 * 19 * 83 * 83 * sizeof(double));
}

// The input resembles its own past, so that it acts at a wrong, short delay as well: y(t) = 0.8 y(t−1) + u(t−45) + 2
// e(t).
TEST(EstimateDelays, AShortDelayThatIsSupportedTooDoesNotHideALongOne) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    Recording recording{.rate_hz = 1, .channels = {{"u", "", Role::kInput, {}}, {"y", "", Role::kOutput, {}}}};
    auto &u = recording.channels[0].samples, &y = recording.channels[1].samples;
    for (std::size_t t = 0; t < 600; ++t) {
      u.push_back(t % 31 == 0 ? (generator() % 2 ? 1.0 : -1.0) : u.back());
      y.push_back((t > 0 ? 0.8 * y.back() : 0) + (t >= 45 ? u[t - 45] : 0) + 0.3 * normal(generator));
    }
    const auto delays = estimate_delays({&recording, 1}, {{"u"}, {"y"}});
    ASSERT_TRUE(delays) << seed;
    EXPECT_EQ(delays->nk(0, 0), 45) << seed;
  }
}

TEST(SearchOrders, ValidationRecordingsOfAnotherRateAreRefused) {
  const Recording recording = record_system(made_system(), 800, 3);
  Recording other = record_system(made_system(), 800, 5);
  other.rate_hz *= 2;
  EXPECT_FALSE(search_orders({&recording, 1}, {&other, 1}, kChannels, {.by = OrderCriterion::kValidation}));
}

TEST(EstimateDelays, FindsEveryInputsDelayToEveryOutput) {
  ArxModel model = made_system();
  OrderMatrix& nk = model.orders.nk;
  model.orders.nb = OrderMatrix(2, 2, 1);
  nk(0, 0) = 1, nk(0, 1) = 7, nk(1, 0) = 0, nk(1, 1) = 12;
  model.theta = {{-1.4, 0.65, 0.2, 0.5, -0.4}, {-0.9, 0.3, -0.1, 0.7, 0.3}};
  const Recording recording = record_system(model, 5000, 12);
  const auto delays = estimate_delays({&recording, 1}, kChannels);
  ASSERT_TRUE(delays) << delays.error().message;
  EXPECT_EQ(delays->nk, nk);
}

}  // namespace
}  // namespace wisp::order_search_test
