#include "wisp/export/export.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "paths.hpp"
#include "run/flame_model.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::take_test {
namespace {

Model leaf() {
  const auto model = read_model(WISP_SOURCE_DIR "/apps/web/public/models/leaf.wisp");
  EXPECT_TRUE(model) << model.error().message;
  return *model;
}

// What drives each output in each frame of a loop: the model's equation, over the seam as anywhere else.
std::vector<std::vector<double>> shocks_around(const Model& model, const Take& take) {
  const auto& arx = std::get<ArxModel>(model.dynamics);
  std::vector<std::vector<double>> shocks(take.outputs, std::vector<double>(take.frames));
  const auto at = [&](std::size_t frame, std::size_t lag, int i) {
    return take.at((frame + take.frames - lag) % take.frames, 0)[i] - arx.output_mean[i];
  };
  for (int i = 0; i < static_cast<int>(take.outputs); ++i) {
    for (std::size_t t = 0; t < take.frames; ++t) {
      double sum = at(t, 0, i);
      for (int j = 0; j < static_cast<int>(take.outputs); ++j) {
        const auto a = arx.a(i, j);
        for (std::size_t lag = 0; lag < a.size(); ++lag) sum += a[lag] * at(t, lag + 1, j);
      }
      shocks[i][t] = sum;
    }
  }
  return shocks;
}

// Largest shock of the frames around the seam over the largest of the others.
double seam(const Model& model, const Take& take) {
  double worst = 0;
  for (const auto& shocks : shocks_around(model, take)) {
    double beside = 0, elsewhere = 0;
    for (std::size_t t = 0; t < shocks.size(); ++t) {
      double& largest = t < 6 || t + 6 > shocks.size() ? beside : elsewhere;
      largest = std::max(largest, std::abs(shocks[t]));
    }
    worst = std::max(worst, beside / elsewhere);
  }
  return worst;
}

TEST(Take, ALoopOfAFlameObeysItsEquationOverTheSeam) {
  const Model model = flame_model();
  const auto loop = take(model, {.seconds = 8, .loop = true, .seed = 3});
  const auto play = take(model, {.seconds = 8, .seed = 3});
  ASSERT_TRUE(loop && play);
  EXPECT_EQ(loop->frames, 240u);
  // 240 Gaussian shocks: the largest of 12 is below that of the others by far.
  EXPECT_LT(seam(model, *loop), 1.5);
  EXPECT_GT(seam(model, *play), 3) << "what is no loop is not told from one";
}

TEST(Take, ALoopIsWhatIsPlayedWithoutOneOnceTheSeamIsForgotten) {
  const Model model = flame_model();
  const auto loop = take(model, {.seconds = 10, .loop = true, .seed = 5});
  const auto play = take(model, {.seconds = 12, .seed = 5});
  ASSERT_TRUE(loop && play);
  constexpr std::size_t kLags = 4, kForgotten = 150;
  for (std::size_t t = kForgotten; t < loop->frames; ++t) {
    for (std::size_t i = 0; i < loop->outputs; ++i) {
      ASSERT_NEAR(loop->at(t, 0)[i], play->at(t + kLags - 1, 0)[i], 1e-5) << t;
    }
  }
}

// Standard deviations of an output and of its steps.
struct Spread {
  double value = 0;
  double step = 0;
};

Spread spread_of(const std::vector<Take>& takes, std::size_t output) {
  double sum = 0, squares = 0, steps = 0, count = 0;
  for (const Take& take : takes) {
    for (std::size_t t = 0; t < take.frames; ++t) {
      const double value = take.at(t, 0)[output], next = take.at((t + 1) % take.frames, 0)[output];
      sum += value;
      squares += value * value;
      if (take.loop || t + 1 < take.frames) steps += (next - value) * (next - value);
      count += 1;
    }
  }
  return {std::sqrt(squares / count - sum / count * sum / count), std::sqrt(steps / count)};
}

TEST(Take, LoopsSpreadAsPlayDoes) {
  const Model model = flame_model();
  std::vector<Take> loops, plays;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    loops.push_back(*take(model, {.seconds = 5, .loop = true, .seed = seed}));
    plays.push_back(*take(model, {.seconds = 5, .seed = 100 + seed}));
  }
  for (std::size_t output = 0; output < model.outputs.size(); ++output) {
    // 300 s that remember about 0.2 s: 1500 values that know nothing of each other, 1.8 % of a standard deviation each.
    // A crossfade of two plays over half a second would take about 5 % away.
    const Spread of_loops = spread_of(loops, output), of_plays = spread_of(plays, output);
    EXPECT_NEAR(of_loops.value / of_plays.value, 1, 0.08) << output;
    EXPECT_NEAR(of_loops.step / of_plays.step, 1, 0.05) << output;
  }
}

TEST(Take, ALoopStaysInTheRangeThatOutputsAreClampedTo) {
  Model model = flame_model();
  for (Output& output : model.outputs) {
    const double middle = (output.lowest + output.highest) / 2, room = 0.05 * (output.highest - output.lowest);
    output.lowest = middle - room;
    output.highest = middle + room;
  }
  const auto loop = take(model, {.seconds = 8, .loop = true});
  ASSERT_TRUE(loop) << loop.error().message;
  std::size_t clamped = 0;
  for (std::size_t t = 0; t < loop->frames; ++t) {
    for (std::size_t i = 0; i < loop->outputs; ++i) {
      const Output& output = model.outputs[i];
      const double room = kRangeMargin * (output.highest - output.lowest), value = loop->at(t, 0)[i];
      EXPECT_GE(value, static_cast<float>(output.lowest - room));
      EXPECT_LE(value, static_cast<float>(output.highest + room));
      clamped +=
          value == static_cast<float>(output.lowest - room) || value == static_cast<float>(output.highest + room);
    }
  }
  EXPECT_GT(clamped, 0U) << "nothing was clamped, so nothing was shown";
}

