#include "learn/flame/extinction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "learn/flame/learn_outline.hpp"
#include "learn/flame/made_blow_outs.hpp"
#include "learn/outline/outline_units.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::flame_sizes_test {
namespace {

using testing::HasSubstr;

// Shrinks the outline of a row towards the middle of its base.
void scale_row(Recording& recording, std::size_t row, double size) {
  const OutlineLayout layout = *outline_layout(recording);
  const auto sample = [&](std::size_t k) -> double& { return recording.channels[layout.outputs[k]].samples[row]; };
  const std::size_t last = layout.outputs.size() - 2;
  const double base[] = {(sample(0) + sample(last)) / 2, (sample(1) + sample(last + 1)) / 2};
  for (std::size_t k = 0; k < layout.outputs.size(); ++k) sample(k) = base[k % 2] + size * (sample(k) - base[k % 2]);
}

// Deaths of which each takes `decay` seconds and re-ignitions that take `re_ignition`, beginning anywhere between two
// rows.
Recording decay_and_re_ignition(double decay, double re_ignition, std::uint64_t seed) {
  Recording recording = made::blow_out_recording({.rows = 5400, .shortest = 0.2, .seed = seed}).recording;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> between(0, 1);
  const auto ramp = [&](double seconds, std::size_t at, int way) {
    const double since = between(random);
    for (int k = 0;
         (k + since) / recording.rate_hz < seconds && at + static_cast<std::size_t>(way * k) < recording.rows(); ++k) {
      scale_row(recording, at + static_cast<std::size_t>(way * k), (k + since) / recording.rate_hz / seconds);
    }
  };
  const auto blow_outs = *find_blow_outs(recording, "wind");
  for (const BlowOut& blow_out : blow_outs) {
    ramp(decay, blow_out.gone - 1, -1);
    if (blow_out.back < recording.rows()) ramp(re_ignition, blow_out.back, 1);
  }
  return recording;
}

ExtinctionEvidence evidence_of(const Recording& recording) {
  return {&recording, "wind", 1, *find_blow_outs(recording, "wind"), 0};
}

double size_at(const FlameEvents& events, std::size_t event, std::size_t step) {
  return events.sizes[(event > 0 ? events.ends[event - 1] : 0) + step] / 255.0;
}

TEST(FlameSizes, EventsAreTheRecordedOnes) {
  for (const auto& [decay, re_ignition] : {std::pair{0.1, 0.2}, {0.2, 0.5}}) {
    const Recording recording = decay_and_re_ignition(decay, re_ignition, 2);
    const ExtinctionEvidence seen = evidence_of(recording);
    const auto found = recorded_events({&seen, 1});
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_NEAR(found->vanishing_seconds, decay, 1.5 / 60);
    ASSERT_EQ(found->dying.ends.size(), 8U);
    ASSERT_EQ(found->catching.ends.size(), 8U);
    const auto sizes = *flame_sizes(recording, seen.blow_outs);
    const std::size_t back = seen.blow_outs[0].back;
    for (std::size_t k = 0; k < 40; ++k) {
      EXPECT_NEAR(size_at(found->catching, 0, k), std::min(1.0, sizes[back + k]), 1.0 / 255) << k;
    }
    // It ends with three dim rows that no outline was found in.
    for (std::size_t event = 0; event < 8; ++event) {
      const std::size_t end = found->dying.ends[event] - (event > 0 ? found->dying.ends[event - 1] : 0);
      for (std::size_t k = 1; k <= 3; ++k) {
        EXPECT_NEAR(size_at(found->dying, event, end - k),
                    static_cast<double>(k) / 4 * size_at(found->dying, event, end - 4), 2.0 / 255);
      }
    }
  }
}

// Rows are kept as components of a model's shape, with which they are the recorded outlines.
TEST(FlameSizes, ShapesAreTheRecordedOutlines) {
  const Recording recording = decay_and_re_ignition(0.2, 0.5, 2);
  ExtinctionEvidence seen = evidence_of(recording);
  const auto model = learn_outline({&recording, 1}, {});
  ASSERT_TRUE(model) << model.error().message;
  OutlineView view = std::get<OutlineView>(model->model.view);
  const OutlineLayout layout = *outline_layout(recording);
  seen.scale = model->model.training.inputs[0].scale;
  const auto found = recorded_events({&seen, 1}, view);
  ASSERT_EQ(found->catching.shapes.size(), found->catching.sizes.size() * view.shape.count());
  make_room(found->catching, view.shape);
  const Recording units = to_model_units(recording, layout, view.pixels_per_unit);
  for (std::size_t k = 0; k < 40; ++k) {
    std::vector<double> components;
    for (std::size_t c = 0; c < view.shape.count(); ++c) {
      components.push_back(found->catching.scale[c] * found->catching.shapes[k * view.shape.count() + c]);
    }
    const std::vector<double> outline = control_points(view.shape, components);
    const std::vector<double> recorded = whole_row(units, layout, seen.blow_outs[0].back + k);
    for (std::size_t i = 0; i < outline.size(); ++i) {
      EXPECT_NEAR(found->catching.sizes[k] / 255.0 * outline[i], recorded[i], 0.02) << k << ' ' << i;
    }
  }
}

// Components are relative to the spread of the outline, so that they do not depend on the unit.
TEST(FlameSizes, ShapesOfReIgnitionHaveTheUnitThatIsGiven) {
  const Recording recording = decay_and_re_ignition(0.2, 0.5, 2);
  FlameRecipe recipe;
  recipe.inputs = {"wind"};
  const auto own = learn_outline({&recording, 1}, recipe);
  ASSERT_TRUE(own) << own.error().message;
  recipe.pixels_per_unit = std::get<OutlineView>(own->model.view).pixels_per_unit / 2;
  const auto given = learn_outline({&recording, 1}, recipe);
  ASSERT_TRUE(given) << given.error().message;
  const std::vector<double>& scale = own->model.extinction->catching.scale;
  ASSERT_EQ(given->model.extinction->catching.scale.size(), scale.size());
  ASSERT_FALSE(scale.empty());
  EXPECT_NEAR(given->model.extinction->catching.scale[0], scale[0], 0.05 * scale[0]);
}

TEST(FlameSizes, WhatVanishesFromOneRowToTheNextIsSeenNoLonger) {
  const Recording recording = made::blow_out_recording({.shortest = 0.2, .seed = 3}).recording;
  const ExtinctionEvidence seen = evidence_of(recording);
  EXPECT_LE(recorded_events({&seen, 1})->vanishing_seconds, 2.0 / 60);
}

// What is learned is played: the sizes of a bank's flame are those of one of the recorded events.
TEST(FlameSizes, ABankPlaysARecordedEvent) {
  const Recording recording = decay_and_re_ignition(0.15, 0.3, 5);
  const ExtinctionEvidence seen = evidence_of(recording);
  const auto events = recorded_events({&seen, 1});
  Model model = flame_model();
  model.rate_hz = 60;
  model.extinction = Extinction{.dying = events->dying, .catching = events->catching};
  Bank bank = *Bank::create(model, {});
  const InstanceId id = bank.spawn();
  bank.extinction()->extinguish(id);
  for (int k = 0; k < 60; ++k) bank.step();
  EXPECT_EQ(bank.extinction()->state_of(id)->size, 0);
  bank.extinction()->relight(id);
  std::vector<double> played;
  for (int k = 0; k < 45; ++k) {
    bank.step();
    played.push_back(bank.extinction()->state_of(id)->size);
  }
  std::size_t same = 0;
  for (std::size_t event = 0; event < 8; ++event) {
    double most = 0;
    for (std::size_t k = 0; k < 45; ++k)
      most = std::max(most, std::abs(played[k] - size_at(events->catching, event, k)));
    same += most < 1e-5;
  }
  EXPECT_GE(same, 1U);
}

TEST(FlameSizes, WithoutADeathOrALightingThereIsNothingToPlay) {
  const Recording alight = made::blow_out_recording({.every = 0}).recording;
  const ExtinctionEvidence none = evidence_of(alight);
  EXPECT_TRUE(recorded_events({&none, 1})->dying.empty());
  Recording once =
      made::blow_out_recording({.rows = 700, .every = 8, .weakest = 3.5, .shortest = 0.4, .seed = 4}).recording;
  const std::size_t gone = find_blow_outs(once, "wind")->front().gone;
  for (Channel& channel : once.channels) {
    if (channel.role == Role::kInput) continue;
    std::fill(channel.samples.begin() + static_cast<std::ptrdiff_t>(gone), channel.samples.end(),
              std::numeric_limits<double>::quiet_NaN());
  }
  const ExtinctionEvidence seen = evidence_of(once);
  const auto found = recorded_events({&seen, 1});
  EXPECT_EQ(found->dying.ends.size(), 1U);
  EXPECT_TRUE(found->catching.empty());
}

TEST(FlameSizes, AStretchThatNobodyBlewIsNoDeath) {
  const Recording recording = made::blow_out_recording({.rows = 1500, .shortest = 0.2}).recording;
  ExtinctionEvidence seen = evidence_of(recording);
  const std::size_t all = recorded_events({&seen, 1})->dying.ends.size();
  seen.blow_outs[1].blown = false;
  EXPECT_EQ(recorded_events({&seen, 1})->dying.ends.size(), all - 1);
  EXPECT_THAT(flame_sizes({.source = "numbers"}, {}).error().message, HasSubstr("numbers"));
}

}  // namespace
}  // namespace wisp::flame_sizes_test
