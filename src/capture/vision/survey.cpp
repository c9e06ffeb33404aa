#include "capture/vision/survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/statistics.hpp"

namespace wisp {
namespace {

constexpr int kGrid = 320;                // width and height of the coarse grid, points: enough to separate regions
constexpr int kFineGrid = 160;            // width and height of the finer grid around the object, points
constexpr int kLevelStep = 18;            // step between the levels tried, of 255
constexpr int kHighestLevel = 225;        // a higher level would cut through the flame, as cameras clip above it
constexpr double kLitShare = 0.7;         // minimum brightest_of() of a surveyed picture, share of the upper quartile
constexpr double kOtherScene = 64;        // maximum mean difference of a surveyed picture from the median picture
constexpr double kAsLikely = 0.35;        // minimum score of another flame relative to the first
constexpr double kAsGood = 0.5;           // minimum relative likeness of the object at another level
constexpr double kHalfWay = 0.58;         // position of the level between surroundings (0) and object (1)
constexpr double kNearlyAsLikely = 0.75;  // minimum relative likeness of a view that shows more of the flame
constexpr double kBrightest = 3e-4;       // share of the picture's points that count as brightest

// Pictures over one area, one grid per channel, sampled once for repeated use.
struct Grids {
  std::array<std::optional<PictureGrid>, 4> channels;
  const PictureGrid* of(PixelChannel channel) const {
    const auto& grid = channels[static_cast<std::size_t>(channel)];
    return grid ? &*grid : nullptr;
  }
};

constexpr std::array<PixelChannel, 4> kChannels{PixelChannel::kLuma, PixelChannel::kRed, PixelChannel::kGreen,
                                                PixelChannel::kBlue};

bool wanted(PixelChannel channel, const Picture& picture, const SurveyOptions& options) {
  return options.channel ? channel == *options.channel : has_channel(picture, channel);
}

Grids sample_all(std::span<const Picture> pictures, const Region& area, int most, const SurveyOptions& options) {
  Grids grids;
  for (const PixelChannel channel : kChannels) {
    if (!wanted(channel, pictures.front(), options) && channel != PixelChannel::kLuma) continue;
    grids.channels[static_cast<std::size_t>(channel)] = grid_over(area, most);
  }
  // Samples all channels of a picture before the next picture, as the cache holds only one picture.
  for (const Picture& picture : pictures) {
    for (const PixelChannel channel : kChannels) {
      auto& grid = grids.channels[static_cast<std::size_t>(channel)];
      if (grid) add_picture(*grid, picture, channel, options.dark);
    }
  }
  return grids;
}

// Returns the level that only the brightest points reach: kBrightest of all points, at least four.
double brightest_of(const ImageView& luma) {
  Histogram histogram{};
  add_to_histogram(histogram, luma);
  const double points = static_cast<double>(luma.width) * luma.height;
  const double enough = std::max(4.0, kBrightest * points);
  double count = 0;
  int level = 255;
  while (level > 1 && (count += static_cast<double>(histogram[static_cast<std::size_t>(level)])) < enough) --level;
  return level;
}

// Returns the mean absolute difference of each picture from the median picture; large for titles and other shots.
std::vector<double> distances_from_usual(const PictureGrid& luma) {
  std::vector<double> distances(luma.pictures.size());
  std::vector<std::uint8_t> values(luma.pictures.size());
  for (std::size_t at = 0; at < luma.size(); ++at) {
    std::transform(luma.pictures.begin(), luma.pictures.end(), values.begin(), [at](const auto& p) { return p[at]; });
    const int usual = median(values);
    for (std::size_t k = 0; k < distances.size(); ++k) distances[k] += std::abs(luma.pictures[k][at] - usual);
  }
  for (double& distance : distances) distance /= static_cast<double>(luma.size());
  return distances;
}

// The surveyed pictures, without fades, titles and pictures after the flame went out; and each one's brightest_of().
struct LitPictures {
  std::vector<Picture> pictures;
  std::vector<double> brightest;
};

// Selects the pictures to survey, and removes the others from the grids.
LitPictures lit_pictures(std::span<const Picture> pictures, Grids& grids) {
  const PictureGrid& luma = *grids.of(PixelChannel::kLuma);
  std::vector<double> brightest;
  for (std::size_t k = 0; k < pictures.size(); ++k) brightest.push_back(brightest_of(luma.view(k)));
  std::vector<double> sorted = brightest;
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[sorted.size() - 1 - sorted.size() / 4];
  const std::vector<double> distance = distances_from_usual(luma);
  LitPictures lit;
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    if (brightest[k] < kLitShare * usual || distance[k] > kOtherScene) {
      out.push_back(k);
      continue;
    }
    lit.pictures.push_back(pictures[k]);
    lit.brightest.push_back(brightest[k]);
  }
  for (auto& grid : grids.channels) {
    for (std::size_t k = out.size(); grid && k-- > 0;) {
      grid->pictures.erase(grid->pictures.begin() + static_cast<std::ptrdiff_t>(out[k]));
    }
  }
  return lit;
}

std::vector<Candidate> scan_levels(const PictureGrid& grid, const PictureGrid& luma, PixelChannel channel,
                                   const Picture& format, const Evidence& evidence) {
  std::vector<std::vector<Candidate>> levels;
  // One level more than can be chosen: the area left at that level shows how steep the rim is at the level below.
  for (int level = 2 * kLevelStep; brightness(format, channel, level) < kHighestLevel + kLevelStep;
       level += kLevelStep) {
    levels.push_back(find_candidates(grid, luma, level, evidence));
    for (Candidate& candidate : levels.back()) candidate.channel = channel;
  }
  std::vector<Candidate> found;
  for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
    weigh(levels[k], k == 0 ? nullptr : &levels[k - 1], &levels[k + 1], evidence);
  }
  levels.pop_back();
  for (auto& level : levels) std::move(level.begin(), level.end(), std::back_inserter(found));
  return found;
}

