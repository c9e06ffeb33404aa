#include "capture/vision/survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/statistics.hpp"

namespace wisp {
namespace {

constexpr double kPersistence = 0.6;     // minimum share of the pictures that contain a candidate
constexpr std::size_t kMaxRegions = 24;  // maximum number of regions per picture and level, largest first
constexpr double kStillWorth = 0.15;     // weight of a candidate that never changes shape, relative to a moving one
constexpr double kAloneIsBetter = 0.5;   // weight of a candidate cut from its stand, relative to one that stands alone
constexpr double kLightPower = 8;        // exponent of light: 10 % less luma about halves the likelihood
constexpr double kSolidPower = 4;        // exponent of solidity: a flame has no notches, a merged region has

// One region followed over pictures.
struct Track {
  std::vector<std::size_t> pictures;
  std::vector<BrightRegion> regions;
};

// Continues each track with the region that overlaps the track's last region most.
void continue_tracks(std::vector<Track>& tracks, std::span<const BrightRegion> regions, std::size_t picture) {
  for (Track& track : tracks) {
    double best = 0;
    const BrightRegion* next = nullptr;
    for (const BrightRegion& region : regions) {
      const double shared = shared_share(region.box, track.regions.back().box);
      if (shared <= best) continue;
      best = shared;
      next = &region;
    }
    if (next == nullptr) continue;
    track.pictures.push_back(picture);
    track.regions.push_back(*next);
  }
}

bool taken(const std::vector<Track>& tracks, const BrightRegion& region, std::size_t picture) {
  return std::any_of(tracks.begin(), tracks.end(), [&](const Track& track) {
    return track.pictures.back() == picture && track.regions.back().seed_x == region.seed_x &&
           track.regions.back().seed_y == region.seed_y;
  });
}

std::vector<Track> find_tracks(const PictureGrid& grid, int level) {
  const double count = static_cast<double>(grid.pictures.size());
  RegionFinder finder;
  std::vector<Track> tracks;
  for (std::size_t k = 0; k < grid.pictures.size(); ++k) {
    auto regions = finder.find(grid.view(k), level, 2);
    if (regions.size() > kMaxRegions) regions = regions.first(kMaxRegions);
    continue_tracks(tracks, regions, k);
    if (static_cast<double>(k) > (1 - kPersistence) * count) continue;
    for (const BrightRegion& region : regions) {
      if (!taken(tracks, region, k)) tracks.push_back({{k}, {region}});
    }
  }
  std::erase_if(tracks, [&](const Track& t) { return static_cast<double>(t.pictures.size()) < kPersistence * count; });
  std::stable_sort(tracks.begin(), tracks.end(),
                   [](const Track& a, const Track& b) { return a.pictures.size() > b.pictures.size(); });
  std::vector<Track> apart;  // of tracks that end in the same region, only the longest
  for (Track& track : tracks) {
    if (!taken(apart, track.regions.back(), track.pictures.back())) apart.push_back(std::move(track));
  }
  return apart;
}

// Profile of a region in one picture, and its measures in grid points.
struct Shape {
  std::size_t picture = 0;
  Profile profile;
  double area = 0;
  double middle_across = 0;  // centre of gravity
  double middle_row = 0;
  double tip_across = 0;
  double base_across = 0;
};

double row_centre(const ProfileRow& row) { return 0.5 * (row.low + row.high); }
double row_width(const ProfileRow& row) { return row.width(); }

// Returns the mean of a measure of the rows [from, to).
double mean_rows(double measure(const ProfileRow&), const Profile& profile, std::size_t from, std::size_t to) {
  double sum = 0;
  for (std::size_t k = from; k < to; ++k) sum += measure(profile.rows[k]);
  return sum / static_cast<double>(std::max<std::size_t>(to - from, 1));
}

template <class Measure>
double median_of(const std::vector<Shape>& shapes, Measure measure) {
  std::vector<double> values;
  for (const Shape& shape : shapes) values.push_back(measure(shape));
  return median(std::move(values));
}

void measure(Shape& shape) {
  shape.area = shape.middle_across = shape.middle_row = 0;
  const auto& rows = shape.profile.rows;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    shape.area += row_width(rows[k]);
    shape.middle_across += row_width(rows[k]) * row_centre(rows[k]);
    shape.middle_row += row_width(rows[k]) * static_cast<double>(k);
  }
  shape.middle_across /= shape.area;
  shape.middle_row /= shape.area;
  const std::size_t quarter = std::max<std::size_t>(1, rows.size() / 4);
  shape.tip_across = mean_rows(row_centre, shape.profile, 0, quarter);
  shape.base_across = mean_rows(row_centre, shape.profile, rows.size() - quarter, rows.size());
}

std::vector<Shape> shapes_of(const PictureGrid& grid, int level, const Track& track, BaseSide base) {
  std::vector<Shape> shapes;
  std::vector<PixelPosition> boundary;
  for (std::size_t k = 0; k < track.regions.size(); ++k) {
    const BrightRegion& region = track.regions[k];
    Shape shape{.picture = track.pictures[k], .profile = {}};
    follow_boundary(grid.view(shape.picture), level, {region.seed_x, region.seed_y}, boundary);
    measure_profile(boundary, base, shape.profile);
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

// Cuts off the stand if object and stand have merged in at least half of the pictures. Returns whether it cut any.
bool cut_stands(std::vector<Shape>& shapes) {
  std::vector<std::optional<std::size_t>> cuts;
  std::size_t count = 0;
  for (const Shape& shape : shapes) {
    cuts.push_back(find_shoulder(shape.profile, 0));
    count += cuts.back().has_value();
  }
  if (2 * count < shapes.size()) return false;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    if (cuts[k]) shapes[k].profile.rows.resize(*cuts[k] + 1);
  }
  return true;
}

// Returns the intersection over union of two shapes aligned at their centres of gravity.
double overlap(const Shape& a, const Shape& b) {
  const int down = static_cast<int>(std::lround(b.middle_row - a.middle_row));
  const double aside = b.middle_across - a.middle_across;
  double shared = 0;
  for (std::size_t k = 0; k < a.profile.rows.size(); ++k) {
    const std::ptrdiff_t other = static_cast<std::ptrdiff_t>(k) + down;
    if (other < 0 || other >= static_cast<std::ptrdiff_t>(b.profile.rows.size())) continue;
    const ProfileRow &p = a.profile.rows[k], &q = b.profile.rows[static_cast<std::size_t>(other)];
    shared += std::max(0.0, std::min<double>(p.high, q.high - aside) - std::max<double>(p.low, q.low - aside) + 1);
  }
  return shared / (a.area + b.area - shared);
}

double change_of(const std::vector<Shape>& shapes) {
  std::vector<double> changes;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    changes.push_back(1 - overlap(shapes[k], shapes[(k + shapes.size() / 2) % shapes.size()]));
  }
  return median(std::move(changes));
}

double narrowing_of(const Shape& shape) {
  const std::size_t rows = shape.profile.rows.size();
  const double tip = mean_rows(row_width, shape.profile, 0, std::max<std::size_t>(1, rows / 4));
  const double body = mean_rows(row_width, shape.profile, 2 * rows / 5, std::max(2 * rows / 5 + 1, 4 * rows / 5));
  return std::max(0.0, 1 - tip / body);
}

// Returns the area of a shape over its convex hull's, both after straightening the shape, so that a flame that leans or
// bends has no notches. The hull's widths are then the least concave majorant of the shape's widths.
double solidity_of(const Shape& shape) {
  std::vector<std::size_t> hull;
  const auto width = [&](std::size_t k) { return static_cast<double>(shape.profile.rows[k].width()); };
  double area = 0, hull_area = 0;
  for (std::size_t k = 0; k < shape.profile.rows.size(); ++k) {
    if (k > 0) area += 0.5 * (width(k) + width(k - 1));
    const auto below = [&](std::size_t a, std::size_t b) {  // b, between a and k, is inside the hull
      const double run = static_cast<double>(k - a), part = static_cast<double>(b - a);
      return (width(b) - width(a)) * run <= (width(k) - width(a)) * part;
    };
    while (hull.size() >= 2 && below(hull[hull.size() - 2], hull.back())) hull.pop_back();
    hull.push_back(k);
  }
  for (std::size_t k = 1; k < hull.size(); ++k) {
    hull_area += 0.5 * (width(hull[k]) + width(hull[k - 1])) * static_cast<double>(hull[k] - hull[k - 1]);
  }
  return area / std::max(hull_area, 1e-9);
}

double steadiness_of(const std::vector<Shape>& shapes) {
  constexpr double kGridNoise = 0.3;  // grid points: apparent motion of a still edge
  std::vector<double> tip_across, tip_depth, base_across, base_depth;
  for (const Shape& shape : shapes) {
    tip_across.push_back(shape.tip_across);
    base_across.push_back(shape.base_across);
    tip_depth.push_back(shape.profile.first);
    base_depth.push_back(shape.profile.first + static_cast<double>(shape.profile.rows.size()));
  }
  const double tip = std::hypot(deviation(tip_across), deviation(tip_depth)) + kGridNoise;
  const double base = std::hypot(deviation(base_across), deviation(base_depth)) + kGridNoise;
  return tip / (tip + base);
}

// Returns the median luma of the shape's points above the level; lower levels include more of the dim rim.
double light_of(const PictureGrid& grid, const PictureGrid& luma, int level, const Shape& shape, BaseSide base) {
  const bool rows = base == BaseSide::kBottom || base == BaseSide::kTop;
  std::vector<std::uint8_t> values;
  const ImageView view = grid.view(shape.picture), lumas = luma.view(shape.picture);
  for (std::size_t k = 0; k < shape.profile.rows.size(); ++k) {
    const int at = depth_of(shape.profile.first + static_cast<int>(k), base);
    for (int v = shape.profile.rows[k].low; v <= shape.profile.rows[k].high; ++v) {
      const int x = rows ? v : at, y = rows ? at : v;
      if (view.at(x, y) > level) values.push_back(lumas.at(x, y));
    }
  }
  return median(std::move(values));
}

Region box_of(const Profile& profile, BaseSide base) {
  ProfileRow all = profile.rows.front();
  for (const ProfileRow& row : profile.rows) all = {std::min(all.low, row.low), std::max(all.high, row.high)};
  const int length = static_cast<int>(profile.rows.size());
  const int first = depth_of(profile.first, base), last = depth_of(profile.first + length - 1, base);
  const int begin = std::min(first, last);
  if (base == BaseSide::kBottom || base == BaseSide::kTop) return {all.low, begin, all.width(), length};
  return {begin, all.low, length, all.width()};
}

// Returns the relative likelihood by features of still pictures.
double likeness_of(const Candidate& c, const Evidence& evidence) {
  const double general = c.presence * std::exp(-c.softness) * (c.stands ? kAloneIsBetter : 1);
  if (!evidence.flame) return general * std::sqrt(std::sqrt(c.area));
  // The higher the level, the more lit surroundings can brighten before they exceed it.
  const double room = c.level / 255.0;
  return general * room * std::pow(c.light, kLightPower) * std::pow(c.solidity, kSolidPower) * c.taper;
}

// Returns the relative likelihood by features of movement.
double liveliness_of(const Candidate& c, const Evidence& evidence) {
  const double moves = kStillWorth + (1 - kStillWorth) * std::min(1.0, c.change / kSurelyMoves);
  return moves * std::min(1.0, 2 * (1 - c.change)) * (evidence.flame ? c.steadiness * c.steadiness : 1);
}

}  // namespace

