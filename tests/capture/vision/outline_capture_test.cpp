#include "wisp/capture/vision/outline_capture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "capture/support/made_clip.hpp"
#include "capture/support/overlap.hpp"

namespace wisp::outline_capture_test {
namespace {

using support::add_noise;
using support::capture;
using support::Flame;
using support::missing;
using support::noisy_flame;
using support::options_for;
using support::Plane;
using testing::HasSubstr;

std::vector<double> controls_at(const CapturedOutline& captured, std::size_t row) {
  std::vector<double> out;
  for (int i = 0; i < 2 * captured.report.points; ++i) out.push_back(captured.recording.channels[i].samples[row]);
  return out;
}

double overlap_at(const CapturedOutline& captured, const Plane& plane, std::size_t row) {
  const SplineTable table(captured.report.knots);
  const support::Mask mask = support::region_mask(plane.view(), static_cast<int>(captured.report.threshold));
  return support::overlap(mask, support::curve_mask(table, controls_at(captured, row), plane.width, plane.height));
}

// Clips that share a model follow their underside all, or none: where its ends are is what the base means.
TEST(OutlineCapture, FollowsTheUndersideWhereItIsAskedTo) {
  for (const bool asked : {false, true}) {
    OutlineCaptureOptions options = options_for();
    options.underside = asked;
    const auto captured = capture(40, noisy_flame, options);
    ASSERT_TRUE(captured) << captured.error().message;
    EXPECT_EQ(captured->report.underside, asked);
    EXPECT_EQ(find_attribute(captured->recording, "underside"), asked ? "1" : "0");
    const std::vector<double> ends = controls_at(*captured, 20);
    const double base = std::hypot(ends[0] - ends[14], ends[1] - ends[15]);
    EXPECT_EQ(base < 1, asked) << base;
  }
}

TEST(OutlineCapture, MakesARecordingOfAllFrames) {
  const auto captured = capture(60, noisy_flame);
  ASSERT_TRUE(captured) << captured.error().message;
  const Recording& recording = captured->recording;
  EXPECT_EQ(recording.rows(), 60u);
  EXPECT_EQ(recording.channels.size(), 18u);
  EXPECT_EQ(recording.channels[0].name, "p0.x");
  EXPECT_EQ(recording.channels[15].name, "p7.y");
  EXPECT_EQ(recording.channels[16].name, "base.x");
  EXPECT_EQ(recording.channels[16].role, Role::kMotion);
  EXPECT_EQ(recording.flags[0].name, "filled");
  EXPECT_EQ(find_attribute(recording, "channel"), "luma");
  EXPECT_EQ(captured->report.tracked, 60u);
  EXPECT_TRUE(captured->report.dropped.empty());
  EXPECT_TRUE(check(recording));
}

TEST(OutlineCapture, CoversTheFlame) {
  for (const int points : {8, 16}) {
    const auto captured = capture(60, noisy_flame, options_for(points));
    ASSERT_TRUE(captured);
    double sum = 0;
    for (int k = 0; k < 60; ++k) sum += overlap_at(*captured, noisy_flame(k), k) / 60;
    EXPECT_GT(sum, points == 8 ? 0.95 : 0.97) << points;
  }
}

TEST(OutlineCapture, FollowsTheKnownBoundaryToHalfAPixel) {
  // 16 control points on this shape leave a root mean square of some 0.2 px; what the sides are off by is checked away
  // from tip and base, where "depth" is the distance.
  const auto captured = capture(60, noisy_flame, options_for(16));
  ASSERT_TRUE(captured);
  const SplineTable table(captured->report.knots);
  for (const int k : {5, 25, 45}) {
    const Flame flame = support::swaying(k);
    double squares = 0;
    int count = 0;
    for (const CurvePoint p : curve_polyline(table, controls_at(*captured, k), 200)) {
      if (p.y > flame.base_y - 12 || p.y < flame.base_y - 0.8 * flame.height) continue;
      squares += std::pow(flame.depth(p.x, p.y), 2);
      ++count;
    }
    EXPECT_LT(std::sqrt(squares / count), 0.5) << k;
  }
}

TEST(OutlineCapture, ASingleDuplicateIsFilledAndFlagged) {
  const auto captured = capture(60, [](int k) { return noisy_flame(k == 30 || k == 45 ? k - 1 : k); });
  ASSERT_TRUE(captured);
  EXPECT_EQ(captured->report.duplicates, 2u);
  EXPECT_EQ(captured->report.filled, 2u);
  EXPECT_EQ(captured->report.tracked, 58u);
  EXPECT_EQ(captured->recording.flags[0].rows[30], 1);
  EXPECT_FALSE(missing(*captured, 30));
  EXPECT_EQ(captured->recording.episode_ids.back(), 0);
  const double before = controls_at(*captured, 29)[6], after = controls_at(*captured, 31)[6];
  EXPECT_NEAR(controls_at(*captured, 30)[6], 0.5 * (before + after), 1e-9);
}

TEST(OutlineCapture, APictureShownThreeTimesIsFilledInAStraightLine) {
  const auto captured = capture(60, [](int k) { return noisy_flame(k == 30 || k == 31 ? 29 : k); });
  ASSERT_TRUE(captured);
  EXPECT_EQ(captured->report.filled, 2u);
  EXPECT_TRUE(captured->report.dropped.empty());
  const double before = controls_at(*captured, 29)[6], after = controls_at(*captured, 32)[6];
  EXPECT_NEAR(controls_at(*captured, 31)[6], before + 2 * (after - before) / 3, 1e-9);
}

TEST(OutlineCapture, FourDuplicatesInARowEndTheEpisode) {
  const auto captured = capture(60, [](int k) { return noisy_flame(k >= 30 && k < 34 ? 29 : k); });
  ASSERT_TRUE(captured);
  ASSERT_EQ(captured->report.dropped.size(), 4u);
  EXPECT_EQ(captured->report.dropped[0].frame, 30u);
  EXPECT_EQ(captured->report.dropped[0].reason, "duplicate");
  EXPECT_TRUE(missing(*captured, 31));
  EXPECT_EQ(captured->report.facts.absent, 0u);
  EXPECT_EQ(episodes(captured->recording).size(), 2u);
}

TEST(OutlineCapture, AFilmThatStandsStillEveryOtherSecondIsNotUsable) {
  const auto captured = capture(240, [](int k) { return noisy_flame(k / 30 % 2 == 0 ? k : k / 30 * 30 - 1); });
  ASSERT_TRUE(captured) << captured.error().message;
  EXPECT_EQ(captured->report.duplicates, 120u);
  EXPECT_FALSE(captured->report.usable);
  EXPECT_THAT(captured->report.reason, HasSubstr("the film stands still, 50 % of its frames repeat the one before"));
}

TEST(OutlineCapture, APictureThatStandsAtTheEndIsNoEvidenceAndNoFlameThatWentOut) {
  const auto captured = capture(150, [](int k) { return noisy_flame(std::min(k, 119)); });
  ASSERT_TRUE(captured) << captured.error().message;
  EXPECT_TRUE(captured->report.usable) << captured->report.reason;
  EXPECT_EQ(captured->report.tracked, 120u);
  EXPECT_TRUE(missing(*captured, 120) && missing(*captured, 149));
  EXPECT_TRUE(is_flagged(captured->recording, kLostRows, 130));
  EXPECT_EQ(captured->report.out_at, std::nullopt);
}

// Nothing is missing in slow motion, whether its repeats are exact or each has a little grain of its own.
TEST(OutlineCapture, SlowMotionIsNamedAndNothingIsMissing) {
  for (const int times : {2, 3, 6}) {
    for (const bool grain : {false, true}) {
      const auto captured = capture(times * 60, [&](int k) {
        Plane plane = noisy_flame(k / times);
        if (grain) add_noise(plane, static_cast<unsigned>(1000 + k));
        return plane;
      });
      ASSERT_TRUE(captured);
      const CaptureReport& report = captured->report;
      EXPECT_EQ(report.facts.stands, times) << grain;
      EXPECT_FALSE(report.usable);
      EXPECT_THAT(report.reason, HasSubstr("every frame stands " + std::to_string(times) + " times")) << grain;
      EXPECT_EQ(report.filled + report.tracked, report.facts.rows) << times << ' ' << grain;
    }
  }
}

TEST(OutlineCapture, LostFramesLeaveRowsOfTheirOwn) {
  OutlineCapture capturing(options_for());
  for (int k = 0; k < 60; ++k) {
    if (k == 20) {
      capturing.lost();
    } else if (k == 40) {
      capturing.lost(3);
      k += 2;
    } else {
      const Plane plane = noisy_flame(k);
      ASSERT_TRUE(capturing.feed(grey_picture(plane.view())));
    }
  }
  const auto captured = capturing.finish();
  ASSERT_TRUE(captured);
  EXPECT_EQ(captured->report.frames, 60u);
  EXPECT_EQ(captured->report.filled, 1u);
  EXPECT_EQ(captured->recording.flags[0].rows[20], 1);
  ASSERT_EQ(captured->report.dropped.size(), 3u);
  EXPECT_EQ(captured->report.dropped[0].reason, "lost");
  EXPECT_EQ(captured->recording.episode_ids.back(), 1);
}

TEST(OutlineCapture, FadesAreDroppedAtBothEnds) {
  const auto captured = capture(80, [](int k) {
    const int from_end = std::min(k, 79 - k);
    Plane plane = support::flame_picture(support::swaying(k), 160, 180, from_end < 8 ? 8 + 22 * from_end : 230);
    add_noise(plane, static_cast<unsigned>(k));
    return plane;
  });
  ASSERT_TRUE(captured);
  ASSERT_EQ(captured->report.dropped.size(), 16u);
  for (const DroppedFrame& dropped : captured->report.dropped) {
    EXPECT_TRUE(dropped.frame < 8 || dropped.frame > 71) << dropped.frame;
    EXPECT_EQ(dropped.reason, "fade");
  }
}

TEST(OutlineCapture, GoesOnAfterAFlamelessStretch) {
  const auto captured = capture(90, [](int k) {
    Plane plane = noisy_flame(k);
    if (k >= 50 && k < 60) plane = Plane(160, 180, 8);
    return plane;
  });
  ASSERT_TRUE(captured);
  EXPECT_EQ(captured->report.dropped.size(), 10u);
  EXPECT_EQ(captured->report.dropped[0].reason, "nothing there");
  EXPECT_EQ(captured->report.tracked, 80u);
  EXPECT_EQ(episodes(captured->recording).size(), 2u);
}

TEST(OutlineCapture, ABrighterThingThatStandsStillIsNotTheFlame) {
  const auto captured = capture(60, [](int k) {
    Flame flame = support::swaying(k);
    flame.base_x = 50;
    Plane plane = support::flame_picture(flame, 220, 180);
    plane.fill({120, 90, 90, 80}, 240);
    add_noise(plane, static_cast<unsigned>(k));
    return plane;
  });
  ASSERT_TRUE(captured);
  for (std::size_t k = 0; k < 60; ++k) EXPECT_LT(controls_at(*captured, k)[14], 100) << k;
}

TEST(OutlineCapture, AStandThatRunsTogetherWithTheFlameIsCutOff) {
  const auto captured = capture(60, [](int k) {
    Flame flame = support::swaying(k);
    flame.base_y = 130;
    Plane plane(160, 180, 8);
    support::paint(plane, 230, 3.0, [&](double x, double y) { return flame.depth(x, y); });
    plane.fill({40, 142, 80, 30}, 220);
    if (k % 5 == 4) plane.fill({77, 128, 7, 16}, 220);  // a bridge of light in every fifth frame
    add_noise(plane, static_cast<unsigned>(k));
    return plane;
  });
  ASSERT_TRUE(captured);
  EXPECT_EQ(captured->report.tracked, 60u);
  for (std::size_t k = 0; k < 60; ++k) {
    EXPECT_LT(captured->recording.channels[17].samples[k], 146) << k;
    EXPECT_GT(controls_at(*captured, k)[0], 45) << k;
  }
}

TEST(OutlineCapture, DarkThingsAreTrackedAlike) {
  OutlineCaptureOptions options = options_for();
  options.dark = true;
  const auto captured = capture(
      60,
      [](int k) {
        Plane plane = noisy_flame(k);
        for (auto& pixel : plane.pixels) pixel = static_cast<std::uint8_t>(255 - pixel);
        return plane;
      },
      options);
  ASSERT_TRUE(captured);
  EXPECT_EQ(captured->report.tracked, 60u);
  options.dark = false;
  options.flame = 0;
  const auto bright = capture(60, noisy_flame, options);
  EXPECT_NEAR(captured->report.threshold, 255 - bright->report.threshold, 1);
  EXPECT_NEAR(controls_at(*captured, 30)[6], controls_at(*bright, 30)[6], 0.2);
}

TEST(OutlineCapture, AFlameInAnotherPlaceIsAnotherFlame) {
  const auto captured = capture(60, [](int k) {
    Flame flame = support::swaying(k);
    flame.base_x = k < 30 ? 60 : 240;
    Plane plane = support::flame_picture(flame, 320, 180);
    add_noise(plane, static_cast<unsigned>(k));
    return plane;
  });
  ASSERT_TRUE(captured) << captured.error().message;
  EXPECT_EQ(captured->report.tracked, 30u);
  EXPECT_EQ(captured->report.out_at, 30u);
  EXPECT_FALSE(captured->report.usable);
  EXPECT_THAT(captured->report.reason, HasSubstr("the camera moves too far; give frames 1 to 30 alone"));
}

// Two flames, the right one smaller, and what a frame shows of them.
Plane two_flames(int k) {
  Plane plane(320, 180, 8);
  Flame large = support::swaying(k), small = support::swaying(k + 7);
  large.base_x = 80;
  small.base_x = 230;
  small.height *= 0.7;
  small.half_width *= 0.7;
  support::paint(plane, 230, 3.0, [&](double x, double y) { return std::max(large.depth(x, y), small.depth(x, y)); });
  add_noise(plane, static_cast<unsigned>(k) + 1);
  return plane;
}

TEST(OutlineCapture, OfTwoFlamesTheOneAskedForIsFollowedToTheEnd) {
  for (const int which : {1, 2}) {
    OutlineCaptureOptions options = options_for();
    options.flame = which;
    const auto captured = capture(60, two_flames, options);
    ASSERT_TRUE(captured) << captured.error().message;
    EXPECT_EQ(captured->report.flames, 2);
    EXPECT_EQ(captured->report.tracked, 60u);
    for (std::size_t k = 0; k < 60; ++k) {
      EXPECT_NEAR(captured->recording.channels[16].samples[k], which == 1 ? 80 : 230, 3) << k;
    }
  }
}

TEST(OutlineCapture, TheOtherFlameIsNotTakenWhenTheOneFollowedGoesOut) {
  const auto captured = capture(90, [](int k) {
    Plane plane = two_flames(k);
    if (k >= 60) plane.fill({0, 0, 155, 180}, 8);
    return plane;
  });
  ASSERT_TRUE(captured);
  EXPECT_EQ(captured->report.tracked, 60u);
  EXPECT_EQ(captured->report.out_at, 60u);
}

TEST(OutlineCapture, AGlintAfterTheFlameWentOutIsLeftOut) {
  const auto captured = capture(90, [](int k) {
    Plane plane = noisy_flame(k);
    if (k >= 50 && (k < 70 || k > 73)) plane = Plane(160, 180, 8);
    return plane;
  });
  ASSERT_TRUE(captured);
  EXPECT_EQ(captured->report.tracked, 50u);
  EXPECT_EQ(captured->report.out_at, 50u);
  EXPECT_THAT(captured->report.reason, HasSubstr("out from frame 51"));
}

// The smaller one goes out: in the clip's last frames there is one.
Plane two_flames_then_one(int k) {
  Plane plane = two_flames(k);
  if (k >= 60) plane.fill({155, 0, plane.width - 155, plane.height}, 8);
  return plane;
}

TEST(OutlineCapture, AFlameBeyondThoseThereAreIsRefusedWithTheNumberThatTheSummaryGives) {
  OutlineCaptureOptions options = options_for();
  const auto first = capture(110, two_flames_then_one, options);
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_EQ(first->report.flames, 2);
  EXPECT_THAT(first->report.reason, HasSubstr("there are 2 flames"));
  for (const int which : {3, 5}) {
    options.flame = which;
    const auto beyond = capture(110, two_flames_then_one, options);
    ASSERT_FALSE(beyond);
    EXPECT_THAT(beyond.error().message,
                HasSubstr("found 2 flames in frames 1 to 40, expected at least " + std::to_string(which)));
  }
}

TEST(OutlineCapture, AFlameBeyondOneThatIsLitLaterIsRefusedWhereThatBurns) {
  OutlineCaptureOptions options = options_for();
  options.flame = 2;
  const auto captured = capture(
      120, [](int k) { return k < 45 ? Plane(160, 180, 8) : noisy_flame(k); }, options);
  ASSERT_FALSE(captured);
  EXPECT_THAT(captured.error().message, HasSubstr("found 1 flame in frames 41 to 80, expected at least 2"));
}

TEST(OutlineCapture, AFlameIsUsableAndALampIsNot) {
  const auto flame = capture(60, noisy_flame);
  ASSERT_TRUE(flame);
  EXPECT_TRUE(flame->report.usable) << flame->report.reason;
  const auto lamp = capture(60, [](int k) {
    Plane plane = support::flame_picture(support::swaying(0));
    add_noise(plane, static_cast<unsigned>(k) + 1);
    return plane;
  });
  ASSERT_TRUE(lamp);
  EXPECT_FALSE(lamp->report.usable);
  EXPECT_THAT(lamp->report.reason, HasSubstr("do not move"));
}

TEST(OutlineCapture, WhatIsHardlyBrighterThanItsWallIsNotUsable) {
  const auto captured = capture(60, [](int k) {
    Plane plane = support::flame_picture(support::swaying(k));
    for (auto& pixel : plane.pixels) pixel = static_cast<std::uint8_t>(185 + pixel / 14);
    add_noise(plane, static_cast<unsigned>(k) + 1);
    return plane;
  });
  ASSERT_TRUE(captured) << captured.error().message;
  EXPECT_FALSE(captured->report.usable);
  EXPECT_THAT(captured->report.reason, HasSubstr("hardly brighter"));
}

TEST(OutlineCapture, AClipThatLostManyFramesIsIrregular) {
  OutlineCapture capturing(options_for());
  for (int k = 0; k < 90; ++k) {
    const Plane plane = noisy_flame(k);
    if (k % 5 == 4) {
      capturing.lost();
    } else {
      ASSERT_TRUE(capturing.feed(grey_picture(plane.view())));
    }
  }
  const auto captured = capturing.finish();
  ASSERT_TRUE(captured);
  EXPECT_EQ(captured->report.filled, 17u);
  EXPECT_FALSE(captured->report.usable);
  EXPECT_THAT(captured->report.reason, HasSubstr("irregularly, 20 %"));
}

TEST(OutlineCapture, AWhiteBlobIsClippedFlat) {
  const auto captured = capture(60, [](int k) {
    Plane plane(160, 180, 8);
    const double wide = 30 + 6 * std::sin(0.5 * k);
    support::paint(plane, 255, 3.0, [&](double x, double y) {
      return std::min({wide + 0.2 * (110 - y) - std::abs(x - 80), 150 - y, y - 60 - 8 * std::sin(0.7 * k)});
    });
    return plane;
  });
  ASSERT_TRUE(captured);
  EXPECT_FALSE(captured->report.usable);
  EXPECT_THAT(captured->report.reason, HasSubstr("clipped flat"));
}

TEST(OutlineCapture, AnOutlineAtTheBorderIsNotUsableAndNamesTheSide) {
  const auto captured = capture(60, [](int k) {
    Flame flame = support::swaying(k);
    flame.base_x = 8;
    Plane plane = support::flame_picture(flame);
    add_noise(plane, static_cast<unsigned>(k) + 1);
    return plane;
  });
  ASSERT_TRUE(captured);
  EXPECT_FALSE(captured->report.usable);
  EXPECT_THAT(captured->report.reason, HasSubstr("left border"));
}

TEST(OutlineCapture, ARegionHidesWhatLiesOutside) {
  OutlineCaptureOptions options = options_for();
  options.region = {0, 0, 110, 180};
  const auto captured = capture(
      60,
      [](int k) {
        Plane plane = support::flame_picture(support::swaying(k), 300, 180);
        Flame other = support::swaying(3 * k);
        other.base_x = 230;
        other.half_width = 40;
        support::paint(plane, 255, 3.0, [&](double x, double y) { return other.depth(x, y); });
        add_noise(plane, static_cast<unsigned>(k));
        return plane;
      },
      options);
  ASSERT_TRUE(captured);
  EXPECT_NEAR(captured->recording.channels[16].samples[10], 80, 1);
}

TEST(OutlineCapture, ARegionOutsideThePictureIsAnError) {
  OutlineCaptureOptions options = options_for();
  options.region = {100, 100, 100, 100};
  const auto captured = capture(20, noisy_flame, options);
  ASSERT_FALSE(captured);
  EXPECT_THAT(captured.error().message, HasSubstr("100,100,100,100"));
  EXPECT_THAT(captured.error().message, HasSubstr("160 x 180"));
}

TEST(OutlineCapture, ThreeFramesAreTooFew) {
  const auto captured = capture(3, noisy_flame);
  ASSERT_FALSE(captured);
  EXPECT_THAT(captured.error().message, HasSubstr("found 3 frames"));
}

TEST(OutlineCapture, ABlackClipIsAnError) {
  const auto captured = capture(50, [](int) { return Plane(160, 120, 16); });
  ASSERT_FALSE(captured);
  EXPECT_THAT(captured.error().message, HasSubstr("the film is too dark"));
}

TEST(OutlineCapture, AFrameOfAnotherSizeIsAnError) {
  const auto captured = capture(30, [](int k) { return k == 20 ? Plane(100, 100) : noisy_flame(k); });
  ASSERT_FALSE(captured);
  EXPECT_THAT(captured.error().message, HasSubstr("frame 20 is 100 x 100"));
}

TEST(OutlineCapture, AColourChannelOfGreyPicturesIsAnError) {
  OutlineCaptureOptions options = options_for();
  options.channel = PixelChannel::kRed;
  const auto captured = capture(20, noisy_flame, options);
  ASSERT_FALSE(captured);
  EXPECT_THAT(captured.error().message, HasSubstr("red"));
}

TEST(OutlineCapture, TheSameFramesGiveTheSameRecording) {
  const auto once = capture(60, noisy_flame), again = capture(60, noisy_flame);
  for (std::size_t k = 0; k < once->recording.channels.size(); ++k) {
    EXPECT_EQ(once->recording.channels[k].samples, again->recording.channels[k].samples);
  }
}

}  // namespace
}  // namespace wisp::outline_capture_test
