#include "wisp/draw/flame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "draw/draw_test_pictures.hpp"

namespace wisp::flame_test {
namespace {

constexpr int kWidth = 240;
constexpr int kHeight = 320;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

FlameScene scene() {
  FlameScene scene;
  scene.base = {120, 220};
  scene.pixels_per_unit = 150;
  return scene;
}

Image drawn(std::span<const Point> outline, const FlameScene& at, const FlameStyle& style = {}) {
  Image image(kWidth, kHeight);
  draw_flame(image, outline, at, style);
  return image;
}

double total_brightness(const Image& image) {
  double sum = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) sum += brightness_at(image, x, y);
  }
  return sum;
}

// Mean x of the light above the candle.
double middle_of_light(const Image& image) {
  double sum = 0, weighted = 0;
  for (int y = 0; y < 215; ++y) {
    for (int x = 0; x < image.width(); ++x) {
      sum += brightness_at(image, x, y);
      weighted += static_cast<double>(brightness_at(image, x, y)) * x;
    }
  }
  return weighted / sum;
}

int largest_difference(const Image& a, const Image& b) {
  int largest = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      const Colour p = a.at(x, y);
      const Colour q = b.at(x, y);
      largest = std::max({largest, std::abs(p.red - q.red), std::abs(p.green - q.green), std::abs(p.blue - q.blue)});
    }
  }
  return largest;
}

TEST(Flame, CoreIsBrighterThanRimAndRimThanGlow) {
  const Image image = drawn(drop_outline(), scene());
  const float core = brightness_at(image, 120, 145);
  int edge = 120;
  while (edge < kWidth && image.at(edge, 145).red > 200) ++edge;
  const float rim = brightness_at(image, edge - 2, 145);
  const float glow = brightness_at(image, edge + 12, 145);
  EXPECT_GT(core, 230);
  EXPECT_GT(core, rim + 40);
  EXPECT_GT(rim, glow + 20);
  EXPECT_GT(glow, 5);
}

TEST(Flame, IsBlueAtItsBaseAndOrangeAtItsTip) {
  FlameStyle bare;
  bare.candle = false;
  const Image image = drawn(drop_outline(), scene(), bare);
  const Colour base = image.at(120, 223);
  EXPECT_GT(base.blue, base.red + 20);
  const Colour tip = image.at(120, 78);
  EXPECT_GT(tip.red, tip.green + 40);
  EXPECT_GT(tip.green, tip.blue);
}

TEST(Flame, GlowFadesWithDistance) {
  const Image image = drawn(drop_outline(), scene());
  float last = 255;
  for (int x = 150; x < kWidth; x += 15) {
    const float here = brightness_at(image, x, 145);
    EXPECT_LT(here, last + 1) << "at " << x;
    last = here;
  }
  EXPECT_LT(last, 30);
}

TEST(Flame, WithoutGlowThePixelsAroundItKeepTheirBytes) {
  FlameStyle style;
  style.glow = 0;
  style.candle = false;
  Image image(kWidth, kHeight, {9, 10, 11, 255});
  draw_flame(image, drop_outline(), scene(), style);
  EXPECT_EQ(image.at(60, 150), (Colour{9, 10, 11, 255}));
  EXPECT_EQ(image.at(120, 20), (Colour{9, 10, 11, 255}));
  EXPECT_NE(image.at(120, 150), (Colour{9, 10, 11, 255}));
}

TEST(Flame, LeaningMovesItsLight) {
  const double left = middle_of_light(drawn(drop_outline(-0.5F), scene()));
  const double calm = middle_of_light(drawn(drop_outline(), scene()));
  const double right = middle_of_light(drawn(drop_outline(0.5F), scene()));
  EXPECT_NEAR(calm, 120, 1.5);
  EXPECT_LT(left, calm - 10);
  EXPECT_GT(right, calm + 10);
}

TEST(Flame, TheSameCallDrawsTheSameBytes) {
  FlameScene smoking = scene();
  smoking.seconds_since_out = 1.7F;
  EXPECT_TRUE(drawn(drop_outline(0.2F), scene()) == drawn(drop_outline(0.2F), scene()));
  EXPECT_TRUE(drawn(drop_outline(), smoking) == drawn(drop_outline(), smoking));
}

