#include "wisp/model/file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <tuple>

#include "model/same_regression.hpp"
#include "model/sample_model.hpp"
#include "paths.hpp"
#include "wisp/base/file.hpp"

namespace wisp::file_test {
namespace {

using testing::HasSubstr;

const std::string kGolden = WISP_SOURCE_DIR "/tests/model/golden/v1.wisp";
const std::string kGoldenResampled = WISP_SOURCE_DIR "/tests/model/golden/v1-resampled.wisp";
const std::string kGoldenExtinction = WISP_SOURCE_DIR "/tests/model/golden/v1-extinction.wisp";

// The sample with a rule of extinction of which no number is a default.
Model mortal_model() {
  Model model = sample_model();
  model.extinction = Extinction{0, 1.75, 0.25, 1.5, 0.375, {{240, 120, 200}, {2, 3}}, {{150, 255}, {2}}};
  return model;
}

std::vector<std::byte> sample_bytes() { return std::move(model_bytes(sample_model())).value(); }

void expect_same(const Model& a, const Model& b) {
  EXPECT_EQ(*model_bytes(a), *model_bytes(b));
  const auto &x = std::get<ArxModel>(a.dynamics), &y = std::get<ArxModel>(b.dynamics);
  expect_same_frame(x, y);
  expect_same_coefficients(x, y);
  EXPECT_EQ(x.noise.sd, y.noise.sd);
  EXPECT_EQ(x.noise.sd_ci95, y.noise.sd_ci95);
  EXPECT_EQ(a.rate_hz, b.rate_hz);
  EXPECT_EQ(a.inputs.at(0).shape, b.inputs.at(0).shape);
  EXPECT_EQ(a.outputs.at(3).name, b.outputs.at(3).name);
  EXPECT_EQ(std::get<OutlineView>(a.view).knots, std::get<OutlineView>(b.view).knots);
  EXPECT_EQ(std::get<OutlineView>(a.view).shape, std::get<OutlineView>(b.view).shape);
  EXPECT_EQ(a.training, b.training);
  EXPECT_EQ(a.extinction, b.extinction);
}

TEST(ModelFile, WhatIsWrittenIsRead) {
  const auto read = parse_model(sample_bytes(), "sample.wisp");
  ASSERT_TRUE(read) << read.error().message;
  expect_same(*read, sample_model());
}

// The sample's four control points as two symmetric components and one antisymmetric one.
Model shaped_model() {
  Model model = sample_model();
  auto& arx = std::get<ArxModel>(model.dynamics);
  const int inputs = arx.orders.inputs();
  arx.orders = {OrderMatrix(3, 3, 1), OrderMatrix(3, inputs), OrderMatrix(3, inputs)};
  arx.theta.assign(3, {-0.1, 0.2, 0.1});
  arx.std_error.clear();
  arx.constant = arx.output_mean = arx.noise.sd = {0, 0.5, 1};
  arx.noise.sd_ci95.clear();
  ShapeComponents& shape = std::get<OutlineView>(model.view).shape;
  shape.symmetric = 2;
  shape.antisymmetric = 1;
  shape.rest = {0.1, 0, 0.05, 1, 0, 0, 0.01, 0};
  shape.basis = {0.01, 0, 0, 0, 0.02, 0.1, 0.3, 0, 0, 0.01, 0.2, 0.1};
  shape.coordinates.assign(8, {-2, 2});
  shape.components.assign(3, {-4, 4.5});
  return model;
}

TEST(ModelFile, AShapeOfComponentsIsKept) {
  const Model model = shaped_model();
  ASSERT_TRUE(check(model)) << check(model).error().message;
  const auto bytes = model_bytes(model);
  ASSERT_TRUE(bytes);
  const auto read = parse_model(*bytes, "shaped.wisp");
  ASSERT_TRUE(read) << read.error().message;
  expect_same(*read, model);
  Model bad = model;
  std::get<OutlineView>(bad.view).shape.basis.pop_back();
  EXPECT_FALSE(check(bad));
  bad = model;
  std::get<OutlineView>(bad.view).shape.antisymmetric = 2;
  EXPECT_FALSE(check(bad));
  bad = model;
  std::get<OutlineView>(bad.view).shape.coordinates[3] = {2, 1};
  EXPECT_FALSE(check(bad));
}

// Two stretches of residuals to be played again, mirrored in a wind from the other side.
Model resampled_model() {
  Model model = sample_model();
  ResampledResiduals& resampled = std::get<ArxModel>(model.dynamics).noise.resampled;
  for (int i = 0; i < 8; ++i) {
    resampled.scale.push_back(1e-5 * (1 + i));
    resampled.mirror.push_back(i % 2 == 0 ? -(7 - i) : 9 - i);
  }
  for (int k = 0; k < 5 * 8; ++k) resampled.rows.push_back(static_cast<std::int8_t>(6 * k - 120));
  resampled.ends = {2, 5};
  resampled.wind_scale = 1e-4;
  resampled.winds = {0, 0, 0, 100, 100, -7, 3, 9000, 12, 32767, -32768};
  resampled.toward = 3;
  resampled.lags = {0, 1, 3};
  resampled.tolerance = 0.15;
  resampled.margin = 0.04;
  resampled.longest = 90;
  return model;
}

void expect_same_resampled(const Model& read, const Model& made = resampled_model()) {
  const ResampledResiduals& x = std::get<ArxModel>(read.dynamics).noise.resampled;
  const ResampledResiduals& y = std::get<ArxModel>(made.dynamics).noise.resampled;
  EXPECT_EQ(std::tie(x.scale, x.rows, x.ends, x.winds, x.mirror), std::tie(y.scale, y.rows, y.ends, y.winds, y.mirror));
  EXPECT_EQ(std::tie(x.wind_scale, x.toward, x.lags, x.tolerance, x.margin, x.longest),
            std::tie(y.wind_scale, y.toward, y.lags, y.tolerance, y.margin, y.longest));
}

TEST(ModelFile, ResampledResidualsAreReadAsTheyWereWritten) {
  const auto read = parse_model(*model_bytes(resampled_model()), "resampled.wisp");
  ASSERT_TRUE(read) << read.error().message;
  expect_same_resampled(*read);
}

TEST(ModelFile, AnInputOfThreePowersIsReadAsItWasWritten) {
  Model model;
  model.name = "powers";
  model.rate_hz = 60;
  model.inputs = {{"wind", "", -1, 1, InputShape::kEvenOdd}};
  model.outputs = {{"y", "", -1, 1}};
  ArxModel arx;
  arx.orders = {OrderMatrix(1, 1, 1), OrderMatrix(1, 6, 1), OrderMatrix(1, 6)};
  arx.theta = {{-0.5, 1, 2, 3, 4, 5, 6}};
  arx.constant = arx.output_mean = {0};
  arx.input_mean.assign(6, 0.0);
  arx.noise.sd = {0};
  model.dynamics = arx;
  const auto read = parse_model(*model_bytes(model), "powers.wisp");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->inputs[0].shape, InputShape::kEvenOdd);
  EXPECT_EQ(std::get<ArxModel>(read->dynamics).theta, arx.theta);
}

// Written when residuals came to be resampled.
TEST(ModelFile, TheGoldenFileWithResampledResidualsStillMeansTheSame) {
  if (std::getenv("WISP_WRITE_GOLDEN")) {
    ASSERT_TRUE(write_model(kGoldenResampled, resampled_model()));
  }
  const auto read = read_model(kGoldenResampled);
  ASSERT_TRUE(read) << read.error().message;
  expect_same(*read, resampled_model());
  expect_same_resampled(*read);
}

TEST(ModelFile, ResampledResidualsThatMeanNothingAreRefused) {
  struct Case {
    const char* word;
    void (*spoil)(ResampledResiduals&);
  };
  const Case cases[] = {
      {"one number an output", [](ResampledResiduals& d) { d.rows.pop_back(); }},
      {"ends before it begins",
       [](ResampledResiduals& d) {
         d.ends = {5, 5};
       }},
      {"without rows", [](ResampledResiduals& d) { d.rows.clear(); }},
      {"scale", [](ResampledResiduals& d) { d.scale[2] = -1; }},
      {"number of wind", [](ResampledResiduals& d) { d.winds.pop_back(); }},
      {"number of wind", [](ResampledResiduals& d) { d.lags.back() = 4; }},
      {"lags",
       [](ResampledResiduals& d) {
         d.lags = {0, 3, 3};
       }},
      {"lags",
       [](ResampledResiduals& d) {
         d.lags = {1, 2, 3};
       }},
      {"lags", [](ResampledResiduals& d) { d.lags.clear(); }},
      {"input that is not there", [](ResampledResiduals& d) { d.toward = 6; }},
      {"input that is not there", [](ResampledResiduals& d) { d.toward = -2; }},
      {"wind", [](ResampledResiduals& d) { d.tolerance = NAN; }},
      {"negative", [](ResampledResiduals& d) { d.margin = -1; }},
      {"steps", [](ResampledResiduals& d) { d.longest = 0; }},
      {"mirror", [](ResampledResiduals& d) { d.mirror[0] = 0; }},
      {"mirror", [](ResampledResiduals& d) { d.mirror[0] = 9; }},
      {"mirror", [](ResampledResiduals& d) { d.mirror.pop_back(); }},
  };
  for (const Case& one : cases) {
    Model model = resampled_model();
    one.spoil(std::get<ArxModel>(model.dynamics).noise.resampled);
    const auto ok = check(model);
    ASSERT_FALSE(ok) << one.word;
    EXPECT_THAT(ok.error().message, HasSubstr(one.word));
  }
}

TEST(ModelFile, EveryShapeOfInputIsKept) {
  for (const InputShape shape : {InputShape::kLinear, InputShape::kEvenOdd}) {
    Model model = sample_model();
    model.inputs[0].shape = shape;
    auto& arx = std::get<ArxModel>(model.dynamics);
    const int inputs = regressor_count(shape);
    arx.orders.nb = OrderMatrix(8, inputs, 0);
    arx.orders.nk = OrderMatrix(8, inputs, 0);
    for (int i = 0; i < 8; ++i) arx.theta[i].resize(3);
    arx.std_error.clear();
    arx.input_mean.assign(inputs, 0.25);
    const auto read = parse_model(*model_bytes(model), "shape.wisp");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->inputs[0].shape, shape);
  }
}

