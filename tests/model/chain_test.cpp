#include "wisp/model/chain.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <limits>

#include "model/sample_chain.hpp"
#include "wisp/model/file.hpp"

namespace wisp {
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
  EXPECT_EQ(x.segments.onward, y.segments.onward);
  EXPECT_EQ(x.initial, y.initial);
  ASSERT_EQ(x.contexts.size(), y.contexts.size());
  for (std::size_t k = 0; k < x.contexts.size(); ++k) {
    EXPECT_EQ(x.contexts[k].history, y.contexts[k].history);
    EXPECT_EQ(x.contexts[k].probability, y.contexts[k].probability);
  }
  EXPECT_EQ(x.blend.share, y.blend.share);
  EXPECT_EQ(x.blend.longest_steps, y.blend.longest_steps);
  ASSERT_EQ(x.drift.has_value(), y.drift.has_value());
  if (x.drift) {
    EXPECT_EQ(x.drift->lead, y.drift->lead);
    EXPECT_EQ(x.drift->drift, y.drift->drift);
    EXPECT_EQ(x.drift->memory_seconds, y.drift->memory_seconds);
  }
}

TEST(ChainModel, WhatIsWrittenIsRead) {
  for (const Model& model : {sample_chain(), sample_chain(ChainMotion::kPosition), onward_chain(), windy_chain(),
                             system_chain(1), system_chain(2)}) {
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

TEST(ChainModel, EveryTruncationAndEveryBitFlipIsAnError) {
  std::vector<std::byte> bytes = *model_bytes(sample_chain());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ASSERT_FALSE(parse_model(std::span(bytes).first(size), "cut.wisp")) << size;
  }
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
    ASSERT_FALSE(parse_model(bytes, "flipped.wisp")) << bit;
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
  }
}

TEST(ChainModel, WhatIsNotAChainIsRefusedWithAReason) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<std::string, std::function<void(Model&)>>> broken = {
      {"sum to",
       [](Model& m) {
         chain(m).contexts[1].probability = {0.5, 0.4};
       }},
      {"not a probability",
       [](Model& m) {
         chain(m).initial = {1.5, -0.5};
       }},
      {"not a probability", [&](Model& m) { chain(m).contexts[0].probability[0] = nan; }},
      {"probabilities after 0 hold", [](Model& m) { chain(m).contexts[0].probability.pop_back(); }},
      {"has mode 2", [](Model& m) { chain(m).segments.mode[2] = 2; }},
      {"order of their modes",
       [](Model& m) {
         chain(m).segments.mode = {0, 1, 0};
       }},
      {"has no segment", [](Model& m) { chain(m).segments.mode[2] = 0; }},
      {"no steps", [](Model& m) { chain(m).segments.steps[1] = 0; }},
      {"rows hold", [](Model& m) { chain(m).segments.rows.pop_back(); }},
      {"rates hold", [](Model& m) { chain(m).segments.rates.pop_back(); }},
      {"follower 0", [](Model& m) { chain(m).segments.follow[0] = 2; }},
      {"follower 2", [](Model& m) { chain(m).segments.follow[2] = 9; }},
      {"shares of what follows",
       [](Model& m) {
         chain(m).segments.onward = {1, 2, 3};
       }},
      {"is 0, expected 1 to 65535", [](Model& m) { chain(m).segments.onward = {1, 2, 3, 4, 5, 0}; }},
      {"row scales", [&](Model& m) { chain(m).segments.row_scale[0] = nan; }},
      {"rate scales", [](Model& m) { chain(m).segments.rate_scale[1] = 0; }},
      {"what follows mode 1", [](Model& m) { chain(m).contexts.erase(chain(m).contexts.begin() + 1); }},
      {"twice", [](Model& m) { chain(m).contexts.push_back(chain(m).contexts[2]); }},
      {"a history of the chain has mode", [](Model& m) { chain(m).contexts[2].history[0] = 7; }},
      {"a history of the chain has 0 modes", [](Model& m) { chain(m).contexts[2].history.clear(); }},
      {"expected 0 to 0.5", [](Model& m) { chain(m).blend.share = 0.75; }},
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
  };
  for (const auto& [word, harm] : broken) {
    Model model = steered_chain();
    harm(model);
    const auto outcome = model_bytes(model);
    ASSERT_FALSE(outcome) << word;
    EXPECT_THAT(outcome.error().message, HasSubstr(word));
  }
}

TEST(ChainModel, SystemsThatAreNoneAreRefusedWithAReason) {
  const std::vector<std::pair<std::string, std::function<void(ChainModel&)>>> broken = {
      {"degree 3", [](ChainModel& c) { c.systems->degree = 3; }},
      {"systems for 1", [](ChainModel& c) { c.systems->modes.pop_back(); }},
      {"coefficients", [](ChainModel& c) { c.systems->modes[1].coefficient.pop_back(); }},
      {"out of range", [](ChainModel& c) { c.systems->modes[1].noise[0] = std::numeric_limits<double>::quiet_NaN(); }},
      {"not one", [](ChainModel& c) { c.systems->modes[0].lowest[2] = 100; }},
      {"no step", [](ChainModel& c) { c.systems->modes[0].steps[3] = 0; }},
      {"can't be", [](ChainModel& c) { c.drift = std::get<ChainModel>(steered_chain().dynamics).drift; }},
  };
  for (const auto& [word, harm] : broken) {
    Model model = system_chain();
    harm(chain(model));
    const auto outcome = model_bytes(model);
    ASSERT_FALSE(outcome) << word;
    EXPECT_THAT(outcome.error().message, HasSubstr(word));
  }
}

TEST(ChainModel, TransitionsAreThoseAfterOneMode) {
  Model model = sample_chain();
  EXPECT_EQ(chain(model).transitions(), (std::vector<double>{0.25, 0.75, 0.5, 0.5}));
  EXPECT_EQ(chain(model).history(), 2);
}

}  // namespace
}  // namespace wisp
