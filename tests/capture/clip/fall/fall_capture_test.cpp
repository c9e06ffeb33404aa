#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "capture/support/synthetic.hpp"
#include "record/verdict.hpp"
#include "wisp/capture/clip/clip_capture.hpp"

namespace wisp::fall_capture_test {
namespace {

using support::Plane;
using testing::HasSubstr;

constexpr int kWidth = 240, kHeight = 320;
constexpr double kRate = 30, kMetres = 1.6, kScale = kMetres / kHeight;

// A strip of paper, seen from its narrow side. Pixels, y down; the angle anticlockwise.
struct Strip {
  double x = 0, y = 0, angle = 0;
  double length = 30, width = 6;

  double depth(double px, double py) const {
    const double dx = px - x, dy = py - y;
    const double along = dx * std::cos(angle) - dy * std::sin(angle);
    const double across = dx * std::sin(angle) + dy * std::cos(angle);
    return std::min(length / 2 - std::abs(along), width / 2 - std::abs(across));
  }
};

// Where the k-th strip is, a time after its release: it sinks, swings, and tilts as it swings.
Strip fluttering(int k, double seconds) {
  const double turn = 2 * std::numbers::pi * (1.1 + 0.05 * k) * seconds;
  const double sunk = 150 * (seconds - 0.2 * (1 - std::exp(-seconds / 0.2)));
  return {.x = 120 + 30 * std::sin(turn), .y = 70 + sunk, .angle = 0.7 * std::cos(turn)};
}

void paint_strip(Plane& plane, const Strip& strip, double bright) {
  support::paint(plane, bright, 1.0, [&](double x, double y) { return strip.depth(x, y); });
}

void add_noise(Plane& plane, unsigned seed, double deviation) {
  std::mt19937 random(seed);
  for (auto& pixel : plane.pixels) {
    // Twelve bytes make nearly a normal number, the same with every library.
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const auto word = static_cast<std::uint32_t>(random());
      for (int shift = 0; shift < 32; shift += 8) sum += (word >> shift & 0xff) / 255.0 - 0.5;
    }
    pixel = static_cast<std::uint8_t>(std::clamp(std::lround(pixel + deviation * sum), 0L, 255L));
  }
}

struct Film {
  double wall = 200;
  double thing = 80;
  double noise = 2;
  int falls = 6;
  double rate_hz = kRate;
  int frames_a_fall = 66;  // and the last of them empty