// The golden file was written by the first release; it must load, and mean the same, for ever.
TEST(ModelFile, TheGoldenFileOfVersion1StillMeansTheSame) {
  if (std::getenv("WISP_WRITE_GOLDEN")) {
    ASSERT_TRUE(write_model(kGolden, sample_model()));
  }
  const auto read = read_model(kGolden);
  ASSERT_TRUE(read) << read.error().message;
  expect_same(*read, sample_model());
}

TEST(ModelFile, ARuleOfExtinctionIsReadAsItWasWritten) {
  const auto read = parse_model(*model_bytes(mortal_model()), "mortal.wisp");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->extinction, mortal_model().extinction);
  EXPECT_FALSE(parse_model(sample_bytes(), "sample.wisp")->extinction);
}

// Files from before there was a rule load above; this one was written when it came.
TEST(ModelFile, TheGoldenFileWithARuleOfExtinctionStillMeansTheSame) {
  if (std::getenv("WISP_WRITE_GOLDEN")) {
    ASSERT_TRUE(write_model(kGoldenExtinction, mortal_model()));
  }
  const auto read = read_model(kGoldenExtinction);
  ASSERT_TRUE(read) << read.error().message;
  expect_same(*read, mortal_model());
}

TEST(ModelFile, EverySingleBitFlipIsAnError) {
  std::vector<std::byte> bytes = sample_bytes();
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
    const auto outcome = parse_model(bytes, "flipped.wisp");
    ASSERT_FALSE(outcome) << "bit " << bit;
    ASSERT_THAT(outcome.error().message, HasSubstr("flipped.wisp"));
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
  }
}

