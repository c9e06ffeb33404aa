// From where on something is a flame, and where it ends: lit late, gone out, faded, or cut to another scene.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "capture/support/made_clip.hpp"

namespace wisp::outline_in_time_test {
namespace {

using support::add_noise;
using support::capture;
using support::Flame;
using support::missing;
using support::noisy_flame;
using support::options_for;
using support::Plane;
using testing::HasSubstr;

TEST(OutlineCapture, AFlameThatGoesOutBesideALampIsUsableAndOut) {
  const auto captured = capture(90, [](int k) {
    Plane plane(320, 180, 8);
    const Flame flame = support::swaying(k);
    if (k < 60) support::paint(plane, 230, 3.0, [&](double x, double y) { return flame.depth(x, y); });
    plane.fill({220, 60, 36, 80}, 230);
    add_noise(plane, static_cast<unsigned>(k));
    return plane;
  });
  ASSERT_TRUE(captured);
  EXPECT_EQ(captured->report.tracked, 60u);
  EXPECT_EQ(captured->report.out_at, 60u);
  EXPECT_TRUE(captured->report.usable) << captured->report.reason;
}

TEST(OutlineCapture, AThirdOfASecondInTheDarkIsTheEndOfAFlame) {
  OutlineCaptureOptions options = options_for();
  options.rate_hz = 60;
  const auto dark_from = [](int first) {
    return [=](int k) { return k < first ? noisy_flame(k) : Plane(160, 180, 8); };
  };
  EXPECT_EQ(capture(80, dark_from(60), options)->report.out_at, 60u);
  EXPECT_EQ(capture(70, dark_from(60), options)->report.out_at, std::nullopt);
}

TEST(OutlineCapture, AFlameThatFlaresAgainForHalfASecondIsOutAfterThat) {
  for (const int rate : {12, 30, 60}) {
    OutlineCaptureOptions options = options_for();
    options.rate_hz = rate;
    const auto captured = capture(
        60 + 3 * rate,
        [=](int k) {
          const bool burns = k < 60 || (k >= 60 + rate && k < 60 + rate + rate / 2);
          return burns ? noisy_flame(k) : Plane(160, 180, 8);
        },
        options);
    ASSERT_TRUE(captured);
    EXPECT_EQ(captured->report.out_at, static_cast<std::size_t>(60 + rate + rate / 2)) << rate;
  }
}

TEST(OutlineCapture, OfTwoFlamesEachHasItsOwnEnd) {
  const auto picture = [](int k) {
    Plane plane(320, 180, 8);
    Flame large = support::swaying(k), small = support::swaying(k + 7);
    small.base_x = 240;
    small.height *= 0.8;
    if (k < 60) support::paint(plane, 230, 3.0, [&](double x, double y) { return large.depth(x, y); });
    if (k < 90) support::paint(plane, 230, 3.0, [&](double x, double y) { return small.depth(x, y); });
    add_noise(plane, static_cast<unsigned>(k));
    return plane;
  };
  for (const int which : {1, 2}) {
    OutlineCaptureOptions options = options_for();
    options.flame = which;
    const auto captured = capture(130, picture, options);
    ASSERT_TRUE(captured) << captured.error().message;
    EXPECT_EQ(captured->report.out_at, which == 1 ? 60u : 90u);
    EXPECT_TRUE(captured->report.usable) << captured->report.reason;
  }
}

TEST(OutlineCapture, WhatBurnsOnElsewhereIsNotOut) {
  const auto captured = capture(120, [](int k) {
    Plane plane(320, 180, 90);  // by day: most of the light is not the fire's
    Flame flame = support::swaying(k);
    if (k >= 54) flame.base_x = 200 + 0.5 * k;  // paper that it has lit
    if (k < 50 || k >= 54) support::paint(plane, 230, 3.0, [&](double x, double y) { return flame.depth(x, y); });
    add_noise(plane, static_cast<unsigned>(k));
    return plane;
  });
  ASSERT_TRUE(captured);
  EXPECT_THAT(captured->report.reason, testing::Not(HasSubstr("is out from")));
  EXPECT_THAT(captured->report.reason, HasSubstr("give frames 1 to 50 alone"));
}

TEST(OutlineCapture, AFilmThatFadesToBlackIsNotAFlameThatGoesOut) {
  const auto captured = capture(120, [](int k) {
    Plane plane = support::flame_picture(support::swaying(k));
    const double share = std::clamp((110 - k) / 30.0, 0.0, 1.0);  // over a second
    for (auto& pixel : plane.pixels) pixel = static_cast<std::uint8_t>(std::lround(share * pixel));
    add_noise(plane, static_cast<unsigned>(k));
    return plane;
  });
  ASSERT_TRUE(captured);
  EXPECT_TRUE(captured->report.usable) << captured->report.reason;
  EXPECT_LT(captured->report.tracked, 100u);
  EXPECT_EQ(captured->report.out_at, std::nullopt);
}

TEST(OutlineCapture, AFilmThatIsCutToAFlameIsNotUsableAndNamesItsFrames) {
  const auto captured = capture(90, [](int k) {
    Flame flame = support::swaying(k);
    flame.base_x = k < 12 ? 60 : 240;
    Plane plane = support::flame_picture(flame, 320, 180);
    add_noise(plane, static_cast<unsigned>(k));
    return plane;
  });
  ASSERT_TRUE(captured);
  EXPECT_EQ(captured->report.tracked, 78u);
  EXPECT_FALSE(captured->report.usable);
  EXPECT_THAT(captured->report.reason, HasSubstr("give frames 13 to 90 alone"));
}

TEST(OutlineCapture, AReasonNamesFramesByTheirNumbersInTheFilm) {
  OutlineCaptureOptions options = options_for();
  options.first_frame = 101;
  const auto lit = [](bool burns, int k) { return burns ? noisy_flame(k) : Plane(160, 180, 8); };
  const auto out = capture(
      90, [&](int k) { return lit(k < 50, k); }, options);
  EXPECT_THAT(out->report.reason, HasSubstr("out from frame 151 on"));
  const auto late = capture(
      160, [&](int k) { return lit(k >= 50, k); }, options);
  EXPECT_THAT(late->report.reason, HasSubstr("it is seen from frame 151 on"));
  options.flame = 2;
  const auto few = capture(
      120, [&](int k) { return lit(k >= 45, k); }, options);
  EXPECT_THAT(few.error().message, HasSubstr("in frames 141 to 180"));
}

TEST(OutlineCapture, ALampThatMovesAtLastIsNoFlame) {
  const auto captured = capture(120, [](int k) {
    Plane plane = support::flame_picture(support::swaying(std::max(k, 80)));
    add_noise(plane, static_cast<unsigned>(k));
    return plane;
  });
  ASSERT_TRUE(captured);
  EXPECT_FALSE(captured->report.usable);
  EXPECT_THAT(captured->report.reason, HasSubstr("its edges do not move in"));
}

TEST(OutlineCapture, AFlameThatIsLitLateIsUsableAndSaysFromWhereOn) {
  const auto captured = capture(160, [](int k) {
    Plane plane = k < 50 ? Plane(160, 180, 8) : support::flame_picture(support::swaying(k));
    add_noise(plane, static_cast<unsigned>(k));
    return plane;
  });
  ASSERT_TRUE(captured);
  EXPECT_TRUE(captured->report.usable) << captured->report.reason;
  EXPECT_THAT(captured->report.reason, HasSubstr("it is seen from frame 51 on"));
}

TEST(OutlineCapture, AFlameThatIsLitLaterIsWaitedFor) {
  const auto captured = capture(140, [](int k) {
    Plane plane = k < 70 ? Plane(160, 180, 8) : support::flame_picture(support::swaying(k));
    plane.fill({10, 20, 30, 40}, 120);  // a lit wall, as bright before as after
    add_noise(plane, static_cast<unsigned>(k) + 1);
    return plane;
  });
  ASSERT_TRUE(captured) << captured.error().message;
  EXPECT_TRUE(captured->report.usable) << captured->report.reason;
  EXPECT_TRUE(missing(*captured, 69));
  EXPECT_FALSE(missing(*captured, 90));
  EXPECT_NEAR(captured->recording.channels[16].samples[100], 80, 1);
}

// An editor's black of two seconds: the first frames after it show a small round flame, the glimpses a
// slender one that leans.
TEST(OutlineCapture, GlimpsesOfAFlameThatIsLitLaterStillShapeItsCurve) {
  const auto picture = [](int k) {
    Flame flame = support::swaying(k);
    const double sway = std::sin(0.35 * k);
    const bool lively = k >= 110;
    flame.base_x = 110, flame.lean = (lively ? 50 : 1) * sway;
    flame.half_width = lively ? 9 : 34, flame.height = lively ? 140 + 3 * sway : 60;
    Plane plane = k < 60 ? Plane(220, 180, 8) : support::flame_picture(flame, 220);
    add_noise(plane, static_cast<unsigned>(k) + 1);
    return plane;
  };
  const auto residual = [&](const std::vector<int>& glimpses) {
    OutlineCapture capturing(options_for());
    for (const int k : glimpses) capturing.glimpse(grey_picture(picture(k).view()));
    for (int k = 0; k < 240; ++k) EXPECT_TRUE(capturing.feed(grey_picture(picture(k).view())));
    return capturing.finish()->report.residual;
  };
  const double calm = residual({}), lively = residual({125, 140, 160, 183});
  EXPECT_LT(lively, 0.8 * calm) << calm;
}

// A flame that burns from the 71st frame on, beside what is painted before it.
void expect_that_the_flame_is_found(const std::function<Plane(int)>& before,
                                    const std::function<Flame(int)>& flame_at) {
  const auto captured = capture(140, [&](int k) {
    Plane plane = before(k);
    const Flame flame = flame_at(k);
    if (k >= 70) support::paint(plane, 230, 3.0, [&](double x, double y) { return flame.depth(x, y); });
    add_noise(plane, static_cast<unsigned>(k) + 1);
    return plane;
  });
  ASSERT_TRUE(captured) << captured.error().message;
  EXPECT_TRUE(captured->report.usable) << captured->report.reason;
  EXPECT_THAT(captured->report.reason, HasSubstr("it is seen from frame 71 on"));
}

TEST(OutlineCapture, WhatHardlyStandsOutIsNotTakenForAFlameThatIsLitLater) {
  const auto curtain = [](int k) {
    Plane plane(160, 180, 60);
    Flame fold = support::swaying(k + 9);
    fold.base_x -= 50;
    support::paint(plane, 74, 3.0, [&](double x, double y) { return fold.depth(x, y); });
    return plane;
  };
  expect_that_the_flame_is_found(curtain, [](int k) { return support::swaying(k); });
}

TEST(OutlineCapture, ARoundLampFilmedFromAHandIsNotTakenForAFlameThatIsLitLater) {
  const auto aside = [](int k) { return 3 * std::sin(0.5 * k); };
  const auto down = [](int k) { return 3 * std::sin(0.31 * k + 1); };
  const auto lamp = [&](int k) {
    Plane plane(160, 180, 8);
    support::paint(plane, 230, 2.0,
                   [&](double x, double y) { return 12 - std::hypot(x - 135 - aside(k), y - 40 - down(k)); });
    return plane;
  };
  expect_that_the_flame_is_found(lamp, [&](int k) {
    Flame flame = support::swaying(k);
    flame.base_x += aside(k) - 20;
    flame.base_y += down(k);
    return flame;
  });
}

}  // namespace
}  // namespace wisp::outline_in_time_test