  int frames() const { return falls * frames_a_fall; }
  // Of the strip of a frame; none where it has left the picture.
  std::optional<Strip> strip(int frame) const {
    const Strip at = fluttering(frame / frames_a_fall, frame % frames_a_fall / rate_hz);
    return at.y < kHeight + 40 ? std::optional(at) : std::nullopt;
  }
  Plane picture(int frame) const {
    Plane plane(kWidth, kHeight, static_cast<std::uint8_t>(wall));
    if (const auto at = strip(frame)) paint_strip(plane, *at, thing);
    add_noise(plane, static_cast<unsigned>(frame) + 1, noise);
    return plane;
  }
};

Result<Captured> captured(int frames, double rate_hz, const std::function<Plane(int)>& picture,
                          FallOptions options = {.height_metres = kMetres}) {
  auto capture = FallCapture::create({"paper.mp4", rate_hz}, options);
  if (!capture) return capture.error();
  for (int k = 0; k < frames; ++k) {
    if (auto fed = capture->feed(grey_picture(picture(k).view())); !fed) return fed.error();
  }
  return capture->finish();
}

Result<Captured> captured(const Film& film, FallOptions options = {.height_metres = kMetres}) {
  return captured(
      film.frames(), film.rate_hz, [&](int frame) { return film.picture(frame); }, options);
}

double sample(const Recording& recording, const char* name, std::size_t row) {
  return recording.channels.at(*find_channel(recording, name)).samples.at(row);
}

std::size_t first_frame(const Captured& clip, std::size_t fall) {
  const auto& table = clip.report.sections.at(1).tables.at(0);
  return static_cast<std::size_t>(std::get<std::int64_t>(table.rows.at(fall).at(0))) - 1;
}

std::size_t falls_of(const Captured& clip) { return episodes(clip.recording).size(); }

struct Errors {
  double position = 0;  // greatest, metres
  double tilt = 0;      // greatest, degrees
};

Errors errors_of(const Captured& clip, const Film& film) {
  Errors errors;
  const Recording& recording = clip.recording;
  const auto all = episodes(recording);
  for (std::size_t e = 0; e < all.size(); ++e) {
    for (std::size_t row = all[e].begin; row < all[e].end; ++row) {
      const auto truth = film.strip(static_cast<int>(first_frame(clip, e) + row - all[e].begin));
      if (!truth) return {1e9, 1e9};
      const double x = kScale * (truth->x + 0.5 - kWidth / 2.0), z = kScale * (kHeight - truth->y - 0.5);
      errors.position = std::max(errors.position,
                                 std::hypot(sample(recording, "pos.x", row) - x, sample(recording, "pos.z", row) - z));
      if (!find_channel(recording, "q.w")) continue;
      const double qw = sample(recording, "q.w", row), qx = sample(recording, "q.x", row),
                   qy = sample(recording, "q.y", row), qz = sample(recording, "q.z", row);
      // The body's second axis, in the world.
      const double along_x = 2 * (qx * qy - qw * qz), along_z = 2 * (qy * qz + qw * qx);
      const double off = std::remainder(std::atan2(along_z, along_x) - truth->angle, std::numbers::pi);
      errors.tilt = std::max(errors.tilt, std::abs(off) * 180 / std::numbers::pi);
    }
  }
  return errors;
}

TEST(FallCapture, PositionsAndTiltOfAStripAreThoseItWasDrawnWith) {
  const Film film;
  const auto clip = captured(film);
  ASSERT_TRUE(clip) << clip.error().message;
  ASSERT_EQ(falls_of(*clip), 6u);
  const Errors errors = errors_of(*clip, film);
  EXPECT_LT(errors.position, 0.005 * kMetres);
  EXPECT_LT(errors.tilt, 3);
  EXPECT_TRUE(clip->report.verdict->usable) << clip->report.verdict->reason;
  EXPECT_EQ(sample(clip->recording, "pos.y", 0), 0);
  EXPECT_EQ(clip->recording.channels[0].unit, "m");
}

// FallsOnFilm are long: with sanitizers script/verify runs them, not script/test.
TEST(FallsOnFilm, ALightThingBeforeADarkWallIsTrackedAsWell) {
  const Film film{.wall = 40, .thing = 180, .noise = 4};
  const auto clip = captured(film);
  ASSERT_TRUE(clip) << clip.error().message;
  ASSERT_EQ(falls_of(*clip), 6u);
  EXPECT_LT(errors_of(*clip, film).position, 0.005 * kMetres);
}

TEST(FallsOnFilm, FilmsOf25And240FramesASecondAreTracked) {
  for (const double rate : {25.0, 240.0}) {
    const Film film{.falls = 2, .rate_hz = rate, .frames_a_fall = static_cast<int>(2.2 * rate)};
    const auto clip = captured(film);
    ASSERT_TRUE(clip) << clip.error().message;
    EXPECT_EQ(falls_of(*clip), 2u) << rate;
    EXPECT_LT(errors_of(*clip, film).position, 0.005 * kMetres) << rate;
  }
}

TEST(FallsOnFilm, AFallBeginsWhereTheHandLetsGo) {
  const Film film{.falls = 6, .frames_a_fall = 96};
  constexpr int kHeld = 30;  // frames
  const auto strip = [&](int frame) {
    return fluttering(frame / film.frames_a_fall, std::max(0, frame % film.frames_a_fall - kHeld) / kRate);
  };
  const auto clip = captured(film.frames(), kRate, [&](int frame) {
    Plane plane(kWidth, kHeight, 200);
    paint_strip(plane, strip(frame), 80);
    // The arm reaches in from above and holds it; then it is drawn back.
    const int rows = 70 - 6 * std::max(0, frame % film.frames_a_fall - kHeld);
    if (rows > 0) plane.fill({105, 0, 30, rows}, 120);
    add_noise(plane, static_cast<unsigned>(frame) + 1, 2);
    return plane;
  });
  ASSERT_TRUE(clip) << clip.error().message;
  ASSERT_EQ(falls_of(*clip), 6u);
  for (std::size_t fall = 0; fall < 6; ++fall) {
    const int after = static_cast<int>(first_frame(*clip, fall)) % film.frames_a_fall - kHeld;
    EXPECT_GE(after, 0);
    EXPECT_LE(after, 5);
  }
}

TEST(FallsOnFilm, WhatLeavesThePictureIsTrackedUntilItTouchesTheEdge) {
  const Film film;
  const auto clip = captured(film);
  ASSERT_TRUE(clip) << clip.error().message;
  const Episode fall = episodes(clip->recording).front();
  const double last = sample(clip->recording, "pos.z", fall.end - 1);
  EXPECT_GT(last, 0);
  EXPECT_LT(last, 0.08 * kMetres);
}

TEST(FallsOnFilm, TwoThingsThatFallAtOnceAreTwoEpisodes) {
  const Film film{.falls = 3};
  const auto other = [&](int frame) {
    Strip strip = fluttering(3 - frame / film.frames_a_fall, frame % film.frames_a_fall / kRate);
    strip.x = 240 - strip.x + 60;
    strip.y += 20;
    return strip;
  };
  const auto clip = captured(film.frames(), kRate, [&](int frame) {
    Plane plane(kWidth + 80, kHeight, 200);
    if (const auto at = film.strip(frame)) paint_strip(plane, {.x = at->x - 40, .y = at->y, .angle = at->angle}, 80);
    if (other(frame).y < kHeight + 40) paint_strip(plane, other(frame), 90);
    add_noise(plane, static_cast<unsigned>(frame) + 1, 2);
    return plane;
  });
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_EQ(falls_of(*clip), 6u);
}

TEST(FallsOnFilm, AShadowThatFallsAlongIsNoFallOfItsOwn) {
  const Film film{.falls = 2};
  const auto clip = captured(film.frames(), kRate, [&](int frame) {
    Plane plane(kWidth, kHeight, 200);
    if (const auto at = film.strip(frame)) {
      paint_strip(plane, {.x = at->x + 25, .y = at->y - 25, .angle = at->angle}, 165);
      paint_strip(plane, *at, 80);
    }
    add_noise(plane, static_cast<unsigned>(frame) + 1, 2);
    return plane;
  });
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_EQ(falls_of(*clip), 2u);
  EXPECT_LT(errors_of(*clip, film).position, 0.005 * kMetres);
}

TEST(FallsOnFilm, WhatIsRoundHasAPositionButNoTilt) {
  const Film film{.falls = 5};
  const auto clip = captured(film.frames(), kRate, [&](int frame) {
    Plane plane(kWidth, kHeight, 200);
    if (auto at = film.strip(frame)) {
      at->length = at->width = 16;
      paint_strip(plane, *at, 80);
    }
    return plane;
  });
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_FALSE(find_channel(clip->recording, "q.w"));
  EXPECT_THAT(std::get<std::string>(clip->report.find("tilt_reason")->value), HasSubstr("too round"));
}

TEST(FallsOnFilm, AFrameThatIsMissingOrShownTwiceIsFilledBetweenItsNeighbours) {
  const Film film;
  auto capture = FallCapture::create({"paper.mp4", kRate}, {.height_metres = kMetres});
  ASSERT_TRUE(capture);
  for (int frame = 0; frame < film.frames(); ++frame) {
    if (frame % 13 == 5) {
      capture->lost();
    } else {
      const int shown = frame % 13 == 9 ? frame - 1 : frame;
      ASSERT_TRUE(capture->feed(grey_picture(film.picture(shown).view())));
    }
  }
  const auto clip = capture->finish();
  ASSERT_TRUE(clip) << clip.error().message;
  ASSERT_EQ(falls_of(*clip), 6u);
  EXPECT_LT(errors_of(*clip, film).position, 0.005 * kMetres);
  EXPECT_GT(std::get<std::int64_t>(clip->report.find("filled")->value), 20);
}

TEST(FallsOnFilm, ARegionLeavesOutWhatMovesBesideIt) {
  const Film film;
  const auto clip = captured(film.frames(), kRate,
                             [&](int frame) {
                               Plane plane = film.picture(frame);
                               plane.fill({0, (frame * 7) % 250, 30, 30}, 20);
                               return plane;
                             },
                             {.height_metres = kMetres, .region = {40, 0, 200, kHeight}});
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_EQ(falls_of(*clip), 6u);
  EXPECT_LT(errors_of(*clip, film).position, 0.005 * kMetres);
}

TEST(FallsOnFilm, FallsOfARangeAreListedWithTheFilmsFrames) {
  const Film film{.falls = 3};
  const auto whole = captured(film), part = captured(film, {.height_metres = kMetres, .frames = FrameRange{101, 298}});
  ASSERT_TRUE(whole && part);
  EXPECT_EQ(first_frame(*part, 0), first_frame(*whole, 0) + 100);
}

TEST(FallsOnFilm, WithoutAHeightOneMetreIsTakenAndSaid) {
  const auto clip = captured(Film{}, {});
  ASSERT_TRUE(clip) << clip.error().message;
  ASSERT_EQ(clip->report.warnings.size(), 1u);
  EXPECT_THAT(clip->report.warnings[0], HasSubstr("--height"));
  EXPECT_NEAR(sample(clip->recording, "pos.z", 0), 1 - 70.0 / kHeight, 0.03);
}

TEST(FallsOnFilm, AFewFallsAreNotUsableAndSaySo) {
  const auto clip = captured(Film{.falls = 2});
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_FALSE(clip->report.verdict->usable);
  EXPECT_THAT(clip->report.verdict->reason, HasSubstr("only 2 falls"));
  EXPECT_FALSE(verdict_of(clip->recording)->usable);
}

void expect_refused(const Result<Captured>& clip, const char* reason) {
  ASSERT_FALSE(clip);
  EXPECT_THAT(clip.error().message, HasSubstr("paper.mp4"));
  EXPECT_THAT(clip.error().message, HasSubstr(reason));
}

Plane empty_wall(int frame) {
  Plane plane(kWidth, kHeight, 200);
  add_noise(plane, static_cast<unsigned>(frame) + 1, 2);
  return plane;
}

std::string reason_of(const Captured& clip) { return clip.report.verdict->reason; }

// A wall with what `strip` says of a frame.
Plane wall_with(const std::optional<Strip>& strip, int frame) {
  Plane plane(kWidth, kHeight, 200);
  if (strip) paint_strip(plane, *strip, 80);
  add_noise(plane, static_cast<unsigned>(frame) + 1, 2);
  return plane;
}

TEST(FallsOnFilm, FallsThatThePicturesSidesCutAreNotUsable) {
  const Film film{.falls = 12};
  const auto straying = [&](int frame) {
    auto at = film.strip(frame);
    const double way = frame / film.frames_a_fall % 2 == 0 ? 0.6 : -0.6;
    if (at) at->x += way * (at->y - 70);
    return wall_with(at, frame);
  };
  const auto clip = captured(film.frames(), kRate, straying);
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_FALSE(clip->report.verdict->usable) << reason_of(*clip);
  EXPECT_THAT(reason_of(*clip), HasSubstr("cut by the picture's sides"));
  EXPECT_THAT(reason_of(*clip), HasSubstr("from further away"));
}

TEST(FallsOnFilm, WhatIsOutOfSightForAMomentIsOneFall) {
  const Film film;
  const auto clip = captured(film.frames(), kRate, [&](int frame) {
    const int since = frame % film.frames_a_fall;
    return wall_with(since >= 20 && since < 24 ? std::nullopt : film.strip(frame), frame);
  });
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_EQ(falls_of(*clip), 6u);
  EXPECT_TRUE(clip->report.verdict->usable) << reason_of(*clip);
  EXPECT_LT(errors_of(*clip, film).position, 0.02 * kMetres);
}

TEST(FallsOnFilm, FallsThatAreLostFromViewAtAnyHeightAreNotUsable) {
  const Film film{.falls = 9};
  const auto clip = captured(film.frames(), kRate, [&](int frame) {
    const int fall = frame / film.frames_a_fall;
    const bool lost = frame % film.frames_a_fall > 24 + 4 * fall;
    return wall_with(lost ? std::nullopt : film.strip(frame), frame);
  });
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_FALSE(clip->report.verdict->usable) << reason_of(*clip);
  EXPECT_THAT(reason_of(*clip), HasSubstr("lost from view"));
}

TEST(FallsOnFilm, FallsThatEndOnATableAreWhole) {
  const Film film;
  const auto clip = captured(film.frames(), kRate, [&](int frame) {
    auto at = film.strip(frame);
    if (at && at->y > 230) at.reset();  // behind its edge
    return wall_with(at, frame);
  });
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_TRUE(clip->report.verdict->usable) << reason_of(*clip);
  EXPECT_EQ(std::get<std::int64_t>(clip->report.find("whole")->value), 6);
}

TEST(FallsOnFilm, ThingsThatMayBeTakenForEachOtherAreLeftOut) {
  const Film film{.falls = 4};
  const auto clip = captured(film.frames(), kRate, [&](int frame) {
    Plane plane = film.picture(frame);
    if (auto at = film.strip(frame)) {
      at->x = 60 + at->x / 2 + 10;
      at->y += 25;
      paint_strip(plane, *at, 80);
    }
    return plane;
  });
  expect_refused(clip, "one thing fall at a time");
}

TEST(FallCapture, WhatIsOverAtOnceSaysHowToFilmIt) {
  const auto clip = captured(6 * 30, kRate, [&](int frame) {
    const int since = frame % 30;
    return wall_with(since < 7 ? std::optional<Strip>({.x = 120, .y = 40 + 36.0 * since}) : std::nullopt, frame);
  });
  expect_refused(clip, "60 frames a second");
}

TEST(FallsOnFilm, AnAxisThatJumpsFromFrameToFrameIsNoTilt) {
  const Film film;
  const auto clip = captured(film.frames(), kRate, [&](int frame) {
    auto at = film.strip(frame);
    if (at && frame % 5 == 0) at->angle += 1.2;
    return wall_with(at, frame);
  });
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_FALSE(find_channel(clip->recording, "q.w"));
  EXPECT_THAT(std::get<std::string>(clip->report.find("tilt_reason")->value), HasSubstr("jumps"));
}

TEST(FallCapture, AFilmOfAWallSaysThatNothingMoves) {
  expect_refused(captured(90, kRate, empty_wall), "nothing moves");
}

TEST(FallsOnFilm, ACameraThatShakesSaysThatEverythingMoves) {
  std::mt19937 random(1);
  const auto shaken = [&](int) {
    const int dx = static_cast<int>(random() % 21), dy = static_cast<int>(random() % 21);
    Plane plane(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) plane.at(x, y) = ((x + dx) / 16 + (y + dy) / 16) % 2 == 0 ? 200 : 90;
    }
    return plane;
  };
  expect_refused(captured(90, kRate, shaken), "everything moves");
}