TEST(ModelFile, EveryTruncationIsAnError) {
  const std::vector<std::byte> bytes = sample_bytes();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ASSERT_FALSE(parse_model(std::span(bytes).first(size), "cut.wisp")) << size;
  }
}

// Returns a file's bytes with the hash of its payload in the header.
std::vector<std::byte> mended(std::vector<std::byte> bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (std::byte byte : std::span(bytes).subspan(32)) {
    hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3u;
  }
  for (int k = 0; k < 8; ++k) bytes[24 + k] = static_cast<std::byte>(hash >> (8 * k));
  return bytes;
}

// With the hash mended, damage reaches the FlatBuffer's verifier and the checks of meaning: none may crash, and what
// still loads must be a valid model.
TEST(ModelFile, DamageBehindAGoodHashNeverGivesAnInvalidModel) {
  Model whole = sample_model();
  whole.extinction = mortal_model().extinction;
  const std::vector<std::byte> good = *model_bytes(whole);
  std::size_t refused = 0;
  for (std::size_t at = 32; at < good.size(); ++at) {
    for (int value : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
      std::vector<std::byte> bytes = good;
      bytes[at] = static_cast<std::byte>(value);
      const auto outcome = parse_model(mended(bytes), "hostile.wisp");
      if (outcome) {
        EXPECT_TRUE(check(*outcome));
      } else {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 100u);
}

// The square of 65 536 components is 0 in 32 bits, the size of an empty matrix.
TEST(ModelFile, MoreComponentsThanThereCanBeAreRefusedBeforeTheirMatricesAreRead) {
  const std::vector<std::byte> good = *model_bytes(shaped_model());
  std::size_t refused = 0;
  for (std::size_t at = 32; at + 1 < good.size(); ++at) {
    std::vector<std::byte> bytes = good;
    bytes[at] = bytes[at + 1] = std::byte{0xff};
    const auto outcome = parse_model(mended(bytes), "hostile.wisp");
    if (!outcome && outcome.error().message.find("expected at most 4096") != std::string::npos) ++refused;
  }
  EXPECT_GT(refused, 0u);
}

// With 4 added to its offset, a vector begins within its first number, whose lower half becomes its length, here 2. The
// numbers are then aligned to 4 bytes only, and a sanitizer reports those that are read in place.
TEST(ModelFile, RangesAtAMisalignedAddressAreCopiedAndRefused) {
  Model model = shaped_model();
  double& lowest = std::get<OutlineView>(model.view).shape.coordinates[0].lowest;
  lowest = std::bit_cast<double>(std::bit_cast<std::uint64_t>(lowest) | 2);
  const std::vector<std::byte> good = *model_bytes(model);
  std::size_t refused = 0;
  for (std::size_t at = 32; at < good.size(); at += 4) {
    std::vector<std::byte> bytes = good;
    bytes[at] = static_cast<std::byte>(std::to_integer<unsigned>(bytes[at]) + 4);
    const auto outcome = parse_model(mended(bytes), "hostile.wisp");
    if (!outcome && outcome.error().message.find("has not one range a coordinate") != std::string::npos) ++refused;
  }
  EXPECT_GT(refused, 0u);
}

TEST(ModelFile, OtherFilesAndVersionsAreNamed) {
  const std::string text = "This is not a model, it is a letter.";
  const auto letter = parse_model(std::as_bytes(std::span(text)), "letter.txt");
  ASSERT_FALSE(letter);
  EXPECT_THAT(letter.error().message, HasSubstr("is not a .wisp model"));
  std::vector<std::byte> bytes = sample_bytes();
  bytes[8] = std::byte{7};
  EXPECT_THAT(parse_model(bytes, "new.wisp").error().message, HasSubstr("format version 7"));
  EXPECT_THAT(parse_model({}, "empty.wisp").error().message, HasSubstr("is empty"));
}

TEST(ModelFile, AModelWithoutMeaningIsNeitherWrittenNorRead) {
  const auto arx = [](Model& model) -> ArxModel& { return std::get<ArxModel>(model.dynamics); };
  const std::vector<std::pair<std::string, std::function<void(Model&)>>> broken = {
      {"rate", [](Model& m) { m.rate_hz = 0; }},
      {"outputs", [](Model& m) { m.outputs.pop_back(); }},
      {"inputs", [](Model& m) { m.inputs.clear(); }},
      {"named", [](Model& m) { m.outputs[1].name = m.outputs[0].name; }},
      {"range", [](Model& m) { m.outputs[1].lowest = 99; }},
      {"finite", [&](Model& m) { arx(m).theta[0][0] = NAN; }},
      {"coefficients", [&](Model& m) { arx(m).theta[3].pop_back(); }},
      {"negative", [&](Model& m) { arx(m).noise.sd[0] = -1; }},
      {"unstable",
       [&](Model& m) {
         arx(m).theta[0] = {-2.0, 0.5, 0.01, 0.3, -0.3};
       }},
      {"knots", [](Model& m) { std::get<OutlineView>(m.view).knots[4] = -1; }},
      {"control points",
       [](Model& m) {
         m.view = OutlineView{uniform_knots(5), 0, 0};
       }},
      {"outline's scale", [](Model& m) { std::get<OutlineView>(m.view).metres_per_unit = -1; }},
      {"outline's scale", [](Model& m) { std::get<OutlineView>(m.view).pixels_per_unit = NAN; }},
      {"figure", [](Model& m) { m.training.figures[0].value = INFINITY; }},
      {"scales of 2 inputs", [](Model& m) { m.training.inputs.resize(2); }},
      {"scale of the input wind", [](Model& m) { m.training.inputs[0].scale = 0; }},
      {"scale of the input wind", [](Model& m) { m.training.inputs[0].one_rms = NAN; }},
      {"residual deviations", [](Model& m) { m.training.residual_sd.pop_back(); }},
      {"residual deviation", [](Model& m) { m.training.residual_sd[0] = -1; }},
      {"segmentation", [](Model& m) { m.training.motion->debounce = NAN; }},
      {"cost below 0", [](Model& m) { m.training.operations_per_frame = -1; }},
      {"listens to input 1", [](Model& m) { m.extinction->input = 1; }},
      {"level", [](Model& m) { m.extinction->level = 0; }},
      {"level", [](Model& m) { m.extinction->level = NAN; }},
      {"seconds", [](Model& m) { m.extinction->seconds = -1; }},
      {"haste", [](Model& m) { m.extinction->haste = INFINITY; }},
      {"recovery", [](Model& m) { m.extinction->recovery = 0; }},
      {"dying",
       [](Model& m) {
         m.extinction->dying.ends = {2, 2, 3};
       }},
      {"catching", [](Model& m) { m.extinction->catching.sizes.pop_back(); }},
      {"numbers of shapes", [](Model& m) { m.extinction->catching.shapes = {1}; }},
  };
  for (const auto& [word, harm] : broken) {
    Model model = mortal_model();
    harm(model);
    const auto outcome = model_bytes(model);
    ASSERT_FALSE(outcome) << word;
    EXPECT_THAT(outcome.error().message, HasSubstr(word));
  }
}

TEST(ModelFile, NumbersOnTheBoundsAreTaken) {
  const std::vector<std::pair<std::string, std::function<void(Model&)>>> bounds = {
      {"slowest", [](Model& m) { m.rate_hz = 1e-6; }},
      {"fastest", [](Model& m) { m.rate_hz = 1e6; }},
      {"no range", [](Model& m) { m.outputs[1].lowest = m.outputs[1].highest; }},
      {"no noise", [](Model& m) { std::get<ArxModel>(m.dynamics).noise.sd[0] = 0; }},
      {"an interval of one number",
       [](Model& m) {
         std::get<ArxModel>(m.dynamics).noise.sd_ci95[0] = {0.01, 0.01};
       }},
      {"no scale", [](Model& m) { std::get<OutlineView>(m.view).metres_per_unit = 0; }},
      {"silence", [](Model& m) { m.training.inputs[0].one_rms = 0; }},
      {"no residual", [](Model& m) { m.training.residual_sd[0] = 0; }},
      {"no least length", [](Model& m) { m.training.motion->min_seconds = 0; }},
      {"no debounce", [](Model& m) { m.training.motion->debounce = 0; }},
      {"no cost", [](Model& m) { m.training.multiply_adds_per_frame = m.training.operations_per_frame = 0; }},
      {"smallest rule",
       [](Model& m) {
         m.extinction = Extinction{0, 1e-6, 1e-3, 0, 1e-3};
       }},
      {"largest rule",
       [](Model& m) {
         m.extinction = Extinction{0, 1e6, 3600, 100, 3600};
       }},
  };
  for (const auto& [what, change] : bounds) {
    Model model = mortal_model();
    change(model);
    const auto ok = check(model);
    EXPECT_TRUE(ok) << what << ": " << ok.error().message;
  }
}

// Readers in C would see the name end there, and two names be one.
TEST(ModelFile, ANameThatHoldsAZeroByteIsRefused) {
  Model model = sample_model();
  model.outputs[1].name = model.outputs[0].name + std::string(1, '\0') + "x";
  const auto outcome = model_bytes(model);
  ASSERT_FALSE(outcome);
  EXPECT_THAT(outcome.error().message, HasSubstr("holds a zero byte"));
}

}  // namespace
}  // namespace wisp::file_test
