#include "wisp/capture/vision/survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "wisp/capture/vision/region.hpp"

namespace wisp {
namespace {

constexpr int kGridWidth = 240;        // the coarse grid is about this wide and high: enough to tell regions apart
constexpr double kLitShare = 0.85;     // a picture counts when its contrast is this share of the upper quartile
constexpr double kChangeShare = 0.25;  // a grid point moves when its range is this share of the clusters' distance
constexpr double kPersistence = 0.6;   // the thing is there in this share of the pictures
constexpr double kLeastContrast = 12;  // levels between the clusters, of 255: less is noise of one brightness

// All pictures on a coarse grid.
struct Grid {
  int step = 1;
  int width = 0;
  int height = 0;
  std::vector<std::vector<std::uint8_t>> pictures;
  std::size_t size() const { return static_cast<std::size_t>(width) * height; }
};

Grid sample(std::span<const Picture> pictures, PixelChannel channel, const Region& area, bool dark) {
  Grid grid;
  grid.step = std::max(1, std::max(area.width, area.height) / kGridWidth);
  grid.width = (area.width + grid.step - 1) / grid.step;
  grid.height = (area.height + grid.step - 1) / grid.step;
  for (const Picture& picture : pictures) {
    std::vector<std::uint8_t> out(grid.size());
    sample_channel(picture, channel, area, grid.step, out.data());
    if (dark) {
      for (std::uint8_t& value : out) value = static_cast<std::uint8_t>(255 - value);
    }
    grid.pictures.push_back(std::move(out));
  }
  return grid;
}

ImageView view(const Grid& grid, const std::vector<std::uint8_t>& picture) {
  return {picture.data(), grid.width, grid.height, grid.width};
}

// The pictures that count, and their histogram.
struct LitPictures {
  std::vector<std::size_t> which;
  Histogram histogram{};
};

// Pictures of a fade would pull the level down.
LitPictures lit_pictures(const Grid& grid) {
  std::vector<double> contrast;
  std::vector<Histogram> histograms(grid.pictures.size());
  for (std::size_t k = 0; k < grid.pictures.size(); ++k) {
    add_to_histogram(histograms[k], view(grid, grid.pictures[k]), 1);
    const TwoClusters clusters = split_histogram(histograms[k]);
    contrast.push_back(clusters.bright_mean - clusters.dark_mean);
  }
  std::vector<double> sorted = contrast;
  const std::size_t usual = sorted.size() - 1 - sorted.size() / 4;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(usual), sorted.end());
  LitPictures lit;
  for (std::size_t k = 0; k < contrast.size(); ++k) {
    if (contrast[k] < kLitShare * sorted[usual]) continue;
    lit.which.push_back(k);
    for (int v = 0; v < 256; ++v) lit.histogram[v] += histograms[k][v];
  }
  return lit;
}

struct Extent {
  std::vector<std::uint8_t> lowest;
  std::vector<std::uint8_t> highest;
};

Extent extent(const Grid& grid, std::span<const std::size_t> lit) {
  Extent out{std::vector<std::uint8_t>(grid.size(), 255), std::vector<std::uint8_t>(grid.size(), 0)};
  for (const std::size_t k : lit) {
    const auto& picture = grid.pictures[k];
    for (std::size_t i = 0; i < picture.size(); ++i) {
      out.lowest[i] = std::min(out.lowest[i], picture[i]);
      out.highest[i] = std::max(out.highest[i], picture[i]);
    }
  }
  return out;
}

// How a region of "ever bright" grid points behaves. Counted over its box: boxes of different things rarely overlap.
struct Behaviour {
  double motion = 0;      // moving grid points
  double presence = 0;    // share of lit pictures with a bright point
  double moving_rim = 0;  // share of its rim, in each picture, that lies on moving points
};

bool on_rim(const ImageView& image, int level, int x, int y) {
  if (image.at(x, y) <= level) return false;
  return (x > 0 && image.at(x - 1, y) <= level) || (x + 1 < image.width && image.at(x + 1, y) <= level) ||
         (y > 0 && image.at(x, y - 1) <= level) || (y + 1 < image.height && image.at(x, y + 1) <= level);
}

Behaviour behaviour(const Grid& grid, std::span<const std::size_t> lit, int level, const Region& box,
                    const std::vector<std::uint8_t>& moving) {
  Behaviour out;
  std::int64_t rim = 0, rim_moving = 0, present = 0;
  for (int y = box.y; y < box.bottom(); ++y) {
    for (int x = box.x; x < box.right(); ++x) out.motion += moving[static_cast<std::size_t>(y) * grid.width + x];
  }
  for (const std::size_t k : lit) {
    const ImageView image = view(grid, grid.pictures[k]);
    bool any = false;
    for (int y = box.y; y < box.bottom(); ++y) {
      for (int x = box.x; x < box.right(); ++x) {
        if (image.at(x, y) <= level) continue;
        any = true;
        if (!on_rim(image, level, x, y)) continue;
        ++rim;
        rim_moving += moving[static_cast<std::size_t>(y) * grid.width + x];
      }
    }
    present += any;
  }
  out.presence = static_cast<double>(present) / static_cast<double>(lit.size());
  out.moving_rim = rim == 0 ? 0 : static_cast<double>(rim_moving) / static_cast<double>(rim);
  return out;
}

Region to_pixels(const Grid& grid, const Region& box, const Region& area) {
  const Region out{area.x + box.x * grid.step, area.y + box.y * grid.step, box.width * grid.step,
                   box.height * grid.step};
  return intersection(grown(out, grid.step), area);
}

// Of the thing and what is just around it.
Histogram histogram_around(const Grid& grid, std::span<const std::size_t> lit, const Region& box) {
  const Region around =
      intersection(grown(box, std::max(box.width, box.height) / 4 + 1), {0, 0, grid.width, grid.height});
  Histogram histogram{};
  for (const std::size_t k : lit) add_to_histogram(histogram, crop(view(grid, grid.pictures[k]), around), 1);
  return histogram;
}

// The thing's box in each lit picture: the largest region where its home is.
std::vector<Region> sightings(const Grid& grid, std::span<const std::size_t> lit, const Survey& survey,
                              const Region& area) {
  RegionFinder finder;
  std::vector<Region> seen;
  for (const std::size_t k : lit) {
    for (const BrightRegion& region : finder.find(view(grid, grid.pictures[k]), survey.level, 1)) {
      const Region box = to_pixels(grid, region.box, area);
      if (intersection(box, survey.home).empty()) continue;
      seen.push_back(box);
      break;
    }
  }
  return seen;
}

std::optional<Survey> judge(const Grid& grid, PixelChannel channel, const Region& area) {
  Survey out;
  out.channel = channel;
  const LitPictures lit_ones = lit_pictures(grid);
  const std::span<const std::size_t> lit = lit_ones.which;
  out.histogram = lit_ones.histogram;
  const TwoClusters clusters = split_histogram(out.histogram);
  const double contrast = clusters.bright_mean - clusters.dark_mean;
  if (contrast < kLeastContrast) return std::nullopt;
  out.separation = clusters.separation;
  const Extent range = extent(grid, lit);
  std::vector<std::uint8_t> moving(grid.size());
  for (std::size_t i = 0; i < moving.size(); ++i) {
    moving[i] = range.highest[i] - range.lowest[i] > kChangeShare * contrast;
  }
  RegionFinder finder;
  const auto regions = finder.find(view(grid, range.highest), clusters.threshold, 1);
  const BrightRegion* thing = nullptr;
  Behaviour best;
  for (const BrightRegion& region : regions) {
    const Behaviour b = behaviour(grid, lit, clusters.threshold, region.box, moving);
    if (b.moving_rim < 0.05) out.still.push_back(to_pixels(grid, region.box, area));
    if (b.presence < kPersistence) continue;
    if (thing != nullptr && b.motion <= best.motion) continue;
    thing = &region;
    best = b;
  }
  if (thing == nullptr) return std::nullopt;
  out.level = clusters.threshold;
  out.steepest_level = steepest_level(histogram_around(grid, lit, thing->box), clusters);
  out.home = to_pixels(grid, thing->box, area);
  out.moves = best.motion > 0;
  std::erase(out.still, out.home);
  out.seen = sightings(grid, lit, out, area);
  return out;
}

}  // namespace

