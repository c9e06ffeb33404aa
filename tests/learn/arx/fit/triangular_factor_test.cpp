#include "learn/arx/fit/triangular_factor.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

#include "learn/arx/rows/arx_orders.hpp"

namespace wisp::triangular_factor_test {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

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
  u[0] = kMissing;
  if (rows > 1500) y1[1500] = kMissing;
  if (rows > 2500) u[2500] = kMissing;
  return recording;
}

ChannelChoice channels() { return {{"u"}, {"y1", "y2"}}; }
ArxOrders orders() { return make_orders({.outputs = 2, .inputs = 1, .na = 3, .nb = 2, .nk = 1}); }

ArxOptions options(ArxOffset offset = ArxOffset::kMean) {
  ArxOptions options;
  options.orders = orders();
  options.offset = offset;
  options.judge_free_run = false;
  options.stabilise = false;  // a repair magnifies rounding: it ends where a search ends
  return options;
}

TriangularFactor empty() { return *TriangularFactor::create({.channels = channels(), .orders = orders()}); }

void expect_same(const ArxFit& got, const ArxFit& want) {
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t p = 0; p < want.model.theta[i].size(); ++p) {
      EXPECT_NEAR(got.model.theta[i][p], want.model.theta[i][p], 1e-11);
      EXPECT_NEAR(got.model.std_error[i][p], want.model.std_error[i][p], 1e-11);
    }
    EXPECT_NEAR(got.summary.loss[i] / want.summary.loss[i], 1, 1e-11);
    EXPECT_NEAR(got.model.output_mean[i], want.model.output_mean[i], 1e-12);
    EXPECT_NEAR(got.model.constant[i], want.model.constant[i], 1e-10);
    EXPECT_NEAR(got.summary.fit_percent[i], want.summary.fit_percent[i], 1e-9);
  }
  EXPECT_EQ(got.summary.samples_used, want.summary.samples_used);
  EXPECT_EQ(got.summary.first_sample, want.summary.first_sample);
  EXPECT_EQ(got.summary.rows_left_out, want.summary.rows_left_out);
  EXPECT_EQ(got.summary.episodes_used, want.summary.episodes_used);
  EXPECT_EQ(got.summary.episodes_skipped, want.summary.episodes_skipped);
}

TEST(TriangularFactor, GivesTheSameFitHoweverTheRowsAreCut) {
  const Recording recording = sample_recording();
  for (ArxOffset offset : {ArxOffset::kMean, ArxOffset::kNone, ArxOffset::kEstimate}) {
    const auto whole = fit_arx({&recording, 1}, channels(), options(offset));
    ASSERT_TRUE(whole);
    for (std::size_t parts : {1u, 2u, 3u, 8u, 100u}) {
      TriangularFactor all = empty();
      for (std::size_t k = parts; k-- > 0;) {  // the last first
        TriangularFactor part = empty();
        ASSERT_TRUE(part.add(recording, part_rows(recording.rows(), k, parts)));
        ASSERT_TRUE(all.merge(part));
      }
      const auto fit = all.finish(options(offset));
      ASSERT_TRUE(fit) << fit.error().message;
      expect_same(*fit, *whole);
    }
  }
}

TEST(TriangularFactor, TakesInATableAStretchAtATime) {
  const Recording recording = sample_recording(150000);  // more than two stretches
  std::istringstream stream(csv_text(recording));
  auto reader = CsvReader::open(stream, "sample");
  ASSERT_TRUE(reader);
  TriangularFactor factor = empty();
  const auto added = factor.add(*reader);
  ASSERT_TRUE(added) << added.error().message;
  const auto fit = factor.finish(options());
  const auto whole = fit_arx({&recording, 1}, channels(), options());
  ASSERT_TRUE(fit && whole);
  expect_same(*fit, *whole);
}

TEST(TriangularFactor, SurvivesItsBytes) {
  const Recording recording = sample_recording();
  TriangularFactor factor = empty();
  ASSERT_TRUE(factor.add(recording));
  const auto again = TriangularFactor::from_bytes(factor.bytes());
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->bytes(), factor.bytes());
  expect_same(*again->finish(options()), *factor.finish(options()));
}

// A table that is made as it is read, and looks at every refill how much memory is in use.
class EndlessTable : public std::streambuf {
 public:
  explicit EndlessTable(std::size_t rows) : rows_(rows) { take("# wisp-recording 1\n# rate_hz 60\nu:u,y:y1,y:y2\n"); }

  std::size_t max_bytes() const { return max_bytes_; }

 protected:
  int_type underflow() override {
    const struct mallinfo2 heap = mallinfo2();
    max_bytes_ = std::max(max_bytes_, heap.uordblks + heap.hblkhd);
    if (row_ == rows_) return traits_type::eof();
    std::string text;
    for (int k = 0; k < 100 && row_ < rows_; ++k, ++row_) {
      const auto u = static_cast<double>(random_() % 1000);
      const double y1 = 0.5 * y1_ - 0.2 * y2_ + u + static_cast<double>(random_() % 100);
      y2_ = 0.3 * y2_ + 0.1 * y1_ + static_cast<double>(random_() % 100);
      y1_ = y1;
      text += std::to_string(u) + "," + std::to_string(y1_) + "," + std::to_string(y2_) + "\n";
    }
    take(std::move(text));
    return traits_type::to_int_type(*gptr());
  }

