#include "wisp/draw/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "draw/draw_test_pictures.hpp"
#include "wisp/base/file.hpp"

// Fontconfig keeps what it has read until the process ends.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig"; }

namespace wisp::plot_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Colour kRed{220, 0, 0, 255};
constexpr Colour kBlue{0, 0, 220, 255};

PlotSheet sheet_of(Plot plot) {
  PlotSheet sheet;
  sheet.plots.push_back(std::move(plot));
  return sheet;
}

PlotSeries line(std::vector<double> x, std::vector<double> y, Colour colour = kRed) {
  PlotSeries series;
  series.x = std::move(x);
  series.y = std::move(y);
  series.colour = colour;
  series.width = 3;
  return series;
}

int pixels_of(const Image& image, Colour colour) {
  int count = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) count += image.at(x, y) == colour ? 1 : 0;
  }
  return count;
}

std::string text_of(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  if (!bytes) return {};
  return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

TEST(Plot, DrawsItsLineInItsColour) {
  Plot plot;
  plot.series = {line({0, 1, 2}, {0, 2, 1})};
  const Image image = draw_plots(sheet_of(plot));
  EXPECT_GT(pixels_of(image, kRed), 500);
  EXPECT_EQ(image.at(0, 0), (Colour{255, 255, 255, 255}));
}

TEST(Plot, HigherValuesAreHigherUp) {
  Plot plot;
  plot.series = {line({0, 1}, {1, 1}, kRed), line({0, 1}, {3, 3}, kBlue)};
  const Image image = draw_plots(sheet_of(plot));
  const int middle = image.width() / 2;
  int red = -1, blue = -1;
  for (int y = 0; y < image.height(); ++y) {
    if (image.at(middle, y) == kRed) red = y;
    if (image.at(middle, y) == kBlue) blue = y;
  }
  ASSERT_GE(red, 0);
  ASSERT_GE(blue, 0);
  EXPECT_LT(blue, red - 50);
}

TEST(Plot, ALineBreaksWhereASampleIsMissing) {
  Plot whole, broken;
  std::vector<double> x, y;
  for (int k = 0; k < 21; ++k) {
    x.push_back(k);
    y.push_back(1);
  }
  whole.series = {line(x, y)};
  for (int k = 6; k < 15; ++k) y[static_cast<std::size_t>(k)] = kNan;
  broken.series = {line(x, y)};
  const int all = pixels_of(draw_plots(sheet_of(whole)), kRed);
  const int rest = pixels_of(draw_plots(sheet_of(broken)), kRed);
  EXPECT_NEAR(static_cast<double>(rest) / all, 0.5, 0.05);
}

TEST(Plot, IntervalsAreDrawnAndHaveRoom) {
  Plot plot;
  plot.series = {line({0, 1, 2}, {1, 1, 1})};
  const int without = pixels_of(draw_plots(sheet_of(plot)), kRed);
  plot.series[0].low = {0.2, 0.2, 0.2};
  plot.series[0].high = {1.9, 1.9, 1.9};
  plot.y.lowest = 0;
  plot.y.highest = 2;
  const Image image = draw_plots(sheet_of(plot));
  EXPECT_NE(pixels_of(image, kRed), without);
  // The middle one stands a quarter of the way above the line.
  int marked = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = image.width() / 2 - 40; x < image.width() / 2 + 60; ++x) marked += image.at(x, y).green < 200 ? 1 : 0;
  }
  EXPECT_GT(marked, 300);
}

TEST(Plot, AMarkStandsAtItsValue) {
  Plot plot;
  plot.series = {line({0, 100}, {0, 1}, kBlue)};
  plot.marks = {{.at = 75, .colour = kRed, .dash = Dash::kSolid}};
  const Image image = draw_plots(sheet_of(plot));
  int left = image.width(), right = 0, blue_left = image.width(), blue_right = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const Colour colour = image.at(x, y);
      if (colour.red > 200 && colour.green < 60) {
        left = std::min(left, x);
        right = std::max(right, x);
      }
      if (colour.blue > 200 && colour.green < 60) {
        blue_left = std::min(blue_left, x);
        blue_right = std::max(blue_right, x);
      }
    }
  }
  EXPECT_LT(right - left, 6);
  EXPECT_NEAR(static_cast<double>(left - blue_left) / (blue_right - blue_left), 0.75, 0.02);
}

TEST(Plot, AnythingCanBePlotted) {
  std::vector<Plot> plots(9);
  plots[1].series = {line({}, {})};
  plots[2].series = {line({kNan, 1}, {2, kNan})};
  plots[3].series = {line({1}, {5})};
  plots[4].series = {line({0, 1}, {0, 0})};
  plots[5].series = {line({0, 1, 2}, {-1, 0, 10})};
  plots[5].y.logarithmic = true;
  plots[5].x.logarithmic = true;
  plots[6].series = {line({0, 1, 2}, {1e-300, 1e300, -1e300})};
  plots[7].series = {line({0, 1}, {std::numeric_limits<double>::infinity(), 3})};
  plots[7].x.lowest = 5;
  plots[7].x.highest = -5;
  plots[8].series = {line({0, 1, 2, 3}, {1, 2})};
  plots[8].series[0].low = {0};
  plots[8].series[0].shape = SeriesShape::kBars;
  plots[8].title = "not \xFF UTF-8";
  for (const Plot& plot : plots) {
    PlotSheet sheet = sheet_of(plot);
    sheet.pixels_per_point = 1;
    EXPECT_FALSE(draw_plots(sheet).empty());
    sheet.plot_width = 80;
    sheet.plot_height = 80;
    EXPECT_FALSE(draw_plots(sheet).empty());
  }
}