Result<std::vector<Survey>> survey_scene(std::span<const Picture> pictures, const SurveyOptions& options) {
  const Region area = options.region.empty() ? pictures.front().frame() : options.region;
  std::vector<Survey> found;
  for (const PixelChannel channel :
       {PixelChannel::kLuma, PixelChannel::kRed, PixelChannel::kGreen, PixelChannel::kBlue}) {
    if (options.channel ? channel != *options.channel : !has_channel(pictures.front(), channel)) continue;
    auto survey = judge(sample(pictures, channel, area, options.dark), channel, area);
    if (survey) found.push_back(std::move(*survey));
  }
  if (found.empty()) {
    return Error{std::string("nothing ") + (options.dark ? "dark" : "bright") +
                 " stands out: the picture has one brightness only; expected " +
                 (options.dark ? "a dark thing on a light ground" : "a bright thing on a dark ground")};
  }
  return found;
}

namespace {

// Mean distance of values from their mean.
double spread(std::span<const double> values) {
  double mean = 0, away = 0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) away += std::abs(value - mean) / static_cast<double>(values.size());
  return away;
}

// Of a thing that is mostly wider than high, the end that moves less is where it is held.
BaseSide steady_end(const Survey& survey) {
  constexpr double kLying = 1.5;
  std::vector<double> left, right;
  double width = 0, height = 0;
  for (const Region& box : survey.seen) {
    left.push_back(box.x);
    right.push_back(box.right());
    width += box.width;
    height += box.height;
  }
  if (width < kLying * height || spread(left) == spread(right)) return BaseSide::kBottom;
  return spread(left) < spread(right) ? BaseSide::kLeft : BaseSide::kRight;
}

}  // namespace

BaseSide base_side(const Survey& survey, const Region& area) {
  constexpr double kMostPictures = 0.5, kNearlyAll = 0.95;
  std::array<double, 4> cut{};
  for (const Region& box : survey.seen) {
    const double share = 1.0 / static_cast<double>(survey.seen.size());
    if (box.bottom() >= area.bottom()) cut[static_cast<int>(BaseSide::kBottom)] += share;
    if (box.x <= area.x) cut[static_cast<int>(BaseSide::kLeft)] += share;
    if (box.y <= area.y) cut[static_cast<int>(BaseSide::kTop)] += share;
    if (box.right() >= area.right()) cut[static_cast<int>(BaseSide::kRight)] += share;
  }
  if (cut[static_cast<int>(BaseSide::kBottom)] >= kMostPictures) return BaseSide::kBottom;
  for (const BaseSide side : {BaseSide::kLeft, BaseSide::kRight, BaseSide::kTop}) {
    if (cut[static_cast<int>(side)] >= kNearlyAll) return side;
  }
  return steady_end(survey);
}

}  // namespace wisp