Region usual_place(std::span<const Region> seen) {
  std::array<std::vector<int>, 4> sides;
  for (const Region& box : seen) {
    const std::array<int, 4> now{box.x, box.y, box.right(), box.bottom()};
    for (std::size_t k = 0; k < 4; ++k) sides[k].push_back(now[k]);
  }
  const int left = median(sides[0]), top = median(sides[1]);
  return {left, top, median(sides[2]) - left, median(sides[3]) - top};
}

double shared_share(const Region& a, const Region& b) {
  const double shared = intersection(a, b).area();
  return shared == 0 ? 0 : shared / (a.area() + b.area() - shared);
}

Region PictureGrid::to_pixels(const Region& box) const {
  return intersection({area.x + box.x * step, area.y + box.y * step, box.width * step, box.height * step}, area);
}

PictureGrid grid_over(const Region& area, int most) {
  PictureGrid grid{.area = area, .step = std::max(1, (std::max(area.width, area.height) + most - 1) / most)};
  grid.width = (area.width + grid.step - 1) / grid.step;
  grid.height = (area.height + grid.step - 1) / grid.step;
  return grid;
}

void add_picture(PictureGrid& grid, const Picture& picture, PixelChannel channel, bool dark) {
  std::vector<std::uint8_t> out(grid.size());
  sample_channel(picture, channel, grid.area, grid.step, out.data());
  if (dark) {
    for (std::uint8_t& value : out) value = static_cast<std::uint8_t>(255 - value);
  }
  grid.pictures.push_back(std::move(out));
}