TEST(Flame, ASmallMoveOfTheOutlineChangesThePictureALittle) {
  // A three-hundredth of the flame's height is half a pixel here: at the sharp edge that is half of the step from
  // flame to night, and nowhere more.
  FlameScene at = scene();
  for (const float lean : {0.0F, 0.3F, 0.8F}) {
    for (const float height : {0.3F, 1.0F, 1.4F}) {
      const Image one = drawn(drop_outline(lean, height), at);
      const Image two = drawn(drop_outline(lean + 0.0033F, height), at);
      EXPECT_LT(largest_difference(one, two), 128) << "lean " << lean << ", height " << height;
      EXPECT_NEAR(total_brightness(one) / total_brightness(two), 1, 0.005) << "lean " << lean << ", height " << height;
    }
  }
}

TEST(Flame, ItsLightChangesAtASteadyPaceWithTheOutline) {
  // Steps of a fortieth of a pixel: where layers hung on whole cells or pixels, light would come in jumps.
  std::vector<double> light;
  for (int k = 0; k < 40; ++k) {
    light.push_back(total_brightness(drawn(drop_outline(0.1F, 1 + 0.00017F * static_cast<float>(k)), scene())));
  }
  const double pace = (light.back() - light.front()) / static_cast<double>(light.size() - 1);
  ASSERT_GT(pace, 0);
  for (std::size_t k = 1; k < light.size(); ++k) {
    EXPECT_NEAR((light[k] - light[k - 1]) / pace, 1, 1.5) << "at step " << k;
  }
}

TEST(Flame, AnOutlineWithoutAreaDrawsACandleThatDoesNotBurn) {
  const Image dark = drawn({}, scene());
  EXPECT_GT(total_brightness(dark), 0);
  const std::vector<std::vector<Point>> degenerate{
      {{0, 0}},
      {{-0.1F, 0}, {0.1F, 0}},
      {{0, 0}, {0, 0.5F}, {0, 1}},
      {{0.2F, 0.2F}, {0.2F, 0.2F}, {0.2F, 0.2F}, {0.2F, 0.2F}},
      {{kNan, 0}, {0, kNan}, {kInfinity, 1}, {1, -kInfinity}, {0, 1}},
  };
  for (const auto& outline : degenerate) EXPECT_TRUE(drawn(outline, scene()) == dark) << outline.size() << " points";
}

TEST(Flame, PointsThatAreNotFiniteAreLeftOut) {
  std::vector<Point> clean = drop_outline();
  std::vector<Point> dirty = clean;
  dirty.insert(dirty.begin() + 30, {kNan, 0.5F});
  dirty.insert(dirty.begin() + 50, {0.1F, kInfinity});
  dirty.push_back({kNan, kNan});
  EXPECT_TRUE(drawn(dirty, scene()) == drawn(clean, scene()));
}

TEST(Flame, WithoutCandleAndOutlineNothingIsDrawn) {
  FlameStyle bare;
  bare.candle = false;
  Image image(kWidth, kHeight, {1, 2, 3, 255});
  const Image before = image;
  draw_flame(image, {}, scene(), bare);
  EXPECT_TRUE(image == before);
  draw_flames(image, {});
  EXPECT_TRUE(image == before);
}

TEST(Flame, AbsurdScenesAndStylesAreHeldToTheirRanges) {
  const auto outline = drop_outline();
  for (const float value : {kNan, kInfinity, -kInfinity, 1e30F, -1e30F, 0.0F}) {
    FlameScene odd = scene();
    odd.base = {value, value};
    drawn(outline, odd);
    odd = scene();
    odd.pixels_per_unit = value;
    odd.wind = value;
    odd.seconds_since_out = value;
    odd.seconds_since_lit = value;
    drawn(outline, odd);
    FlameStyle style;
    style.glow = style.glow_reach = style.candle_width = value;
    drawn(outline, scene(), style);
  }
  Image empty;
  draw_flame(empty, outline, scene());
  EXPECT_TRUE(empty.empty());
}