// Finds candidates of all channels and levels, likeliest first.
std::vector<Candidate> scan(const Grids& grids, const Picture& format, const SurveyOptions& options,
                            const Evidence& evidence) {
  std::vector<Candidate> found;
  for (const PixelChannel channel : kChannels) {
    if (!wanted(channel, format, options)) continue;
    auto more = scan_levels(*grids.of(channel), *grids.of(PixelChannel::kLuma), channel, format, evidence);
    std::move(more.begin(), more.end(), std::back_inserter(found));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  return found;
}

bool same_place(const Candidate& a, const Candidate& b) {
  return !intersection(usual_place(a.seen), usual_place(b.seen)).empty();
}

// Returns the likeliest candidate and, of its channel and level, the candidates that are nearly as likely, bright and
// mobile, largest first: the other flames, but no lit surroundings and no lamps.
std::vector<Candidate> places(const std::vector<Candidate>& candidates, const SurveyOptions& options) {
  std::vector<Candidate> out;
  const Candidate& best = candidates.front();
  for (const Candidate& c : candidates) {
    if (c.channel != best.channel || c.level != best.level) continue;
    if (c.score < kAsLikely * best.score || c.light < kAsBright * best.light) continue;
    if (c.change < std::min(kSurelyMoves, 0.5 * best.change)) continue;  // a lamp seen by a hand-held camera
    if (std::none_of(out.begin(), out.end(), [&](const Candidate& other) { return same_place(c, other); })) {
      out.push_back(c);
    }
    if (options.flame == 0) break;
  }
  std::stable_sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) { return a.area > b.area; });
  return out;
}

// Brightness of an object (median) and of its surroundings (upper quartile, as their bright parts may brighten).
struct Brightness {
  double inside = 0;
  double outside = 0;
};

std::optional<Brightness> brightness_of(const Candidate& thing, std::span<const Picture> pictures, const Region& area,
                                        bool dark) {
  const Region box = intersection(grown(thing.home, std::max(thing.home.width, thing.home.height) / 8 + 2), area);
  const PictureGrid grid = sample_grid(pictures, thing.channel, box, kFineGrid, dark);
  std::vector<double> inside, outside;
  for (const auto& picture : grid.pictures) {
    for (const std::uint8_t value : picture) (value > thing.level ? inside : outside).push_back(value);
  }
  if (inside.empty() || outside.empty()) return std::nullopt;
  const auto quarter = outside.begin() + static_cast<std::ptrdiff_t>(3 * outside.size() / 4);
  std::nth_element(outside.begin(), quarter, outside.end());
  return Brightness{median(std::move(inside)), *quarter};
}

// Returns a level slightly above halfway between the brightness of the surroundings and of the object. There the
// object's area depends little on the rim's blur, and the glow, which is darker, is excluded.
int half_way(const Brightness& bright) {
  return static_cast<int>(bright.outside + kHalfWay * (bright.inside - bright.outside));
}

// Returns the object found at the level nearest to `wanted`, and moves its level to `wanted` by at most half a step.
Candidate settle_level(const Candidate& thing, const std::vector<Candidate>& candidates, int wanted) {
  Candidate best = thing;
  for (const Candidate& c : candidates) {
    if (c.channel != thing.channel || c.stands != thing.stands || c.likeness < kAsGood * thing.likeness) continue;
    if (c.seen.size() < thing.seen.size() || shared_share(c.home, thing.home) < kSamePlace) continue;
    if (std::abs(c.level - wanted) < std::abs(best.level - wanted)) best = c;
  }
  best.level = std::clamp(wanted, best.level - kLevelStep / 2, best.level + kLevelStep / 2);
  return best;
}