PictureGrid sample_grid(std::span<const Picture> pictures, PixelChannel channel, const Region& area, int most,
                        bool dark) {
  PictureGrid grid = grid_over(area, most);
  for (const Picture& picture : pictures) add_picture(grid, picture, channel, dark);
  return grid;
}

std::vector<Candidate> find_candidates(const PictureGrid& grid, const PictureGrid& luma, int level,
                                       const Evidence& evidence) {
  std::vector<Candidate> found;
  for (const Track& track : find_tracks(grid, level)) {
    std::vector<Shape> shapes = shapes_of(grid, level, track, evidence.base);
    Candidate c;
    c.level = level;
    c.stands = evidence.flame && cut_stands(shapes);
    c.presence = static_cast<double>(shapes.size()) / static_cast<double>(grid.pictures.size());
    std::vector<double> areas, light;
    for (Shape& shape : shapes) {
      measure(shape);
      c.seen.push_back(grid.to_pixels(box_of(shape.profile, evidence.base)));
      c.home = enclosing(c.home, c.seen.back());
      areas.push_back(shape.area * grid.step * grid.step);
      if (evidence.brightest.empty()) continue;
      light.push_back(light_of(grid, luma, level, shape, evidence.base) / evidence.brightest[shape.picture]);
    }
    c.area = median(areas);
    if (!light.empty()) c.light = std::min(1.0, median(light));
    c.change = change_of(shapes);
    c.taper = median_of(shapes, narrowing_of);
    c.solidity = median_of(shapes, solidity_of);
    c.steadiness = steadiness_of(shapes);
    found.push_back(std::move(c));
  }
  return found;
}

void weigh(std::vector<Candidate>& candidates, const std::vector<Candidate>* below, const std::vector<Candidate>* above,
           const Evidence& evidence) {
  // Returns the area of the overlapping candidate at another level; `none` if no candidate overlaps by over a fifth.
  const auto area_in = [](const std::vector<Candidate>* others, const Candidate& c, double none) {
    if (others == nullptr) return c.area;
    double best = 0, area = none;
    for (const Candidate& other : *others) {
      const double shared = shared_share(other.home, c.home);
      if (shared <= best) continue;
      best = shared;
      area = other.area;
    }
    return best > 0.2 ? area : none;
  };
  for (Candidate& c : candidates) {
    const double wider = std::max(area_in(below, c, 2 * c.area), c.area);
    const double narrower = std::min(area_in(above, c, 0), c.area);
    c.softness = (wider - narrower) / c.area;
    c.likeness = likeness_of(c, evidence);
    c.score = c.likeness * liveliness_of(c, evidence);
  }
}

}  // namespace wisp