TEST(Flame, PicturesOfAnySizeAndFlamesAcrossTheirEdgesWork) {
  const auto outline = drop_outline(0.4F, 1.3F);
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{2, 300}, std::pair{301, 3}, std::pair{97, 101}}) {
    for (const Point base : {Point{0, 0}, Point{50, 50}, Point{-40, 90}, Point{300, 400}, Point{50, -500}}) {
      Image image(width, height);
      FlameScene at = scene();
      at.base = base;
      draw_flame(image, outline, at);
      EXPECT_TRUE(std::ranges::all_of(image.pixels(), [](std::uint32_t pixel) { return pixel >> 24 == 255; }));
    }
  }
}

TEST(Flame, ABaseCapturedAroundTheWickIsDrawnAsADrop) {
  // From beside the wick down to a corner, up the side, and likewise back: between the corners there is a notch.
  const std::vector<Point> corners{{-0.01F, 0.08F}, {-0.2F, -0.1F}, {-0.14F, 0.1F}, {-0.12F, 0.4F},
                                   {-0.09F, 0.8F},  {0, 1},         {0.09F, 0.8F},  {0.12F, 0.4F},
                                   {0.14F, 0.1F},   {0.2F, -0.1F},  {0.01F, 0.08F}};
  std::vector<Point> notched;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    for (int part = 0; part < 8; ++part) {
      const float s = static_cast<float>(part) / 8;
      notched.push_back({(1 - s) * corners[k].x + s * corners[k + 1].x, (1 - s) * corners[k].y + s * corners[k + 1].y});
    }
  }
  notched.push_back(corners.back());
  FlameStyle bare;
  bare.candle = false;
  bare.glow = 0;
  const Image image = drawn(notched, scene(), bare);
  EXPECT_GT(image.at(120, 217).blue, 30);        // in the notch
  EXPECT_EQ(brightness_at(image, 147, 232), 0);  // at the corner, (0.18, −0.08)
  EXPECT_EQ(brightness_at(image, 93, 232), 0);
}

TEST(Flame, OutlinesFarLargerThanThePictureWork) {
  std::vector<Point> huge;
  for (const Point p : drop_outline()) huge.push_back({p.x * 1e20F, p.y * 1e20F});
  Image image = drawn(huge, scene());
  EXPECT_EQ(image.width(), kWidth);
}

TEST(Flame, BurnsUnlessItWentOutAfterItWasLit) {
  FlameScene at;
  EXPECT_TRUE(burns(at));
  at.seconds_since_out = 2;
  EXPECT_FALSE(burns(at));
  at.seconds_since_lit = 1;
  EXPECT_TRUE(burns(at));
  at.seconds_since_lit = 3;
  EXPECT_FALSE(burns(at));
}

TEST(Flame, DiesWithinASecondAndLeavesAnEmberAndSmoke) {
  FlameScene at = scene();
  const double lit = total_brightness(drawn(drop_outline(), at));
  at.seconds_since_out = 0.05F;
  const double dying = total_brightness(drawn(drop_outline(), at));
  at.seconds_since_out = 1.0F;
  const Image smoking = drawn(drop_outline(), at);
  EXPECT_LT(dying, lit);
  EXPECT_LT(total_brightness(smoking), 0.5 * dying);
  at.seconds_since_out = 60;
  const Image cold = drawn({}, at);
  int smoke = 0;
  for (int y = 0; y < 190; ++y) {
    for (int x = 0; x < kWidth; ++x) smoke += brightness_at(smoking, x, y) > brightness_at(cold, x, y) + 4 ? 1 : 0;
  }
  EXPECT_GT(smoke, 200);
  int ember = 0;
  for (int y = 190; y < 225; ++y) {
    for (int x = 100; x < 140; ++x) ember = std::max<int>(ember, smoking.at(x, y).red - smoking.at(x, y).blue);
  }
  EXPECT_GT(ember, 60);
}

TEST(Flame, OutItShowsNoFlameWhateverItsOutline) {
  FlameScene at = scene();
  at.seconds_since_out = 1.5F;
  EXPECT_TRUE(drawn(drop_outline(), at) == drawn({}, at));
}