TEST(FallsOnFilm, ACameraThatTremblesBeforeAWallWithMarksIsNotUsable) {
  const Film film;
  std::mt19937 random(3);
  const auto trembling = [&](int frame) {
    const double dx = static_cast<double>(random() % 13) - 6, dy = static_cast<double>(random() % 13) - 6;
    Plane plane(kWidth, kHeight, 200);
    for (int k = 0; k < 16; ++k) {
      const double x = 40.0 * (k % 6) + 20 - dx, y = 106.0 * (k / 6) + 26 - dy;
      support::paint(plane, 60, 1.0, [&](double u, double v) { return 11 - std::hypot(u - x, v - y); });
    }
    if (auto at = film.strip(frame)) paint_strip(plane, {.x = at->x - dx, .y = at->y - dy, .angle = at->angle}, 60);
    return plane;
  };
  const auto clip = captured(film.frames(), kRate, trembling);
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_FALSE(clip->report.verdict->usable) << reason_of(*clip);
  EXPECT_THAT(reason_of(*clip), HasSubstr("shakes"));
}

TEST(FallCapture, AHandThatOnlyReachesInIsNoFall) {
  const auto waving = [](int frame) {
    Plane plane = empty_wall(frame);
    if (const int reach = frame % 90; reach < 40) plane.fill({100, 0, 30, 1 + 4 * reach}, 90);
    return plane;
  };
  expect_refused(captured(180, kRate, waving), "picture's edge");
}

