#include "capture/vision/outline_seeker.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "capture/vision/waist.hpp"

namespace wisp {
namespace {

constexpr int kLeastMargin = 8;          // pixels around the place where the thing was
constexpr double kMarginPace = 1.5;      // … and this many times how far it moved in the last frames
constexpr double kPaceMemory = 0.8;      // what is remembered of that from frame to frame
constexpr double kLeastAreaShare = 0.1;  // of its usual area: less is a spark or what is left after it went out
constexpr int kLeastArea = 24;           // pixels

constexpr double kJumpShare = 0.03;  // of its length: reaching suddenly deeper than that, it may have run together
constexpr int kLeastJump = 3;        // … with what it stands on; pixels

double area_of(const Region& region) { return static_cast<double>(region.width) * region.height; }

}  // namespace

OutlineSeeker::OutlineSeeker(const Survey& survey, const Region& area, BaseSide base, bool dark)
    : channel_(survey.channel),
      level_(survey.level),
      base_(base),
      dark_(dark),
      area_(area),
      home_(survey.home),
      still_(survey.still),
      base_edge_(wisp::base_edge(survey.home, base)) {
  // What the thing only now and then runs together with does not count: the middle one of the pictures.
  std::vector<int> edges;
  for (const Region& box : survey.seen) edges.push_back(wisp::base_edge(box, base));
  if (edges.empty()) return;
  std::nth_element(edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2), edges.end());
  base_edge_ = edges[edges.size() / 2];
}

OutlineSeeker::Window OutlineSeeker::open(const Picture& picture, const Region& place) {
  const ImageView direct = plane_in_place(picture, channel_);
  if (direct.pixels != nullptr && !dark_) return {place, crop(direct, place)};
  plane_.resize(static_cast<std::size_t>(place.width) * place.height);
  extract_channel(picture, channel_, place, plane_.data());
  if (dark_) {
    for (std::uint8_t& value : plane_) value = static_cast<std::uint8_t>(255 - value);
  }
  return {place, {plane_.data(), place.width, place.height, place.width}};
}

bool OutlineSeeker::still(const Region& box) const {
  return std::any_of(still_.begin(), still_.end(),
                     [&](const Region& region) { return area_of(intersection(region, box)) > 0.8 * area_of(box); });
}

// Nearest to what was there before: the overlap of boxes times the area.
bool OutlineSeeker::choose(std::span<const BrightRegion> regions, const Region& place) {
  const Region expected = following_ ? found_.box : home_;
  double best = 0;
  for (const BrightRegion& region : regions) {
    if (static_cast<double>(region.area) < kLeastAreaShare * usual_area_) continue;
    BrightRegion moved = region;
    moved.box.x += place.x;
    moved.box.y += place.y;
    if (!following_ && still(moved.box)) continue;
    const double shared = area_of(intersection(moved.box, expected));
    const double likeness = (shared + 1) / (area_of(moved.box) + area_of(expected) - shared);
    const double score = static_cast<double>(region.area) * likeness;
    if (score <= best) continue;
    best = score;
    moved.centre_x += place.x;
    moved.centre_y += place.y;
    moved.seed_x += place.x;
    moved.seed_y += place.y;
    found_ = moved;
  }
  return best > 0;
}

// Looks inside `place`, and farther on the sides where the thing reaches out of it.
bool OutlineSeeker::find_in(const Picture& picture, Region place) {
  int farther = margin();
  while (true) {
    place = intersection(place, area_);
    if (place.empty()) return false;
    window_ = open(picture, place);
    if (!choose(finder_.find(window_.image, level_, kLeastArea), place)) return false;
    const Region box = found_.box;
    Region more = place;
    if (box.x == place.x && place.x > area_.x) more = enclosing(more, {place.x - farther, place.y, 1, 1});
    if (box.y == place.y && place.y > area_.y) more = enclosing(more, {place.x, place.y - farther, 1, 1});
    if (box.right() == place.right()) more.width += std::min(farther, area_.right() - place.right());
    if (box.bottom() == place.bottom()) more.height += std::min(farther, area_.bottom() - place.bottom());
    if (more == place) return true;
    place = more;
    farther *= 2;
  }
}

