#include "capture/vision/region.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

namespace wisp {
namespace {

// Whether `Words` consecutive 8-byte words all equal `eight`.
template <std::size_t Words>
bool all_same(const std::uint8_t* bright, std::uint64_t eight) {
  std::array<std::uint64_t, Words> words;
  std::memcpy(words.data(), bright, sizeof words);
  std::uint64_t different = 0;
  for (const std::uint64_t word : words) different |= word ^ eight;
  return different == 0;
}

// First index at or after `x` whose byte differs from `same`; compares many bytes at a time.
int end_of_stretch(const std::uint8_t* bright, int x, int width, std::uint8_t same) {
  const std::uint64_t eight = same ? 0x0101010101010101ULL : 0;
  while (x + 64 <= width && all_same<8>(bright + x, eight)) x += 64;
  while (x + 8 <= width && all_same<1>(bright + x, eight)) x += 8;
  while (x < width && bright[x] == same) ++x;
  return x;
}

constexpr double kWiderBelow = 1.6;   // minimum ratio of a shoulder's width to the width above it
constexpr double kWithin = 0.05;      // share of the length above a shoulder within which the region widens
constexpr double kSlenderness = 0.7;  // minimum length / width of the part above: a blunt tip widens too

bool along_rows(BaseSide side) { return side == BaseSide::kBottom || side == BaseSide::kTop; }

int towards_base(BaseSide side) { return side == BaseSide::kBottom || side == BaseSide::kRight ? 1 : -1; }

}  // namespace

int RegionFinder::root(int region) {
  while (parent_[region] != region) {
    parent_[region] = parent_[parent_[region]];
    region = parent_[region];
  }
  return region;
}

int RegionFinder::join(int a, int b) {
  a = root(a);
  b = root(b);
  if (a == b) return a;
  if (b < a) std::swap(a, b);
  parent_[b] = a;  // keeps the older region, whose seed is higher
  regions_[a].box = enclosing(regions_[a].box, regions_[b].box);
  regions_[a].area += regions_[b].area;
  return a;
}

void RegionFinder::find_runs(const std::uint8_t* row, int width, int level, std::vector<Run>& runs) {
  const std::uint8_t limit = static_cast<std::uint8_t>(level);
  std::uint8_t* bright = bright_.data();  // a local pointer: otherwise the compiler must reload it after every store
  for (int x = 0; x < width; ++x) bright[x] = row[x] > limit;
  runs.clear();
  for (int x = end_of_stretch(bright, 0, width, 0); x < width;) {
    const int end = end_of_stretch(bright, x, width, 1);
    runs.push_back({x, end, -1});
    x = end_of_stretch(bright, end, width, 0);
  }
}

int RegionFinder::new_region(const Run& run, int y) {
  const int region = static_cast<int>(parent_.size());
  parent_.push_back(region);
  regions_.push_back({.box = {}, .seed_x = run.begin, .seed_y = y});
  return region;
}

void RegionFinder::add(int region, const Run& run, int y) {
  const int length = run.end - run.begin;
  regions_[region].area += length;
  regions_[region].box = enclosing(regions_[region].box, {run.begin, y, length, 1});
}

void RegionFinder::connect(std::vector<Run>& runs, const std::vector<Run>& above, int y) {
  std::size_t first = 0;
  for (Run& run : runs) {
    while (first < above.size() && above[first].end < run.begin) ++first;
    for (std::size_t k = first; k < above.size() && above[k].begin <= run.end; ++k) {
      run.region = run.region < 0 ? root(above[k].region) : join(run.region, above[k].region);
    }
    if (run.region < 0) run.region = new_region(run, y);
    add(run.region, run, y);
  }
}

std::span<const BrightRegion> RegionFinder::find(const ImageView& image, int level, std::int64_t min_area) {
  parent_.clear();
  regions_.clear();
  above_.clear();
  bright_.resize(image.width);
  for (int y = 0; y < image.height; ++y) {
    find_runs(image.row(y), image.width, level, runs_);
    connect(runs_, above_, y);
    std::swap(runs_, above_);
  }
  found_.clear();
  for (std::size_t k = 0; k < regions_.size(); ++k) {
    if (parent_[k] == static_cast<int>(k) && regions_[k].area >= min_area) found_.push_back(regions_[k]);
  }
  std::stable_sort(found_.begin(), found_.end(),
                   [](const BrightRegion& a, const BrightRegion& b) { return a.area > b.area; });
  return found_;
}

void follow_boundary(const ImageView& image, int level, PixelPosition seed, std::vector<PixelPosition>& boundary) {
  // Steps to the eight neighbours, clockwise on the screen from the east.
  constexpr std::array<int, 8> kDx{1, 1, 0, -1, -1, -1, 0, 1};
  constexpr std::array<int, 8> kDy{0, 1, 1, 1, 0, -1, -1, -1};
  const auto bright = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < image.width && y < image.height && image.at(x, y) > level;
  };
  assert(bright(seed.x, seed.y));
  boundary.clear();
  PixelPosition at = seed;
  int from = 5;  // the neighbour north-west of the seed is dark, as are all above and to the left
  int first_step = -1;
  while (true) {
    int step = -1;
    for (int turn = 1; turn <= 8 && step < 0; ++turn) {
      const int direction = (from + turn) & 7;
      if (bright(at.x + kDx[direction], at.y + kDy[direction])) step = direction;
    }
    if (at == seed && step == first_step && !boundary.empty()) return;
    if (boundary.empty()) first_step = step;
    boundary.push_back(at);
    if (step < 0) return;  // a single pixel
    at = {at.x + kDx[step], at.y + kDy[step]};
    from = (step + ((step & 1) == 0 ? 6 : 5)) & 7;  // the last dark pixel examined, relative to the new position
  }
}