// Returns whether a candidate shows the object as well as `thing` does. Motion is not compared: a part of an object
// moves more than the whole, and the measured motion of a nearly still flame is random.
bool as_good(const Candidate& c, const Candidate& thing) {
  return c.stands == thing.stands && c.likeness >= kNearlyAsLikely * thing.likeness && c.softness <= thing.softness &&
         c.seen.size() >= thing.seen.size();
}

Candidate settled(const Candidate& thing, const std::vector<Candidate>& candidates, std::span<const Picture> pictures,
                  const Region& area, bool dark) {
  const auto bright = brightness_of(thing, pictures, area, dark);
  Candidate out = settle_level(thing, candidates, bright ? half_way(*bright) : thing.level);
  if (bright) out.contrast = bright->inside - bright->outside;
  return out;
}

// Returns, for each channel, the likeliest candidate near `home` that is as_good() as `thing`; null: none.
std::array<const Candidate*, 4> views_of(const Candidate& thing, const Region& home,
                                         const std::vector<Candidate>& candidates) {
  std::array<const Candidate*, 4> views{};
  for (const Candidate& c : candidates) {
    if (!as_good(c, thing) || shared_share(c.home, home) < kSamePlace) continue;
    const Candidate*& view = views[static_cast<std::size_t>(c.channel)];
    if (view == nullptr || c.likeness > view->likeness) view = &c;
  }
  return views;
}

// Returns the object at its level in the channel that shows the largest area of it: other channels may show only the
// bright core of a flame, or a foot split by the wick. as_good() excludes glow and wax, which have softer rims. The
// search is repeated from each larger view, as a view of the core overlaps little with the whole flame.
Candidate whole(const Candidate& thing, const std::vector<Candidate>& candidates, std::span<const Picture> pictures,
                const Region& area, bool dark) {
  Candidate best = settled(thing, candidates, pictures, area, dark);
  for (bool larger = true; larger;) {
    larger = false;
    for (const Candidate* view : views_of(thing, best.home, candidates)) {
      if (view == nullptr || view->channel == best.channel) continue;
      Candidate other = settled(*view, candidates, pictures, area, dark);
      if (other.area <= best.area) continue;
      best = std::move(other);
      larger = true;
    }
  }
  return best;
}

// Finds the object again on a finer grid, unless it is too large for one. Returns it in its best channel and level.
Candidate refine(const Candidate& coarse, const std::vector<Candidate>& all, std::span<const Picture> pictures,
                 const Region& area, const SurveyOptions& options, const Evidence& evidence) {
  const Region around = intersection(grown(coarse.home, std::max(coarse.home.width, coarse.home.height) / 2 + 2), area);
  const bool finer = std::max(around.width, around.height) < std::max(area.width, area.height) / 2;
  const std::vector<Candidate> fine =
      finer ? scan(sample_all(pictures, around, kFineGrid, options), pictures.front(), options, evidence) : all;
  const auto found = std::find_if(fine.begin(), fine.end(), [&](const Candidate& c) { return same_place(c, coarse); });
  return whole(found == fine.end() || !finer ? coarse : *found, fine, pictures, area, options.dark);
}

// Returns the share of an object that is saturated: in every channel at most 5 levels (errors of coding) below the
// channel's 90th percentile within the object, as tone curves may saturate below white.
double flat_share(const Candidate& thing, std::span<const Picture> pictures, bool dark) {
  const PictureGrid own = sample_grid(pictures, thing.channel, thing.home, kFineGrid, dark);
  std::vector<std::uint8_t> flat;  // flags of the object's points
  for (const PixelChannel channel : kChannels) {
    const bool grey = !has_channel(pictures.front(), PixelChannel::kRed);
    if (grey != (channel == PixelChannel::kLuma)) continue;
    const PictureGrid grid = sample_grid(pictures, channel, thing.home, kFineGrid, dark);
    std::vector<int> inside;
    for (std::size_t k = 0; k < own.pictures.size(); ++k) {
      for (std::size_t at = 0; at < own.size(); ++at) {
        if (own.pictures[k][at] > thing.level) inside.push_back(grid.pictures[k][at]);
      }
    }
    const int high = quantile(inside, 0.9);
    flat.resize(inside.size(), 1);
    for (std::size_t k = 0; k < inside.size(); ++k) flat[k] &= inside[k] >= high - 5;
  }
  const auto count = static_cast<double>(std::count(flat.begin(), flat.end(), 1));
  return dark || flat.empty() ? 0 : count / static_cast<double>(flat.size());
}

