#include "capture/vision/outline_seeker.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "capture/vision/survey.hpp"

namespace wisp {
namespace {

constexpr int kMinMargin = 8;          // pixels searched around the object's last place
constexpr double kMarginPace = 1.5;    // multiple of the object's recent motion that is added to kMinMargin
constexpr double kPaceMemory = 0.8;    // factor by which the stored recent motion decays per frame
constexpr double kMinAreaShare = 0.1;  // minimum share of the object's usual area: less is a spark or an ember; after
                                       // an absence, the inverse is the maximum
constexpr int kMinArea = 24;           // minimum pixels of a region

constexpr double kSlack = 0.12;  // share of the length: a stand may begin this far above the object's last base, and an
                                 // extension this far below it is always stand
constexpr double kStays = 0.2;   // minimum overlap with the last frame's box, as a share of the smaller box

// Returns the midpoint of a box's end towards the base.
PixelPosition foot(const Region& box, BaseSide side) {
  const int edge = base_edge(box, side);
  if (side == BaseSide::kBottom || side == BaseSide::kTop) return {box.x + box.width / 2, edge};
  return {edge, box.y + box.height / 2};
}

double distance(const PixelPosition& a, const PixelPosition& b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace

OutlineSeeker::OutlineSeeker(const Survey& survey, const Region& area, BaseSide base, bool dark)
    : channel_(survey.channel),
      level_(survey.level),
      base_(base),
      dark_(dark),
      area_(area),
      home_(survey.home),
      others_(survey.others),
      usual_(survey.seen.empty() ? survey.home : usual_place(survey.seen)),
      stands_(survey.stands),
      usual_area_(survey.area),
      base_edge_(wisp::base_edge(usual_, base)),
      last_foot_(foot(usual_, base)) {}

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

// Returns whether a region is nearer to this flame's place than to another's. Camera motion shifts all places alike.
bool OutlineSeeker::ours(const Region& box) const {
  const PixelPosition home = foot(usual_, base_), now = following_ ? foot(found_.box, base_) : home,
                      at = foot(box, base_);
  return std::none_of(others_.begin(), others_.end(), [&](const Region& other) {
    const PixelPosition place = foot(other, base_);
    return distance(at, {place.x + now.x - home.x, place.y + now.y - home.y}) < distance(at, now);
  });
}

// Returns whether the region found has about the object's brightness and area, unlike smoke and snuffers.
bool OutlineSeeker::alike() const {
  const double area = static_cast<double>(found_.area);
  const bool bright = dark_ || brightness_ >= kAsBright * usual_brightness_;
  return bright && kMinAreaShare * area < usual_area_ && area > kMinAreaShare * usual_area_;
}

// Returns whether the region found may be the object: it must overlap the box of the frame before or, after an absence,
// be alike() and near the object's last or usual place.
bool OutlineSeeker::plausible(const Region& before) const {
  const Region& box = found_.box;
  if (following_) return intersection(box, before).area() > kStays * std::min(box.area(), before.area());
  const double length = std::max({usual_.width, usual_.height, box.height});
  const PixelPosition at = foot(box, base_);
  return std::min(distance(at, last_foot_), distance(at, foot(usual_, base_))) <= kAsNear * length && alike();
}

// Chooses the region that best matches the last one, by area times overlap of boxes. Returns whether there is one.
bool OutlineSeeker::choose(std::span<const BrightRegion> regions, const Region& place) {
  const Region expected = following_ ? found_.box : home_;
  BrightRegion chosen = found_;  // ours() compares with found_, so this is set only at the end
  double best = 0;
  for (const BrightRegion& region : regions) {
    if (static_cast<double>(region.area) < kMinAreaShare * usual_area_) continue;
    BrightRegion moved = region;
    moved.box.x += place.x;
    moved.box.y += place.y;
    if (!ours(moved.box)) continue;
    const double shared = intersection(moved.box, expected).area();
    const double likeness = (shared + 1) / (moved.box.area() + expected.area() - shared);
    const double score = static_cast<double>(region.area) * likeness;
    if (score <= best) continue;
    best = score;
    moved.seed_x += place.x;
    moved.seed_y += place.y;
    chosen = moved;
  }
  found_ = chosen;
  return best > 0;
}

// Searches inside `place`, which is extended on sides where the object reaches its border.
bool OutlineSeeker::find_in(const Picture& picture, Region place) {
  int farther = margin();
  while (true) {
    place = intersection(place, area_);
    if (place.empty()) return false;
    window_ = open(picture, place);
    if (!choose(finder_.find(window_.image, level_, kMinArea), place)) return false;
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

void OutlineSeeker::follow() {
  const Region place = window_.place;
  follow_boundary(window_.image, level_, {found_.seed_x - place.x, found_.seed_y - place.y}, boundary_);
}

// Cuts off the stand where it has merged with the object. Returns whether an object remains.
bool OutlineSeeker::part_from_stand() {
  const Region box = found_.box, place = window_.place;
  const int end = wisp::base_edge(box, base_);
  const bool rows = base_ == BaseSide::kBottom || base_ == BaseSide::kTop;
  const int length = rows ? box.height : box.width;
  const int jump = deeper(end, base_edge_, base_);
  const bool inside = jump < length;
  follow();
  if (!inside || (!stands_ && jump <= kMinStep)) {
    base_edge_ = end;
    return true;
  }
  measure_profile(boundary_, base_, profile_);
  const int above = length - jump;
  const int slack = static_cast<int>(kSlack * above);
  const auto shoulder = find_shoulder(profile_, static_cast<std::size_t>(std::max(0, stands_ ? 0 : above - slack)));
  if (!shoulder && !(stands_ && jump > slack)) {
    base_edge_ = end;
    return true;
  }
  const int offset = rows ? place.y : place.x;
  const int last = depth_of(profile_.first + (shoulder ? static_cast<int>(*shoulder) : above - 1), base_) + offset;
  const Region kept = above_edge(place, last, base_);
  window_.image = crop(window_.image, {kept.x - place.x, kept.y - place.y, kept.width, kept.height});
  window_.place = kept;
  if (!choose(finder_.find(window_.image, level_, kMinArea), kept)) return false;
  if (!stands_ || shoulder) base_edge_ = last;
  follow();
  return true;
}

// Computes the mean difference from the frame before, in even rows where the object's old and new surroundings overlap.
void OutlineSeeker::measure_change() {
  const Region place = intersection(grown(found_.box, kMinMargin), window_.place);
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

// Returns the margin for the object's motion between frames. An object that moves farther touches the window's border,
// and find_in() searches a larger window.
int OutlineSeeker::margin() const { return kMinMargin + static_cast<int>(kMarginPace * pace_); }

bool OutlineSeeker::seek(const Picture& picture) {
  const BrightRegion before = found_;
  elsewhere_ = false;
  bool seen = following_ && find_in(picture, grown(found_.box, margin()));
  if (!seen) {
    following_ = false;
    seen = find_in(picture, grown(home_, kMinMargin)) || find_in(picture, area_);
  }
  if (!seen || !part_from_stand()) {
    following_ = false;
    return false;
  }
  if (!dark_) measure_brightness(picture);  // a dark object does not fade, only its background does
  if (!plausible(before.box)) {
    elsewhere_ = !following_ && alike();
    following_ = false;
    return false;
  }
  if (following_) {
    const Region &a = before.box, &b = found_.box;
    const int moved = std::max(
        {std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.right() - b.right()), std::abs(a.bottom() - b.bottom())});
    pace_ = std::max(moved, static_cast<int>(kPaceMemory * pace_));
  }
  following_ = true;
  last_foot_ = foot(found_.box, base_);
  const double area = static_cast<double>(found_.area);
  usual_area_ = 0.95 * usual_area_ + 0.05 * area;
  usual_brightness_ = usual_brightness_ == 0 ? brightness_ : 0.95 * usual_brightness_ + 0.05 * brightness_;
  measure_change();
  return true;
}

bool OutlineSeeker::edge_points(const EdgeCloudOptions& options, EdgeCloud& cloud) const {
  return make_edge_cloud({window_.image, window_.place, level_}, boundary_, options, cloud);
}

}  // namespace wisp