TEST(Flame, TheWickSmokesLessAndLess) {
  FlameScene at = scene();
  FlameStyle bare;
  bare.candle = false;
  double last = 1e9;
  for (const float seconds : {1.2F, 2.8F, 4.2F, 6.0F}) {
    at.seconds_since_out = seconds;
    const Image image = drawn({}, at, bare);
    double near_wick = 0;
    for (int y = 140; y < 200; ++y) {
      for (int x = 90; x < 150; ++x) near_wick += brightness_at(image, x, y);
    }
    EXPECT_LT(near_wick, 0.8 * last) << "after " << seconds;
    last = near_wick;
  }
}

TEST(Flame, SmokeAndEmberAreGoneAfterAWhile) {
  FlameScene at = scene();
  at.seconds_since_out = 60;
  EXPECT_TRUE(drawn({}, at) == drawn({}, scene()));
}

TEST(Flame, WindCarriesTheSmoke) {
  FlameScene at = scene();
  at.seconds_since_out = 1.2F;
  FlameStyle bare;
  bare.candle = false;
  at.wind = 0.5F;
  const double right = middle_of_light(drawn({}, at, bare));
  at.wind = -0.5F;
  const double left = middle_of_light(drawn({}, at, bare));
  EXPECT_GT(right, left + 30);
}

TEST(Flame, WindBeforeTheNewestExtinctionDoesNotCarryItsSmoke) {
  constexpr std::chrono::milliseconds kStep{10};
  SmokeDrift drift;
  FlameScene at = scene();
  drift.blow(1, {.lit = false, .since_out = kStep, .went_out = true}, kStep, at);
  EXPECT_FLOAT_EQ(at.wind, 1.5F);
  drift.blow(-1, {.lit = false, .since_out = 3 * kStep, .went_out = true}, kStep, at);  // of four steps in the second
  EXPECT_FLOAT_EQ(at.wind, -1.5F);
}

TEST(Flame, RelitItGrowsBackToFullSize) {
  FlameScene at = scene();
  at.seconds_since_out = 30;
  double last = 0;
  for (const float seconds : {0.02F, 0.12F, 0.25F, 0.5F}) {
    at.seconds_since_lit = seconds;
    const double here = total_brightness(drawn(drop_outline(), at));
    EXPECT_GT(here, last) << "after " << seconds;
    last = here;
  }
  EXPECT_TRUE(drawn(drop_outline(), at) == drawn(drop_outline(), scene()));
  at.seconds_since_lit = 0.05F;
  EXPECT_LT(brightness_at(drawn(drop_outline(), at), 120, 140), 30);
}

TEST(Flame, AnOutlineThatShrinksByItselfIsDrawnAsItIs) {
  FlameScene at = scene();
  at.seconds_since_out = 0.05F;
  std::vector<Point> half = drop_outline();
  for (Point& p : half) p = {0.5F * p.x, 0.5F * p.y};
  at.size = 0.5F;
  FlameStyle bare;
  bare.glow = 0;
  const Image dying = drawn(half, at, bare);
  const auto reaches = [](const Image& image) {  // the highest row that is bright on the axis
    int y = 0;
    while (y < kHeight && brightness_at(image, 120, y) <= 20) ++y;
    return y;
  };
  FlameScene full = scene();
  EXPECT_NEAR(reaches(dying), reaches(drawn(half, full, bare)), 12);
  at.size.reset();
  EXPECT_GT(reaches(drawn(half, at, bare)), reaches(dying) + 3);
  at.seconds_since_out = 0.2F;
  at.size = 0.0F;
  EXPECT_TRUE(drawn(std::vector<Point>(32), at) == drawn({}, at));
  at.seconds_since_out = kLongAgo;
  at.size = 1.0F;
  EXPECT_TRUE(drawn(drop_outline(), at) == drawn(drop_outline(), scene()));
}

TEST(Flame, LightsTheSideOfADarkNeighbourThatFacesIt) {
  const auto outline = drop_outline();
  FlameScene burning = scene();
  burning.pixels_per_unit = 60;
  burning.base = {70, 150};
  FlameScene dark = burning;
  dark.base = {170, 150};
  dark.seconds_since_out = 100;
  FlameStyle style;
  style.glow = 0;
  const std::array<Flame, 2> row{Flame{outline, burning}, Flame{{}, dark}};
  Image image(kWidth, kHeight);
  draw_flames(image, row, style);
  EXPECT_GT(image.at(156, 185).red, image.at(184, 185).red + 8);
}