Survey describe(const Candidate& thing, std::span<const Picture> pictures, const Grids& grids, bool dark) {
  Survey out{thing};
  out.clipped = flat_share(thing, pictures, dark);
  const PictureGrid& grid = *grids.of(thing.channel);
  for (std::size_t k = 0; k < grid.pictures.size(); ++k) add_to_histogram(out.histogram, grid.view(k));
  return out;
}

// Returns whether any part of a picture exceeds its darkest tenth by more than noise.
bool has_contrast(const Grids& grids, const Picture& format, const SurveyOptions& options) {
  return std::any_of(kChannels.begin(), kChannels.end(), [&](PixelChannel channel) {
    if (!wanted(channel, format, options)) return false;
    const PictureGrid& grid = *grids.of(channel);
    for (std::size_t k = 0; k < grid.pictures.size(); ++k) {
      if (brightest_of(grid.view(k)) - quantile(grid.pictures[k], 0.1) >= kNoise) return true;
    }
    return false;
  });
}

Error nothing_found(bool dark) {
  return Error{std::string("nothing ") + (dark ? "dark" : "bright") +
               " stands out: the picture has one brightness only; expected " +
               (dark ? "a dark thing on a light ground" : "a bright thing on a dark ground")};
}

// Returns the end that moves less if the object is at least 1.5 times as wide as high; else the bottom.
BaseSide steady_end(const Survey& survey) {
  std::vector<double> left, right;
  double width = 0, height = 0;
  for (const Region& box : survey.seen) {
    left.push_back(box.x);
    right.push_back(box.right());
    width += box.width;
    height += box.height;
  }
  if (width < 1.5 * height || deviation(left) == deviation(right)) return BaseSide::kBottom;
  return deviation(left) < deviation(right) ? BaseSide::kLeft : BaseSide::kRight;
}

}  // namespace

void add_to_histogram(Histogram& histogram, const ImageView& image) {
  // Four histograms alternate: neighbouring pixels are mostly equal, so each increment would wait for the one before.
  std::array<std::array<std::uint32_t, 256>, 4> counts{};
  for (int y = 0; y < image.height; ++y) {
    const std::uint8_t* row = image.row(y);
    for (int x = 0; x < image.width; ++x) ++counts[x & 3][row[x]];
  }
  for (const auto& count : counts) {
    for (int v = 0; v < 256; ++v) histogram[v] += count[v];
  }
}

Result<Survey> survey_scene(std::span<const Picture> pictures, const SurveyOptions& options) {
  const Region area = options.region.empty() ? pictures.front().frame() : options.region;
  Grids grids = sample_all(pictures, area, kGrid, options);
  if (!has_contrast(grids, pictures.front(), options)) return nothing_found(options.dark);
  const bool flame = options.flame > 0 && !options.dark;
  const LitPictures lit =
      options.dark ? LitPictures{{pictures.begin(), pictures.end()}, {}} : lit_pictures(pictures, grids);
  const Evidence evidence{.flame = flame, .base = BaseSide::kBottom, .brightest = lit.brightest};
  const std::vector<Candidate> all = scan(grids, pictures.front(), options, evidence);
  if (all.empty()) return nothing_found(options.dark);
  const std::vector<Candidate> things = places(all, options);
  const auto asked = static_cast<std::size_t>(std::max(options.flame, 1));
  const std::size_t which = flame && asked <= things.size() ? asked - 1 : 0;
  const Candidate found = refine(things[which], all, lit.pictures, area, options, evidence);
  Survey survey = describe(found, lit.pictures, grids, options.dark);
  if (!flame) return survey;
  survey.flames = static_cast<int>(things.size());
  for (std::size_t k = 0; k < things.size(); ++k) {
    if (k != which) survey.others.push_back(usual_place(things[k].seen));
  }
  return survey;
}

BaseSide base_side(const Survey& survey, const Region& area) {
  std::array<double, 4> cut{};
  for (const Region& box : survey.seen) {
    const double share = 1.0 / static_cast<double>(survey.seen.size());
    if (box.bottom() >= area.bottom()) cut[static_cast<int>(BaseSide::kBottom)] += share;
    if (box.x <= area.x) cut[static_cast<int>(BaseSide::kLeft)] += share;
    if (box.y <= area.y) cut[static_cast<int>(BaseSide::kTop)] += share;
    if (box.right() >= area.right()) cut[static_cast<int>(BaseSide::kRight)] += share;
  }
  if (cut[static_cast<int>(BaseSide::kBottom)] >= 0.5) return BaseSide::kBottom;
  for (const BaseSide side : {BaseSide::kLeft, BaseSide::kRight, BaseSide::kTop}) {
    if (cut[static_cast<int>(side)] >= 0.95) return side;
  }
  return steady_end(survey);
}

}  // namespace wisp