 private:
  void take(std::string text) {
    text_ = std::move(text);
    setg(text_.data(), text_.data(), text_.data() + text_.size());
  }

  std::size_t rows_;
  std::size_t row_ = 0;
  double y1_ = 0, y2_ = 0;
  std::mt19937 random_{4};
  std::string text_;
  std::size_t max_bytes_ = 0;
};

std::size_t max_bytes_while_reading(std::size_t rows) {
  EndlessTable table(rows);
  std::istream stream(&table);
  auto reader = CsvReader::open(stream, "endless");
  EXPECT_TRUE(reader);
  TriangularFactor factor = empty();
  EXPECT_TRUE(factor.add(*reader));
  EXPECT_EQ(factor.rows(), rows - 3);
  return table.max_bytes();
}

TEST(TriangularFactor, MemoryDoesNotGrowWithTheTable) {
  max_bytes_while_reading(200000);  // whatever is allocated once and kept
  const std::size_t some = max_bytes_while_reading(200000);
  const std::size_t many = max_bytes_while_reading(1600000);
  // The rows between would be 34 MB as numbers.
  EXPECT_LT(many, some + 100000);
}

TEST(TriangularFactor, SharesOfATableAreThoseOfTheRecording) {
  const Recording recording = sample_recording(150000);
  const std::string text = csv_text(recording);
  for (std::size_t count : {2u, 3u, 50u}) {
    TriangularFactor all = empty();
    for (std::size_t k = 0; k < count; ++k) {
      std::istringstream stream(text);
      auto reader = CsvReader::open(stream, "sample");
      ASSERT_TRUE(reader);
      TriangularFactor part = empty();
      const PartRows rows = part_rows(recording.rows(), k, count);
      ASSERT_TRUE(part.add(*reader, rows, recording.rows()));
      TriangularFactor want = empty();
      ASSERT_TRUE(want.add(recording, rows));
      EXPECT_EQ(part.rows(), want.rows()) << k << " of " << count;
      ASSERT_TRUE(all.merge(part));
    }
    const auto fit = all.finish(options());
    const auto whole = fit_arx({&recording, 1}, channels(), options());
    ASSERT_TRUE(fit && whole);
    expect_same(*fit, *whole);
  }
}

TEST(TriangularFactor, KnowsRangesAndRate) {
  const Recording recording = sample_recording();
  TriangularFactor first = empty();
  TriangularFactor second = empty();
  ASSERT_TRUE(first.add(recording, part_rows(recording.rows(), 0, 2)));
  ASSERT_TRUE(second.add(recording, part_rows(recording.rows(), 1, 2)));
  ASSERT_TRUE(second.merge(first));
  EXPECT_EQ(second.rate_hz(), 60);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto& samples = recording.channels[c == 2 ? 0 : c + 1].samples;
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    for (double sample : samples) {
      if (std::isnan(sample)) continue;
      lowest = std::min(lowest, sample);
      highest = std::max(highest, sample);
    }
    EXPECT_EQ(second.spans()[c].lowest, lowest);
    EXPECT_EQ(second.spans()[c].highest, highest);
  }
}

TEST(TriangularFactor, EveryChangedByteAndEveryCutIsNoticed) {
  const Recording recording = sample_recording(50);
  TriangularFactor factor = empty();
  ASSERT_TRUE(factor.add(recording));
  const std::vector<std::byte> bytes = factor.bytes();
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    std::vector<std::byte> changed = bytes;
    changed[k] ^= std::byte{4};
    EXPECT_FALSE(TriangularFactor::from_bytes(changed)) << k;
    EXPECT_FALSE(TriangularFactor::from_bytes(std::span(bytes).first(k))) << k;
  }
}

TEST(TriangularFactor, RefusesPartsOfAnotherModel) {
  TriangularFactor factor = empty();
  const auto other = TriangularFactor::create(
      {.channels = channels(), .orders = make_orders({.outputs = 2, .inputs = 1, .na = 4, .nb = 2, .nk = 1})});
  const auto merged = factor.merge(*other);
  ASSERT_FALSE(merged);
  EXPECT_NE(merged.error().message.find("orders"), std::string::npos);
}

TEST(TriangularFactor, WithoutRowsCannotBeFinished) {
  EXPECT_FALSE(empty().finish(options()));
  TriangularFactor factor = empty();
  ASSERT_TRUE(factor.add(sample_recording(), {0, 5}));
  EXPECT_FALSE(factor.finish(options()));
}

TEST(PartRows, ShareOutAllRowsOnce) {
  std::size_t next = 0;
  for (std::size_t k = 0; k < 7; ++k) {
    const PartRows part = part_rows(100, k, 7);
    EXPECT_EQ(part.begin, next);
    EXPECT_GE(part.end - part.begin, 14u);
    EXPECT_LE(part.end - part.begin, 15u);
    next = part.end;
  }
  EXPECT_EQ(next, 100u);
}

}  // namespace
}  // namespace wisp::triangular_factor_test