TEST(Flame, SeveralCandlesDrawTheSameInAnyOrderWhereTheyDoNotOverlap) {
  const auto outline = drop_outline();
  FlameScene one = scene();
  one.pixels_per_unit = 60;
  one.base = {60, 150};
  FlameScene two = one;
  two.base = {180, 150};
  Image first(kWidth, kHeight);
  Image second(kWidth, kHeight);
  draw_flames(first, std::array{Flame{outline, one}, Flame{outline, two}});
  draw_flames(second, std::array{Flame{outline, two}, Flame{outline, one}});
  // Sums of floats in another order may differ in the last bit, so a code here and there.
  EXPECT_LE(largest_difference(first, second), 1);
}

TEST(Flame, OnATransparentPictureItsLightIsWhatCovers) {
  Image image(kWidth, kHeight, {0, 0, 0, 0});
  FlameStyle bare;
  bare.candle = false;
  draw_flame(image, drop_outline(), scene(), bare);
  EXPECT_GT(image.at(120, 150).opacity, 240);
  EXPECT_LT(image.at(5, 5).opacity, 40);
  for (const std::uint32_t pixel : image.pixels()) {
    const std::uint32_t opacity = pixel >> 24;
    ASSERT_LE(pixel >> 16 & 0xFFU, opacity);
    ASSERT_LE(pixel & 0xFFU, opacity);
  }
}

TEST(Room, WithoutFlamesIsOpaqueDarkAndDithered) {
  Image image(64, 200, {0, 0, 0, 0});
  draw_room(image, {});
  int mixed_rows = 0;
  for (int y = 0; y < image.height(); ++y) {
    const auto row = image.row(y);
    mixed_rows += std::ranges::any_of(row, [&](std::uint32_t pixel) { return pixel != row[0]; }) ? 1 : 0;
    EXPECT_EQ(row[0] >> 24, 255U);
    EXPECT_LT(brightness_at(image, 0, y), 40);
  }
  EXPECT_GT(mixed_rows, 150);
}

// The room around a candle in the middle whose flame leans to a side.
Image room_around(float lean, FlameScene scene = framed(400, 300)) {
  const auto outline = drop_outline(lean);
  const Flame flame{outline, scene};
  Image image(400, 300);
  draw_room(image, {&flame, 1});
  return image;
}

TEST(Room, ItsWallIsLitByTheFlameAndFallsOffAwayFromIt) {
  const Image lit = room_around(0);
  EXPECT_GT(brightness_at(lit, 200, 120), brightness_at(lit, 60, 120) + 20);
  EXPECT_GT(brightness_at(lit, 60, 120), brightness_at(lit, 2, 2));
  FlameScene out = framed(400, 300);
  out.seconds_since_out = 3;
  EXPECT_GT(brightness_at(lit, 200, 120), brightness_at(room_around(0, out), 200, 120) + 20);
}

TEST(Room, ItsLightAndTheCandlesShadowFollowTheFlame) {
  const Image left = room_around(-0.5F), right = room_around(0.5F);
  EXPECT_GT(brightness_at(right, 260, 120), brightness_at(left, 260, 120));
  // On the table beside the foot: a flame on the right throws the candle's shadow to the left.
  EXPECT_GT(brightness_at(right, 245, 285), brightness_at(right, 155, 285));
  EXPECT_GT(brightness_at(left, 155, 285), brightness_at(left, 245, 285));
}

TEST(Framed, LeavesRoomForAFlameOfTwiceItsHeight) {
  for (const auto& [width, height] : {std::pair{640, 480}, std::pair{1920, 1080}, std::pair{360, 640}}) {
    const FlameScene at = framed(width, height);
    EXPECT_GT(at.base.y - 2 * at.pixels_per_unit, 0);
    EXPECT_LT(at.base.y + 0.15F * at.pixels_per_unit, height);
    EXPECT_GT(at.pixels_per_unit, 0.2F * static_cast<float>(std::min(width, height)));
  }
}

}  // namespace
}  // namespace wisp::flame_test