TEST(Take, ALoopOfAFlameWithResampledResidualsClosesToo) {
  const Model model = default_flame_model();
  const auto loop = take(model, {.seconds = 4, .loop = true});
  ASSERT_TRUE(loop) << loop.error().message;
  EXPECT_LT(seam(model, *loop), 1.5);
}

TEST(Take, ALoopOfALeafMeetsItsBeginInAttitudeAndVelocity) {
  const Model model = leaf();
  const auto loop = take(model, {.seconds = 4, .loop = true, .instances = 2});
  ASSERT_TRUE(loop) << loop.error().message;
  ASSERT_EQ(loop->travel.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    double jump_elsewhere = 0, jump_at_seam = 0, turn_elsewhere = 0, turn_at_seam = 0;
    const auto place = [&](std::ptrdiff_t t, std::size_t axis) {
      const auto frames = static_cast<std::ptrdiff_t>(loop->frames);
      const double rounds = std::floor(static_cast<double>(t) / static_cast<double>(frames));
      return loop->at(static_cast<std::size_t>((t % frames + frames) % frames), k)[axis] +
             rounds * loop->travel[k][axis];
    };
    for (std::ptrdiff_t t = 0; t < static_cast<std::ptrdiff_t>(loop->frames); ++t) {
      double jump = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        jump = std::max(jump, std::abs(place(t + 1, axis) - 2 * place(t, axis) + place(t - 1, axis)));
      }
      const auto q = loop->at(static_cast<std::size_t>(t), k).subspan(3);
      const auto before = loop->at(t == 0 ? loop->frames - 1 : static_cast<std::size_t>(t) - 1, k).subspan(3);
      double along = 0;
      for (std::size_t c = 0; c < 4; ++c) along += static_cast<double>(q[c]) * before[c];
      const double turn = 1 - std::abs(along);
      const bool at_seam = t <= 1 || t + 1 == static_cast<std::ptrdiff_t>(loop->frames);
      (at_seam ? jump_at_seam : jump_elsewhere) = std::max(at_seam ? jump_at_seam : jump_elsewhere, jump);
      (at_seam ? turn_at_seam : turn_elsewhere) = std::max(at_seam ? turn_at_seam : turn_elsewhere, turn);
    }
    EXPECT_LT(jump_at_seam, jump_elsewhere);
    EXPECT_LT(turn_at_seam, turn_elsewhere);
    EXPECT_LT(loop->travel[k][2], -0.5) << "in four seconds a leaf falls";
  }
}

TEST(Take, LoopsOfNeighbouringSeedsShareNoLeaf) {
  const auto first = take(leaf(), {.seconds = 2, .loop = true, .instances = 3, .seed = 1});
  const auto second = take(leaf(), {.seconds = 2, .loop = true, .instances = 3, .seed = 2});
  for (const auto& a : first->travel) {
    for (const auto& b : second->travel) EXPECT_NE(a, b);
  }
}

TEST(Take, IsWhatABankPlays) {
  const Model model = leaf();
  const auto taken = take(model, {.seconds = 1, .instances = 3, .seed = 9});
  ASSERT_TRUE(taken);
  auto bank = Bank::create(model, {.capacity = 3, .seed = 9});
  for (int k = 0; k < 3; ++k) bank->spawn();
  std::vector<float> outputs(21);
  for (std::size_t frame = 0; frame < taken->frames; ++frame) {
    bank->step();
    bank->outputs(outputs);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_TRUE(std::ranges::equal(taken->at(frame, k), std::span(outputs).subspan(7 * k, 7)));
    }
  }
}

TEST(Take, WhatCannotBeTakenIsSaid) {
  const Model model = flame_model();
  EXPECT_NE(take(model, {.seconds = 0}).error().message.find("expected above 0"), std::string::npos);
  EXPECT_NE(take(model, {.instances = 0}).error().message.find("expected 1 to 1000"), std::string::npos);
  EXPECT_NE(take(model, {.seconds = 3600, .instances = 1000}).error().message.find("5e8"), std::string::npos);
  EXPECT_NE(take(model, {.inputs = {1, 2}}).error().message.find("the model has 1"), std::string::npos);
  Model mortal = default_flame_model();
  EXPECT_NE(take(mortal, {.loop = true, .inputs = {2}}).error().message.find("goes out"), std::string::npos);
  EXPECT_NE(take(mortal, {.inputs = {2}}).error().message.find("out by the first frame"), std::string::npos);
}

TEST(Take, TheSearchForALoopSaysThatItGoesOnAndCanBeStopped) {
  std::string seen;
  const auto stop = [&](std::string_view stage, double) {
    seen = stage;
    return false;
  };
  EXPECT_EQ(take(leaf(), {.seconds = 2, .loop = true}, stop).error().message, kStopped);
  EXPECT_EQ(seen, "searching for a loop");
}

}  // namespace
}  // namespace wisp::take_test