// Cuts off what the thing stands on where both have run together. Returns whether there is still something left.
bool OutlineSeeker::part_from_stand() {
  const BaseSide side = base_;
  const Region box = found_.box;
  const int end = wisp::base_edge(box, side);
  const int length = side == BaseSide::kBottom || side == BaseSide::kTop ? box.height : box.width;
  const int jump = deeper(end, base_edge_, side);
  const bool inside = deeper(end, base_edge_, side) < length;
  if (jump <= std::max(kLeastJump, static_cast<int>(kJumpShare * length)) || !inside) {
    base_edge_ = end;
    return true;
  }
  const Region place = window_.place;
  const bool rows = side == BaseSide::kBottom || side == BaseSide::kTop;
  const int offset = rows ? place.y : place.x;
  const Region in_window{box.x - place.x, box.y - place.y, box.width, box.height};
  const auto waist = find_waist(window_.image, level_, in_window, base_edge_ - offset, side);
  if (!waist) {
    base_edge_ = end;
    return true;
  }
  const Region kept = above_edge(place, *waist + offset, side);
  window_.image = crop(window_.image, {kept.x - place.x, kept.y - place.y, kept.width, kept.height});
  window_.place = kept;
  return choose(finder_.find(window_.image, level_, kLeastArea), kept);
}

// Mean difference from the frame before where the thing is and was; every second row is enough.
void OutlineSeeker::measure_change() {
  const Region place = intersection(grown(found_.box, kLeastMargin), window_.place);
  const Region both = intersection(place, before_place_);
  std::int64_t sum = 0, rows = 0;
  for (int y = both.y + (both.y & 1); y < both.bottom(); y += 2, ++rows) {
    const std::uint8_t* now = window_row(y) + both.x;
    const std::uint8_t* then = before_.data() + static_cast<std::size_t>(y - before_place_.y) * before_place_.width +
                               (both.x - before_place_.x);
    int row = 0;
    for (int x = 0; x < both.width; ++x) row += std::abs(now[x] - then[x]);
    sum += row;
  }
  change_ = rows == 0 ? 255 : static_cast<double>(sum) / (static_cast<double>(rows) * both.width);
  before_.resize(static_cast<std::size_t>(place.width) * place.height);
  for (int y = place.y + (place.y & 1); y < place.bottom(); y += 2) {
    std::copy_n(window_row(y) + place.x, place.width,
                before_.data() + static_cast<std::size_t>(y - place.y) * place.width);
  }
  before_place_ = place;
}

void OutlineSeeker::measure_brightness(const Picture& picture) {
  const Region box = intersection(found_.box, window_.place);
  std::int64_t sum = 0, count = 0;
  for (int y = box.y; y < box.bottom(); y += 4) {
    const std::uint8_t* row = window_row(y) + box.x;
    int row_sum = 0, row_count = 0;
    for (int x = 0; x < box.width; ++x) {
      const int bright = row[x] > level_ ? 1 : 0;
      row_sum += bright * row[x];
      row_count += bright;
    }
    sum += row_sum;
    count += row_count;
  }
  const double mean = count == 0 ? 0 : static_cast<double>(sum) / static_cast<double>(count);
  brightness_ = wisp::brightness(picture, channel_, mean);
}

// How far the thing may move from frame to frame. Where it moves farther, it touches the window's border and is looked
// for again in more.
int OutlineSeeker::margin() const { return kLeastMargin + static_cast<int>(kMarginPace * pace_); }

bool OutlineSeeker::seek(const Picture& picture) {
  const BrightRegion before = found_;
  bool seen = following_ && find_in(picture, grown(found_.box, margin()));
  if (!seen) {
    following_ = false;
    seen = find_in(picture, grown(home_, kLeastMargin)) || find_in(picture, area_);
  }
  if (!seen || !part_from_stand()) return false;
  if (following_) {
    const Region &a = before.box, &b = found_.box;
    const int moved = std::max(
        {std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.right() - b.right()), std::abs(a.bottom() - b.bottom())});
    pace_ = std::max(moved, static_cast<int>(kPaceMemory * pace_));
  }
  following_ = true;
  const double area = static_cast<double>(found_.area);
  usual_area_ = usual_area_ == 0 ? area : 0.95 * usual_area_ + 0.05 * area;
  measure_change();
  if (!dark_) measure_brightness(picture);  // a dark thing does not fade: its ground does
  const Region place = window_.place;
  follow_boundary(window_.image, level_, {found_.seed_x - place.x, found_.seed_y - place.y}, boundary_);
  return true;
}

bool OutlineSeeker::edge_points(const EdgeCloudOptions& options, EdgeCloud& cloud) const {
  return make_edge_cloud({window_.image, window_.place, area_, level_}, boundary_, options, cloud);
}

}  // namespace wisp
