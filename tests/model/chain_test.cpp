#include "wisp/model/chain.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>

#include "base/hash.hpp"
#include "model/chain_rows.hpp"
#include "model/damaged_bytes.hpp"
#include "model/sample_chain.hpp"
#include "paths.hpp"
#include "wisp/model/file.hpp"

namespace wisp::chain_test {
namespace {

using testing::HasSubstr;

const std::string kGolden = WISP_SOURCE_DIR "/tests/model/golden/v1_chain.wisp";

ChainModel& chain(Model& model) { return std::get<ChainModel>(model.dynamics); }

void expect_same(const Model& a, const Model& b) {
  EXPECT_EQ(*model_bytes(a), *model_bytes(b));
  const auto &x = std::get<ChainModel>(a.dynamics), &y = std::get<ChainModel>(b.dynamics);
  EXPECT_EQ(x.motion, y.motion);
  EXPECT_EQ(x.heading_free, y.heading_free);
  EXPECT_EQ(x.modes, y.modes);
  EXPECT_EQ(x.segments.mode, y.segments.mode);
  EXPECT_EQ(x.segments.steps, y.segments.steps);
  EXPECT_EQ(x.segments.rows, y.segments.rows);
  EXPECT_EQ(x.segments.row_scale, y.segments.row_scale);
  EXPECT_EQ(x.segments.rates, y.segments.rates);
  EXPECT_EQ(x.segments.rate_scale, y.segments.rate_scale);
  EXPECT_EQ(x.segments.follow, y.segments.follow);
  EXPECT_EQ(x.segments.breadth, y.segments.breadth);
  EXPECT_EQ(x.segments.height, y.segments.height);
  EXPECT_EQ(x.segments.height_scale, y.segments.height_scale);
  EXPECT_EQ(x.initial, y.initial);
  EXPECT_EQ(x.history, y.history);
  EXPECT_EQ(x.probabilities, y.probabilities);
  EXPECT_EQ(x.blend_steps, y.blend_steps);
  ASSERT_EQ(x.drift.has_value(), y.drift.has_value());
  if (x.drift) {
    EXPECT_EQ(x.drift->lead, y.drift->lead);
    EXPECT_EQ(x.drift->drift, y.drift->drift);
    EXPECT_EQ(x.drift->memory_seconds, y.drift->memory_seconds);
  }
}

TEST(ChainModel, WhatIsWrittenIsRead) {
  for (const Model& model :
       {sample_chain(), sample_chain(ChainMotion::kPosition), bounded_chain(), windy_chain(), steered_chain()}) {
    const auto bytes = model_bytes(model);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto read = parse_model(*bytes, "chain.wisp");
    ASSERT_TRUE(read) << read.error().message;
    expect_same(*read, model);
    EXPECT_EQ(read->view.index(), model.view.index());
  }
}

// Written when chains came into the format; it must load, and mean the same, for ever.
TEST(ChainModel, TheGoldenFileStillMeansTheSame) {
  if (std::getenv("WISP_WRITE_GOLDEN")) {
    ASSERT_TRUE(write_model(kGolden, sample_chain()));
  }
  const auto read = read_model(kGolden);
  ASSERT_TRUE(read) << read.error().message;
  expect_same(*read, sample_chain());
  EXPECT_EQ(std::get<PoseView>(read->view).half_width, 0.0365);
}

// A file that was made to harm has a hash that fits.
std::vector<std::byte> mended(std::vector<std::byte> bytes) {
  const std::uint64_t hash = hash_bytes(std::span(bytes).subspan(32));
  for (std::size_t k = 0; k < 8; ++k) bytes[24 + k] = static_cast<std::byte>(hash >> (8 * k));
  return bytes;
}

// The sample's segments, each of which takes a hundred times as many steps and glides along a parabola.
Model lengthened(Model model) {
  ChainSegments& segments = chain(model).segments;
  segments.rows.clear();
  for (std::uint16_t& steps : segments.steps) {
    steps = static_cast<std::uint16_t>(100 * steps);
    for (int step = 0; step <= steps; ++step) {
      const double part = static_cast<double>(step) / steps, half = 0.4 * part;
      for (double x :
           {8000 * part, 3000 * part * part, -9900 * part, 32767 * std::cos(half), 32767 * std::sin(half), 0.0, 0.0})
        segments.rows.push_back(static_cast<std::int16_t>(std::lround(x)));
    }
  }
  return model;
}

TEST(ChainModel, RowsAndRatesOfAnySizeAreReadAsWritten) {
  for (ChainMotion motion : {ChainMotion::kPosition, ChainMotion::kPose}) {
    Model model = sample_chain(motion);
    ChainSegments& segments = chain(model).segments;
    std::uint32_t word = 1;
    const auto next = [&] {
      word = word * 1664525U + 1013904223U;
      return static_cast<std::int16_t>(word >> 16);
    };
    const auto channels = static_cast<std::size_t>(channel_count(motion));
    for (std::size_t k = 0; k < segments.rows.size(); ++k) {
      if (k % channels < 3) segments.rows[k] = next();  // quaternions are of length 1
    }
    for (std::int16_t& rate : segments.rates) rate = next();
    const auto read = parse_model(*model_bytes(model), "chain.wisp");
    ASSERT_TRUE(read) << read.error().message;
    expect_same(*read, model);
  }
}

TEST(ChainModel, HeightsAreReadAsWritten) {
  const Model model = bounded_chain();
  const auto read = parse_model(*model_bytes(model), "chain.wisp");
  ASSERT_TRUE(read) << read.error().message;
  expect_same(*read, model);
}

TEST(ChainModel, MoreSegmentsThanThereCanBeAreNotUnpacked) {
  // 65536 of 65536 rows each are none, counted in 32 bits.
  ChainModel many = std::get<ChainModel>(sample_chain().dynamics);
  many.segments = {};
  many.segments.mode.assign(65536, 0);
  many.segments.steps.assign(65536, 65535);
  EXPECT_FALSE(unpack_segments(std::vector<std::uint8_t>(200'000), many));
  EXPECT_TRUE(many.segments.rows.empty());
}

TEST(ChainModel, MoreRowsThanTheirBytesCanHoldAreNotUnpacked) {
  // Seven numbers each of 613 566 757 rows are 2^32 + 3: three, counted in 32 bits.
  ChainModel many = std::get<ChainModel>(sample_chain().dynamics);
  many.segments = {};
  many.segments.mode.assign(9363, 0);
  many.segments.steps.assign(9363, 65535);
  many.segments.steps.back() = 18724;
  EXPECT_FALSE(unpack_segments(std::vector<std::uint8_t>(200'000), many));
  EXPECT_TRUE(many.segments.rows.empty());
}

TEST(ChainModel, FactorsOfRatesThatNoFileHasAreNotMultipliedBy) {
  const ChainModel model = std::get<ChainModel>(sample_chain().dynamics);
  std::vector<std::uint8_t> packed = packed_segments(model);
  ChainModel read = model;
  ASSERT_TRUE(unpack_segments(packed, read));
  EXPECT_EQ(read.segments.rates, model.segments.rates);
  for (std::uint8_t first : {std::uint8_t{0x7f}, std::uint8_t{0x80}}) {
    packed[0] = first;
    EXPECT_FALSE(unpack_segments(packed, read)) << int{first};
  }
}

TEST(ChainModel, SmoothMotionTakesLessThanAByteANumber) {
  Model model = steered_chain(), longer = lengthened(model);
  const auto more = chain(longer).segments.rows.size() - chain(model).segments.rows.size();
  EXPECT_LT(model_bytes(longer)->size() - model_bytes(model)->size(), more);
}

// Every byte of a file's payload changed to one of three, with the hash mended: what is read can be written again.
void expect_read_whole_or_not(const Model& harmed) {
  const std::vector<std::byte> sound = *model_bytes(harmed);
  std::size_t read = 0;
  for (std::size_t at = 32; at < sound.size(); ++at) {
    for (std::byte harm : {std::byte{0x00}, std::byte{0x7f}, std::byte{0xff}}) {
      std::vector<std::byte> bytes = sound;
      bytes[at] = harm;
      const auto model = parse_model(mended(std::move(bytes)), "harm.wisp");
      if (!model) continue;
      ++read;
      ASSERT_TRUE(model_bytes(*model)) << at;
    }
  }
  EXPECT_GT(read, 100U);
}

TEST(ChainModel, SegmentsThatWereMadeToHarmAreReadWholeOrNotAtAll) { expect_read_whole_or_not(steered_chain()); }

class ChainBytes : public testing::TestWithParam<Model (*)()> {};
INSTANTIATE_TEST_SUITE_P(Kinds, ChainBytes,
                         testing::Values([] { return sample_chain(); }, [] { return steered_chain(); }));

TEST_P(ChainBytes, EveryTruncationAndEveryBitFlipIsAnError) { expect_damage_noticed(*model_bytes(GetParam()())); }

TEST(ChainModel, WhatIsNotAChainIsRefusedWithAReason) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<std::string, std::function<void(Model&)>>> broken = {
      {"sum to", [](Model& m) { chain(m).probabilities[3] = 0.4; }},
      {"not a probability",
       [](Model& m) {
         chain(m).initial = {1.5, -0.5};
       }},
      {"not a probability", [&](Model& m) { chain(m).probabilities[0] = nan; }},
      {"probabilities hold 11, expected 12", [](Model& m) { chain(m).probabilities.pop_back(); }},
      {"has mode 2", [](Model& m) { chain(m).segments.mode[2] = 2; }},
      {"order of their modes",
       [](Model& m) {
         chain(m).segments.mode = {0, 1, 0};
       }},
      {"has no segment", [](Model& m) { chain(m).segments.mode[2] = 0; }},
      {"no steps", [](Model& m) { chain(m).segments.steps[1] = 0; }},
      {"rows hold", [](Model& m) { chain(m).segments.rows.pop_back(); }},
      {"rates hold", [](Model& m) { chain(m).segments.rates.pop_back(); }},
      {"successor 0", [](Model& m) { chain(m).segments.follow[0] = 2; }},
      {"successor 2", [](Model& m) { chain(m).segments.follow[2] = 9; }},
      {"heights",
       [](Model& m) {
         chain(m).segments.height = {1, 2};
       }},
      {"scale of heights",
       [](Model& m) {
         chain(m).segments.height = {1, 2, 3};
       }},
      {"row scales", [&](Model& m) { chain(m).segments.row_scale[0] = nan; }},
      {"rate scales", [](Model& m) { chain(m).segments.rate_scale[1] = 0; }},
      {"probabilities after 1 0 sum to", [](Model& m) { chain(m).probabilities[8] = 0.5; }},
      {"looks 0 modes back", [](Model& m) { chain(m).history = 0; }},
      {"looks 3 modes back", [](Model& m) { chain(m).history = 3; }},
      {"probabilities hold 12, expected 4", [](Model& m) { chain(m).history = 1; }},
      {"expected 0 to 4096", [](Model& m) { chain(m).blend_steps = 4097; }},
      {"modes", [](Model& m) { chain(m).modes = 0; }},
      {"moves 7 outputs", [](Model& m) { m.outputs.pop_back(); }},
      {"a pose needs 7",
       [](Model& m) {
         m = sample_chain(ChainMotion::kPosition);
         m.view = PoseView{};
       }},
      {"leads hold", [](Model& m) { chain(m).drift->lead.pop_back(); }},
      {"steered by", [](Model& m) { chain(m).drift->spread_ground = 0; }},
      {"steered by", [&](Model& m) { chain(m).drift->drift[1] = nan; }},
      {"size of the body", [](Model& m) { std::get<PoseView>(m.view).half_width = -1; }},
      {"size of the body", [](Model& m) { std::get<PoseView>(m.view).half_length = 1e30; }},
      {"quaternion of length 0.0", [](Model& m) { std::fill_n(chain(m).segments.rows.begin() + 3, 4, 0); }},
      {"quaternion of length 1.4", [](Model& m) { chain(m).segments.rows[4] = 32767; }},
      {"quaternion of length 2", [](Model& m) { chain(m).segments.row_scale[1] *= 2; }},
  };
  for (const auto& [word, harm] : broken) {
    Model model = steered_chain();
    harm(model);
    const auto outcome = model_bytes(model);
    ASSERT_FALSE(outcome) << word;
    EXPECT_THAT(outcome.error().message, HasSubstr(word));
  }
}

TEST(ChainModel, NumbersOnTheBoundsAreTaken) {
  const std::vector<std::pair<std::string, std::function<void(Model&)>>> bounds = {
      {"certain",
       [](Model& m) {
         chain(m).initial = {1, 0};
       }},
      {"one mode",
       [](Model& m) {
         chain(m).modes = 1;
         chain(m).segments.mode = {0, 0, 0};
         chain(m).segments.follow = {1, 0, 2, 0, 1, 2};
         chain(m).initial = {1};
         chain(m).history = 1;
         chain(m).probabilities = {1};
       }},
      {"largest scale", [](Model& m) { chain(m).segments.row_scale[0] = chain(m).segments.rate_scale[1] = 1e9; }},
      {"nothing to choose from",
       [](Model& m) {
         chain(m).segments.breadth = 0;
         chain(m).segments.follow.clear();
       }},
      {"longest blend", [](Model& m) { chain(m).blend_steps = 4096; }},
      {"no blend", [](Model& m) { chain(m).blend_steps = 0; }},
      {"long memory", [](Model& m) { chain(m).drift->memory_seconds = 1e6; }},
      {"no memory", [](Model& m) { chain(m).drift->memory_seconds = 0; }},
      {"smallest spread", [](Model& m) { chain(m).drift->spread_ground = 1e-12; }},
      {"largest spread", [](Model& m) { chain(m).drift->spread_height = 1e9; }},
      {"fastest drift", [](Model& m) { chain(m).drift->drift[1] = -1e9; }},
      {"largest body",
       [](Model& m) {
         m.view = PoseView{1e4, 0};
       }},
      {"shorter history",
       [](Model& m) {
         chain(m).history = 1;
         chain(m).probabilities.resize(4);
       }},
  };
  for (const auto& [what, change] : bounds) {
    Model model = steered_chain();
    change(model);
    const auto ok = check(model);
    EXPECT_TRUE(ok) << what << ": " << ok.error().message;
  }
}

TEST(ChainModel, ResponsesToGustsThatAreNoneAreRefusedWithAReason) {
  const std::vector<std::pair<std::string, std::function<void(GustResponse&)>>> broken = {
      {"coefficient", [](GustResponse& g) { g.vertical.wind = 1001; }},
      {"coefficient", [](GustResponse& g) { g.ground.press = std::numeric_limits<double>::quiet_NaN(); }},
      {"never dies away", [](GustResponse& g) { g.ground.change = 1; }},
      {"never dies away", [](GustResponse& g) { g.vertical.change = -1.5; }},
  };
  for (const auto& [word, harm] : broken) {
    Model model = windy_chain();
    harm(*chain(model).gust);
    const auto ok = check(model);
    ASSERT_FALSE(ok) << word;
    EXPECT_THAT(ok.error().message, HasSubstr(word));
  }
  Model edge = windy_chain();
  for (auto* axis : {&chain(edge).gust->ground, &chain(edge).gust->vertical}) *axis = {0.999, -1000, 1000};
  EXPECT_TRUE(check(edge));
}

TEST(ChainModel, TransitionsAreThoseAfterOneMode) {
  Model model = sample_chain();
  EXPECT_EQ(chain(model).transitions(), (std::vector<double>{0.25, 0.75, 0.5, 0.5}));
}

}  // namespace
}  // namespace wisp::chain_test