int depth_of(int edge, BaseSide side) { return towards_base(side) * edge; }

int base_edge(const Region& box, BaseSide side) {
  if (side == BaseSide::kLeft) return box.x;
  if (side == BaseSide::kTop) return box.y;
  return (side == BaseSide::kRight ? box.right() : box.bottom()) - 1;
}

int deeper(int edge, int other, BaseSide side) { return (edge - other) * towards_base(side); }

Region above_edge(const Region& place, int edge, BaseSide side) {
  if (side == BaseSide::kLeft) return {edge, place.y, place.right() - edge, place.height};
  if (side == BaseSide::kTop) return {place.x, edge, place.width, place.bottom() - edge};
  if (side == BaseSide::kRight) return {place.x, place.y, edge + 1 - place.x, place.height};
  return {place.x, place.y, place.width, edge + 1 - place.y};
}

void measure_profile(std::span<const PixelPosition> boundary, BaseSide side, Profile& profile) {
  profile.rows.clear();
  if (boundary.empty()) return;
  const auto depth = [&](const PixelPosition& p) { return depth_of(along_rows(side) ? p.y : p.x, side); };
  const auto across = [&](const PixelPosition& p) { return along_rows(side) ? p.x : p.y; };
  int first = depth(boundary.front()), last = first;
  for (const PixelPosition& p : boundary) {
    first = std::min(first, depth(p));
    last = std::max(last, depth(p));
  }
  profile.first = first;
  profile.rows.assign(static_cast<std::size_t>(last - first) + 1, {1 << 30, -(1 << 30)});
  for (const PixelPosition& p : boundary) {
    ProfileRow& row = profile.rows[static_cast<std::size_t>(depth(p) - first)];
    row.low = std::min(row.low, across(p));
    row.high = std::max(row.high, across(p));
  }
}

std::optional<std::size_t> find_shoulder(const Profile& profile, std::size_t from) {
  const auto& rows = profile.rows;
  // Returns the factor by which the region widens just below row k; 0 if this is no shoulder.
  const auto step = [&](std::size_t k) {
    const std::size_t within = std::max<std::size_t>(2, static_cast<std::size_t>(kWithin * static_cast<double>(k)));
    int below = 0;
    for (std::size_t j = k + 1; j < std::min(rows.size(), k + 1 + within); ++j) {
      below = std::max(below, rows[j].width());
    }
    const int width = rows[k].width();
    return below < std::max<double>(kWiderBelow * width, width + kMinStep) ? 0 : static_cast<double>(below) / width;
  };
  std::optional<std::size_t> best;
  double sharpest = 0;
  int widest = 0;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    widest = std::max(widest, rows[k].width());
    if (k < from || k < kMinStep || static_cast<double>(k + 1) < kSlenderness * widest) continue;
    if (step(k) <= sharpest) continue;
    sharpest = step(k);
    best = k;
  }
  // Moves up to the first of the consecutive rows that widen.
  while (best && *best > from && step(*best - 1) > 0) --*best;
  return best;
}

}  // namespace wisp