TEST(FallsOnFilm, WhatHoversIsNoFall) {
  const auto hovering = [](int frame) {
    Plane plane = empty_wall(frame);
    paint_strip(plane, {.x = 60.0 + frame, .y = 150 + 20 * std::sin(0.2 * frame)}, 80);
    return plane;
  };
  expect_refused(captured(120, kRate, hovering), "nothing falls");
}

TEST(FallCapture, MoreFramesThanFitAreRefusedWithAWayOut) {
  const auto clip = captured(Film{}, {.max_bytes = 100u * kWidth * kHeight});
  expect_refused(clip, "more than 100 frames");
  EXPECT_THAT(clip.error().message, HasSubstr("at most 3 s"));
}

TEST(FallCapture, BadBeginningsAreRefused) {
  EXPECT_FALSE(FallCapture::create({"paper.mp4", 0}));
  EXPECT_FALSE(FallCapture::create({"paper.mp4", 30}, {.height_metres = -1}));
  expect_refused(captured(8, kRate, empty_wall), "8 frames");
  expect_refused(captured(90, kRate, empty_wall, {.region = {300, 0, 20, 20}}), "region");
  expect_refused(captured(90, kRate, [](int frame) { return Plane(kWidth + frame / 50, kHeight); }), "frame 51");
}

TEST(FallCapture, WhatMovesIsSeenWhileItIsFilmed) {
  auto capture = FallCapture::create({"paper.mp4", kRate});
  ASSERT_TRUE(capture);
  const Film film{.noise = 0};
  for (const int frame : {40, 41}) ASSERT_TRUE(capture->feed(grey_picture(film.picture(frame).view())));
  const FallSeen seen = capture->seen();
  EXPECT_EQ(seen.frames, 2u);
  const Strip at = *film.strip(41);
  EXPECT_LE(seen.moving.x, at.x);
  EXPECT_GE(seen.moving.right(), at.x);
  EXPECT_LT(seen.moving.width, 60);
  EXPECT_LE(seen.moving.y, at.y);
  EXPECT_GE(seen.moving.bottom(), at.y);
}

}  // namespace
}  // namespace wisp::fall_capture_test