TEST(Plot, ManySamplesMakeASmallSvgThatShowsTheSame) {
  const TestFolder folder("plot-dense");
  PlotSeries sound = line({}, {});
  sound.width = 1;
  for (int k = 0; k < 200000; ++k) {
    const double peak = k == 90000 ? 3 : k == 140000 ? -3 : 0;
    sound.x.push_back(k / 44100.0);
    sound.y.push_back(peak != 0 ? peak : std::sin(k * 0.7));
  }
  Plot plot;
  plot.y.lowest = -4;
  plot.y.highest = 4;
  plot.series = {sound};
  ASSERT_TRUE(write_plots(folder / "sound.svg", sheet_of(plot)));
  const std::string text = text_of(folder / "sound.svg");
  EXPECT_GT(text.size(), 2000U);
  EXPECT_LT(text.size(), 400000U);
  // Single tall samples are not lost: they reach far above and below everything else.
  const Image image = draw_plots(sheet_of(plot));
  int highest = image.height(), lowest = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const Colour colour = image.at(x, y);
      if (colour.red < 180 || colour.green > 160) continue;
      highest = std::min(highest, y);
      lowest = std::max(lowest, y);
    }
  }
  EXPECT_GT(lowest - highest, image.height() / 2);
}

TEST(Plot, WritesPngAndSvgByTheName) {
  const TestFolder folder("plot-files");
  Plot plot;
  plot.title = "Residuals";
  plot.series = {line({0, 1}, {0, 1})};
  const PlotSheet sheet = sheet_of(plot);
  ASSERT_TRUE(write_plots(folder / "a.png", sheet));
  ASSERT_TRUE(write_plots(folder / "a.svg", sheet));
  EXPECT_EQ(text_of(folder / "a.png").substr(1, 3), "PNG");
  const std::string svg = text_of(folder / "a.svg");
  EXPECT_NE(svg.find("<svg"), std::string::npos);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  const auto other = write_plots(folder / "a.pdf", sheet);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("a.pdf"), std::string::npos);
  EXPECT_FALSE(write_plots(folder / "nowhere/a.svg", sheet));
  EXPECT_FALSE(write_plots(folder / "b.png", {}));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.pdf"));
  EXPECT_FALSE(std::filesystem::exists(folder / "b.png"));
}

TEST(Plot, TwoPlotsShareTheirAxes) {
  Plot a{.series = {{.x = {-2, 1}, .y = {1, std::nan("")}}}};
  Plot b{.series = {{.x = {3}, .y = {-5}}}};
  share_axes(a, b);
  for (const Plot& plot : {a, b}) {
    EXPECT_EQ(plot.x.lowest, -2);
    EXPECT_EQ(plot.x.highest, 3);
    EXPECT_EQ(plot.y.lowest, -5);
    EXPECT_EQ(plot.y.highest, 1);
  }
}

TEST(Plot, DrawsTheSameTwice) {
  const TestFolder folder("plot-twice");
  Plot plot;
  plot.title = "Residuals";
  plot.series = {line({0, 1, 2}, {0, 1, 0.5})};
  plot.series[0].label = "x";
  PlotSheet sheet = sheet_of(plot);
  sheet.plots.emplace_back();
  EXPECT_TRUE(draw_plots(sheet) == draw_plots(sheet));
  ASSERT_TRUE(write_plots(folder / "a.svg", sheet));
  ASSERT_TRUE(write_plots(folder / "b.svg", sheet));
  // Compared without printing them: they are long.
  EXPECT_TRUE(text_of(folder / "a.svg") == text_of(folder / "b.svg"));
}

TEST(Plot, PlotsStandInTheColumnsAskedFor) {
  PlotSheet sheet;
  sheet.plots.resize(5);
  sheet.plot_width = 100;
  sheet.plot_height = 90;
  sheet.pixels_per_point = 1;
  sheet.columns = 2;
  const Image two = draw_plots(sheet);
  sheet.columns = 0;
  const Image row = draw_plots(sheet);
  EXPECT_NEAR(two.width(), 200, 30);
  EXPECT_NEAR(two.height(), 270, 30);
  EXPECT_NEAR(row.width(), 500, 30);
  EXPECT_NEAR(row.height(), 90, 30);
}

// The first column of pixels with that colour, in rows [from, to).
int leftmost(const Image& image, Colour colour, int from, int to) {
  for (int x = 0; x < image.width(); ++x) {
    for (int y = from; y < to; ++y) {
      if (image.at(x, y) == colour) return x;
    }
  }
  return -1;
}

TEST(Plot, AxesBelowEachOtherAreAligned) {
  PlotSheet sheet;
  sheet.columns = 1;
  sheet.plots.resize(2);
  sheet.plots[0].series = {line({0, 1}, {0, 0.00125}, kRed)};
  sheet.plots[1].series = {line({0, 1}, {0, 3}, kRed)};
  sheet.plots[1].y.label = "y";
  const Image both = draw_plots(sheet);
  const int middle = both.height() / 2;
  ASSERT_GE(leftmost(both, kRed, 0, middle), 0);
  EXPECT_EQ(leftmost(both, kRed, 0, middle), leftmost(both, kRed, middle, both.height()));
}

}  // namespace
}  // namespace wisp::plot_test
