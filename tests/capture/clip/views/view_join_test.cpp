#include "capture/clip/views/view_join.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "record/verdict.hpp"
#include "wisp/model/shape_components.hpp"

namespace wisp::view_join_test {
namespace {

using testing::HasSubstr;

constexpr double kRate = 50, kHeight = 200;
constexpr std::size_t kPoints = 8, kRings = 4;

double turned(double degrees) { return degrees * std::numbers::pi / 180; }

struct Ring {
  double x, y, z, radius, rise_x, rise_z;
};

// A body of known motion: nothing in it comes back after some seconds.
Ring ring_at(std::size_t k, double t) {
  const double up = static_cast<double>(k) / (kRings - 1),
               height = kHeight * (1 + 0.06 * std::sin(5 * t + 0.3 * t * t));
  const double lean = 60 * up * up;
  return {lean * std::sin(1.7 * t) * std::sin(0.4 * t * t),
          height * up,
          lean * std::cos(2.3 * t + 0.2 * t * t),
          30 - 25 * up,
          4 * up * std::sin(3 * t),
          3 * up * std::cos(t)};
}

// Loud where it blows, and never twice alike.
double loudness_at(double t) { return 0.01 + 0.1 * std::pow(std::max(0.0, std::sin(1.1 * t + 0.25 * t * t)), 2); }

struct Filming {
  double azimuth = 0, start = 0, seconds = 14, scale = 1;
  bool hears = true;
  std::size_t points = kPoints;
};

// What a level camera sees, that began at a time of its own and stands nearer or farther.
FilmedView film(const Filming& how) {
  FilmedView view{
      how.azimuth, {.source = std::to_string(static_cast<int>(how.azimuth)) + ".mp4", .rate_hz = kRate}, {}, 0};
  const auto rows = static_cast<std::size_t>(how.seconds * kRate);
  view.recording.channels.push_back({"wind", "", Role::kInput, {}});
  for (std::size_t p = 0; p < how.points; ++p)
    for (const char* axis : {".x", ".y"})
      view.recording.channels.push_back({"p" + std::to_string(p) + axis, "px", Role::kOutput, {}});
  const double c = std::cos(turned(how.azimuth)), s = std::sin(turned(how.azimuth));
  for (std::size_t row = 0; row < rows; ++row) {
    const double t = how.start + static_cast<double>(row) / kRate;
    std::vector<double> shape(2 * kPoints);
    for (std::size_t k = 0; k < kRings; ++k) {
      const Ring ring = ring_at(k, t);
      shape[2 * k] = ring.radius, shape[2 * k + 1] = ring.y;
      shape[kPoints + 2 * k] = ring.x * c - ring.z * s, shape[kPoints + 2 * k + 1] = ring.rise_x * c - ring.rise_z * s;
    }
    const std::vector<double> seen = control_points(shape);
    view.recording.channels[0].samples.push_back(loudness_at(t));
    for (std::size_t i = 0; i < 2 * how.points; ++i)
      view.recording.channels[1 + i].samples.push_back(i % 2 == 0 ? 160 + how.scale * seen[i]
                                                                  : 400 - how.scale * seen[i]);
  }
  for (std::size_t n = 0; how.hears && n < static_cast<std::size_t>(how.seconds * kRate); ++n)
    view.loudness.push_back(loudness_at(how.start + static_cast<double>(n) / kRate));
  return view;
}

const std::vector<double>& samples(const Recording& recording, const std::string& name) {
  return recording.channels[find_channel(recording, name).value()].samples;
}

// The farthest that rings are from where they were, and radii, as shares of the height. `first` began at `from`.
std::pair<double, double> errors(const Recording& rings, double from) {
  double place = 0, radius = 0;
  for (std::size_t row = 0; row < rings.rows(); ++row) {
    for (std::size_t k = 0; k < kRings; ++k) {
      const Ring truth = ring_at(k, from + static_cast<double>(row) / kRate);
      const std::string name = "ring" + std::to_string(k);
      const double dx = samples(rings, name + ".x")[row] - truth.x, dz = samples(rings, name + ".z")[row] - truth.z;
      const double dy = samples(rings, name + ".y")[row] - truth.y;
      place = std::max(place, std::sqrt(dx * dx + dy * dy + dz * dz) / kHeight);
      radius = std::max(radius, std::abs(samples(rings, name + ".r")[row] - truth.radius) / kHeight);
    }
  }
  return {place, radius};
}

TEST(JoinViews, TwoViewsAtAnyTwoAnglesGiveTheBody) {
  for (const auto& [a, b] : {std::pair{0.0, 90.0}, {0.0, 35.0}, {-20.0, 100.0}, {10.0, 250.0}}) {
    const FilmedView views[] = {film({.azimuth = a}), film({.azimuth = b, .scale = 1.3})};
    const auto joined = join_views(views);
    ASSERT_TRUE(joined) << joined.error().message;
    EXPECT_TRUE(joined->report.verdict->usable) << joined->report.verdict->reason;
    const auto [place, radius] = errors(joined->recording, 0);
    EXPECT_LT(place, 0.01) << a << ", " << b;
    EXPECT_LT(radius, 0.01) << a << ", " << b;
  }
}

TEST(JoinViews, ThreeViewsAreSolvedByLeastSquares) {
  const FilmedView views[] = {film({}), film({.azimuth = 60, .start = 0.4}), film({.azimuth = 120, .start = 1.0})};
  const auto joined = join_views(views);
  ASSERT_TRUE(joined) << joined.error().message;
  EXPECT_LT(errors(joined->recording, 1.0).first, 0.03);
  EXPECT_EQ(find_attribute(joined->recording, "azimuths"), "0 60 120");
}

TEST(JoinViews, FilmsThatBeganAtOtherTimesAreJoinedByTheirSound) {
  // Not by whole frames.
  const FilmedView views[] = {film({.start = 1.5}), film({.azimuth = 90, .start = 0.213})};
  const auto joined = join_views(views);
  ASSERT_TRUE(joined) << joined.error().message;
  const auto& row = joined->report.sections[0].tables[0].rows[1];
  EXPECT_NEAR(std::get<double>(row[3]), 0.213 - 1.5, 0.002);
  EXPECT_EQ(std::get<std::string>(row[4]), "sound");
  EXPECT_LT(errors(joined->recording, 1.5).first, 0.02);
}

TEST(JoinViews, WithoutSoundTheFlamesHeightSaysWhenAFilmBegan) {
  const FilmedView views[] = {film({.hears = false}), film({.azimuth = 90, .start = 2.307, .hears = false})};
  const auto joined = join_views(views);
  ASSERT_TRUE(joined) << joined.error().message;
  const auto& row = joined->report.sections[0].tables[0].rows[1];
  EXPECT_NEAR(std::get<double>(row[3]), 2.307, 0.01);
  EXPECT_EQ(std::get<std::string>(row[4]), "height");
  EXPECT_TRUE(joined->report.verdict->usable) << joined->report.verdict->reason;
}

TEST(JoinViews, ABlowPointsToWhereTheFlameLeans) {
  std::vector<FilmedView> views;
  for (const double azimuth : {0.0, 90.0}) {
    views.push_back(film({.azimuth = azimuth, .hears = false}));
    Recording& recording = views.back().recording;
    for (std::size_t row = 0; row < recording.rows(); ++row) {
      // A blow of two seconds every four, each from 70 degrees further; the whole flame goes with it.
      const auto blow = row / 200;
      const double wind = row % 200 < 100 ? 1 : 0, towards = turned(70.0 * static_cast<double>(blow));
      recording.channels[0].samples[row] = wind;
      const double lean =
          wind * (std::cos(towards) * std::cos(turned(azimuth)) - std::sin(towards) * std::sin(turned(azimuth)));
      for (std::size_t k = 2; k < kPoints - 2; ++k) recording.channels[1 + 2 * k].samples[row] = 160 + 80 * lean;
    }
  }
  const auto joined = join_views(views);
  ASSERT_TRUE(joined) << joined.error().message;
  for (const std::size_t blow : {0u, 1u, 2u}) {
    const double towards = turned(70.0 * static_cast<double>(blow));
    EXPECT_NEAR(samples(joined->recording, "wind.x")[200 * blow + 50], std::cos(towards), 0.02);
    EXPECT_NEAR(samples(joined->recording, "wind.z")[200 * blow + 50], std::sin(towards), 0.02);
    EXPECT_EQ(samples(joined->recording, "wind.x")[200 * blow + 150], 0);
    EXPECT_EQ(samples(joined->recording, "wind")[200 * blow + 50], 1);
    // Seen from beside it every blow goes to the right, and as far.
    EXPECT_NEAR(
        samples(joined->recording, "p3.x")[200 * blow + 50] + samples(joined->recording, "p4.x")[200 * blow + 50], 160,
        4);
    EXPECT_NEAR(std::get<double>(joined->report.sections[1].tables[0].rows[blow][3]), 1, 0.01);
    EXPECT_NEAR(std::get<double>(joined->report.sections[1].tables[0].rows[blow][4]), 80, 2);
  }
  // Three blows and a half are too few to say whether it is the same from all sides.
  EXPECT_THAT(joined->report.find("symmetry_differs")->meaning, HasSubstr("at least nine blows"));
  EXPECT_EQ(episodes(joined->recording).size(), 4u);
}

// A flame that is blown at from all round, a second every two, and leans `further` times as far along z as along x.
Captured blown_from_all_round(double further) {
  std::vector<FilmedView> views;
  for (const double azimuth : {0.0, 90.0}) {
    views.push_back(film({.azimuth = azimuth, .seconds = 40, .hears = false}));
    Recording& recording = views.back().recording;
    for (std::size_t row = 0; row < recording.rows(); ++row) {
      const double wind = row % 100 < 50 ? 0.6 + 0.02 * static_cast<double>(row / 100 % 7) : 0;
      const double towards = turned(74.0 * static_cast<double>(row / 100)), x = std::cos(towards),
                   z = std::sin(towards);
      recording.channels[0].samples[row] = wind;
      const double lean = wind * (azimuth > 0 ? -further * z : x);
      for (std::size_t k = 2; k < kPoints - 2; ++k) recording.channels[1 + 2 * k].samples[row] = 160 + 80 * lean;
    }
  }
  return std::move(join_views(views)).value();
}

TEST(JoinViews, SaysHowFarAFlameIsFromBeingTheSameFromAllSides) {
  const Captured same = blown_from_all_round(1), flat = blown_from_all_round(1.5);
  const ReportEntry& found = *same.report.find("symmetry_differs");
  EXPECT_LT(std::get<double>(found.value), 3);
  EXPECT_EQ((*found.interval)[0], 0);
  // 1 to 1.5 times, twice a turn: 0.2 of the mean about it, 0.14 in the root mean square.
  const ReportEntry& other = *flat.report.find("symmetry_differs");
  EXPECT_NEAR(std::get<double>(other.value), 14, 3);
  EXPECT_GT((*other.interval)[0], 0);
  EXPECT_EQ((**numbers_attribute(flat.recording, "symmetry")).size(), 3u);
}

std::string refusal(std::span<const FilmedView> views) {
  const auto joined = join_views(views);
  return joined ? "joined" : joined.error().message;
}

TEST(JoinViews, RefusesFilmsThatCannotBeJoined) {
  const FilmedView front = film({}), side = film({.azimuth = 90});
  EXPECT_THAT(refusal({&front, 1}), HasSubstr("expected at least two films"));
  const FilmedView same[] = {front, film({.azimuth = 0.2})}, behind[] = {front, film({.azimuth = 180})};
  EXPECT_THAT(refusal(same), HasSubstr("same direction as 0.mp4"));
  EXPECT_THAT(refusal(behind), HasSubstr("or the opposite one"));
  FilmedView faster[] = {front, side};
  faster[1].recording.rate_hz = 60;
  EXPECT_THAT(refusal(faster), HasSubstr("90.mp4: has 60 frames a second, but 0.mp4 has 50"));
  faster[1].recording.rate_hz = 50 / 1.001;  // as 29.97 beside 30: a frame off after 20 s
  EXPECT_THAT(refusal(faster), HasSubstr("90.mp4: has 49.95 frames a second, but 0.mp4 has 50"));
  const FilmedView coarse[] = {front, film({.azimuth = 90, .points = 6})};
  EXPECT_THAT(refusal(coarse), HasSubstr("90.mp4: has 6 control points"));
  FilmedView refused[] = {front, side};
  set_verdict(refused[1].recording, false, "a lamp");
  EXPECT_THAT(refusal(refused), HasSubstr("90.mp4: cannot be joined: a lamp"));
  const FilmedView brief[] = {front, film({.azimuth = 90, .seconds = 1.5})};
  EXPECT_THAT(refusal(brief), HasSubstr("no time in common"));
  const double angles[] = {0};
  const std::string names[] = {"a.mp4", "b.mp4"};
  EXPECT_THAT(check_azimuths(angles, names).error().message, HasSubstr("1 angles for 2 films"));
}

TEST(JoinViews, IsNotUsableWhereFilmsDoNotBelongTogether) {
  const auto verdict = [](const FilmedView& other) {
    const FilmedView views[] = {film({}), other};
    const auto joined = join_views(views);
    return joined ? joined->report.verdict->reason : joined.error().message;
  };
  EXPECT_THAT(verdict(film({.azimuth = 12})), HasSubstr("12° from each other"));
  EXPECT_THAT(verdict(film({.azimuth = 90, .start = 40})), HasSubstr("not certain"));
}

}  // namespace
}  // namespace wisp::view_join_test
