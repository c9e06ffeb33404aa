#include "wisp/draw/leaf_flock.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "draw/flame/flame_layers.hpp"
#include "draw/leaf/leaf_view.hpp"
#include "draw/textured.hpp"

namespace wisp {

using namespace drawing;

namespace {

// A leaf's card, in halves of its length and width: the stalk reaches beyond the base.
constexpr float kLeft = -1.52F, kRight = 1.06F, kSide = 1.12F;
constexpr int kTextureWidth = 192, kTextureHeight = 120;

// The card's grid: enough to bend.
constexpr int kAlong = 6, kAcross = 4;

constexpr int kShadowCell = 4;       // pixels
constexpr float kFaintest = 0.006F;  // what cannot be seen
constexpr float kBladeArea = 0.62F;  // of the rectangle around the blade

struct Colours {
  Colour upper, margin, under, vein;
};

// Weeks of an autumn. The first is the style's own.
std::vector<LeafStyle> weeks_of(const LeafStyle& style) {
  constexpr std::array<Colours, 4> kOthers{{
      {{226, 150, 44}, {186, 84, 28}, {214, 178, 116}, {248, 214, 130}},
      {{188, 58, 34}, {118, 28, 26}, {190, 134, 104}, {232, 170, 110}},
      {{206, 172, 62}, {150, 120, 36}, {204, 188, 128}, {240, 224, 150}},
      {{150, 88, 50}, {98, 54, 32}, {176, 138, 104}, {204, 160, 110}},
  }};
  std::vector<LeafStyle> weeks{style};
  for (const Colours& colours : kOthers) {
    LeafStyle week = style;
    week.upper = colours.upper, week.margin = colours.margin, week.under = colours.under, week.vein = colours.vein;
    weeks.push_back(week);
  }
  return weeks;
}

// One side of a flat leaf under a lamp straight above it, as the card's picture: row 0 is where the leaf's y is
// largest.
Texture side_of(LeafStyle style, bool upper) {
  constexpr float kDimmed = 0.6F;  // to the leaf's own colour, since lamp and sky together are brighter than white
  style.curl = 0;
  style.scale = 1;
  const float half_length = style.length / 2, half_width = style.width / 2;
  const float high = 2 * kSide * half_width;
  const LeafCamera camera = leaf_camera_from_above({(kLeft + kRight) / 2 * half_length, 0, 0}, high);
  // Pixels are not square on the leaf: the picture is drawn as wide as it must be, then narrowed.
  const int drawn_width =
      std::max(1, static_cast<int>(std::lround(kTextureHeight * (kRight - kLeft) * half_length / high)));
  const LeafView view(camera, drawn_width, kTextureHeight);
  const Vec3 lamp{0, 0, 1};
  const std::array<float, 4> face_up{1, 0, 0, 0}, face_down{0, 1, 0, 0};
  const LeafPatch patch = leaf_patch(leaf_mesh(style), {{0, 0, 0}, Turn(upper ? face_up : face_down)},
                                     LeafSurface(style, lamp), view, drawn_width, kTextureHeight);
  const Tone& tone = Tone::get();
  Image drawn(drawn_width, kTextureHeight, {0, 0, 0, 0});
  for (int y = std::max(0, -patch.y); y < std::min(patch.height, kTextureHeight - patch.y); ++y) {
    for (int x = std::max(0, -patch.x); x < std::min(patch.width, drawn_width - patch.x); ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * patch.width + x;
      const float cover = std::min(patch.cover[at], 1.0F);
      if (cover <= 0) continue;
      const Light light = kDimmed / patch.cover[at] * patch.light[at];
      const auto code = [&](float value) { return static_cast<std::uint32_t>(cover * tone.code(value) + 0.5F); };
      const int row = upper ? patch.y + y : kTextureHeight - 1 - patch.y - y;
      drawn.row(row)[patch.x + x] = static_cast<std::uint32_t>(255 * cover + 0.5F) << 24 | code(light.red) << 16 |
                                    code(light.green) << 8 | code(light.blue);
    }
  }
  const Image fitted = resized(drawn, kTextureWidth, kTextureHeight);
  return texture_of({kTextureWidth, kTextureHeight, {fitted.pixels().begin(), fitted.pixels().end()}});
}

// The card's height over the leaf's plane, in half lengths, as draw_leaves() bends its leaves.
float bulge(float x, float y, float curl) {
  const float fold = 0.20F * std::sqrt(y * y + 0.01F);
  const float hang = x > -1 ? -0.12F * x * x : -0.12F - 0.30F * (x + 1) * (x + 1) + 0.24F * (x + 1);
  return curl * (fold + hang + 0.07F * x * y);
}

struct CardVertex {
  Vec3 place;   // in the leaf's axes, for a leaf of the style's size
  Vec3 normal;  // out of the upper side
  float u, v;
};

std::vector<CardVertex> card_of(const LeafStyle& style) {
  const float half_length = style.length / 2, half_width = style.width / 2;
  const float curl = std::clamp(style.curl, 0.0F, 3.0F), h = 0.02F;
  std::vector<CardVertex> card;
  for (int i = 0; i <= kAlong; ++i) {
    for (int j = 0; j <= kAcross; ++j) {
      const float u = static_cast<float>(i) / kAlong, v = static_cast<float>(j) / kAcross;
      const float x = kLeft + u * (kRight - kLeft), y = kSide * (1 - 2 * v);
      const float along = (bulge(x + h, y, curl) - bulge(x - h, y, curl)) / (2 * h);
      const float across = (bulge(x, y + h, curl) - bulge(x, y - h, curl)) / (2 * h) * half_length / half_width;
      card.push_back(
          {{half_length * x, half_width * y, half_length * bulge(x, y, curl)}, unit({-along, -across, 1}), u, v});
    }
  }
  return card;
}

// Light on a surface against that on one that lies open under the lamp, as a factor of codes.
float shade(Vec3 normal, Vec3 lamp) {
  const float falls = dot(normal, lamp), sky = 0.5F + 0.5F * normal.z;
  const float light = 1.2F * std::max(falls, 0.0F) + 0.45F * sky + 0.27F * (1 - sky) + 0.36F * std::max(-falls, 0.0F);
  // A power of 1/2.2, nearly: its larger part a square root. One that lies open has 1.65.
  return std::sqrt(light) * (0.97F + 0.05F * light) / 1.34F;
}

}  // namespace

struct LeafFlock::State {
  State(int width, int height, const LeafCamera& camera, const LeafStyle& style, const LeafRoom& room)
      : room_picture(draw_leaf_room(width, height, camera, room)),
        view(camera, width, height),
        lamp(unit(vec3(room.lamp))),
        card(card_of(style)),
        half_length(style.length / 2),
        half_width(style.width / 2),
        at_target(static_cast<float>(height) / std::max(camera.view_height, 0.01F)),
        shadows((width + kShadowCell - 1) / kShadowCell + 1, (height + kShadowCell - 1) / kShadowCell + 1) {
    for (const LeafStyle& week : weeks_of(style)) sides.push_back({side_of(week, true), side_of(week, false)});
  }

  void cast(const FlockLeaf& leaf, Vec3 place, const Turn& turn);
  void lay_shadows(Image& image) const;
  void lay_leaf(Image& image, const FlockLeaf& leaf);

  Image room_picture;
  LeafView view;
  Vec3 lamp;
  std::vector<CardVertex> card;
  float half_length, half_width;
  float at_target;
  Plane shadows;  // darkness, in cells
  std::vector<std::array<Texture, 2>> sides;
  std::vector<const FlockLeaf*> order;
};

// Adds the shadow of a leaf: a Gaussian over the floor with the spread of the leaf's own shadow and of the lamp's size.
void LeafFlock::State::cast(const FlockLeaf& leaf, Vec3 place, const Turn& turn) {
  const float height = std::max(place.z, 0.0F);
  const auto on_floor = [&](Vec3 p) { return p - p.z / lamp.z * lamp; };
  const Vec3 spot = on_floor({place.x, place.y, height});
  const Projected middle = view(spot);
  if (!(middle.depth > kNear)) return;
  const float scale = view.scale_at(middle.depth) / kShadowCell;
  const float flat = std::max(0.05F, std::abs(unit(spot - view.eye()).z));
  // Half axes of the leaf, seen from the lamp, on the floor, in cells of the grid.
  const Vec3 a = on_floor(leaf.size * half_length * turn({1, 0, 0}));
  const Vec3 b = on_floor(leaf.size * half_width * turn({0, 1, 0}));
  const float soft = 0.5F * kLampRadius * height / lamp.z;

  // Variances of an ellipse are a quarter of its half axes' squares; the picture's rows foreshorten the floor.
  const float xx = scale * scale * ((a.x * a.x + b.x * b.x) / 4 + soft * soft) + 0.4F;
  const float yy = scale * scale * flat * flat * ((a.y * a.y + b.y * b.y) / 4 + soft * soft) + 0.4F;
  const float xy = -scale * scale * flat * (a.x * a.y + b.x * b.y) / 4;
  const float area = xx * yy - xy * xy;
  if (!(area > 0.05F)) return;
  const float blade = kBladeArea * 4 * std::abs(a.x * b.y - a.y * b.x) * scale * scale * flat;
  const float peak = std::min(1.0F, blade / (6.2832F * std::sqrt(area)));
  const float dark = kDarkest * peak * std::clamp(leaf.opacity, 0.0F, 1.0F);
  if (dark < kFaintest) return;
  const float mx = middle.x / kShadowCell - 0.5F, my = middle.y / kShadowCell - 0.5F;
  const float reach = 2.4F;
  const auto held = [](float at, int most) {
    return static_cast<int>(std::clamp(at, -1.0F, static_cast<float>(most)));
  };
  const int left = std::max(0, held(mx - reach * std::sqrt(xx), shadows.width));
  const int right = std::min(shadows.width - 1, held(mx + reach * std::sqrt(xx) + 1, shadows.width));
  const int top = std::max(0, held(my - reach * std::sqrt(yy), shadows.height));
  const int bottom = std::min(shadows.height - 1, held(my + reach * std::sqrt(yy) + 1, shadows.height));
  for (int y = top; y <= bottom; ++y) {
    float* row = shadows.row(y);
    const float dy = static_cast<float>(y) - my;
    for (int x = left; x <= right; ++x) {
      const float dx = static_cast<float>(x) - mx;
      const float square = (yy * dx * dx - 2 * xy * dx * dy + xx * dy * dy) / area;
      // (1 − s/6)³ falls like e^(−s/2), and ends.
      const float left_over = std::max(0.0F, 1 - square / 6);
      row[x] += dark * left_over * left_over * left_over;
    }
  }
}

void LeafFlock::State::lay_shadows(Image& image) const {
  std::vector<float> row(static_cast<std::size_t>(shadows.width));
  for (int y = 0; y < image.height(); ++y) {
    const float at = (static_cast<float>(y) + 0.5F) / kShadowCell - 0.5F;
    const int above = std::max(0, static_cast<int>(std::floor(at)));
    const float share = std::clamp(at - static_cast<float>(above), 0.0F, 1.0F);
    const float *a = shadows.row(above), *b = shadows.row(std::min(above + 1, shadows.height - 1));
    float sum = 0;
    for (int k = 0; k < shadows.width; ++k) sum += row[k] = a[k] + share * (b[k] - a[k]);
    if (sum < kFaintest) continue;
    std::uint32_t* pixels = image.row(y).data();
    for (int x = 0; x < image.width(); ++x) {
      const float across = (static_cast<float>(x) + 0.5F) / kShadowCell - 0.5F;
      const int cell = std::max(0, static_cast<int>(across));
      const float part = std::clamp(across - static_cast<float>(cell), 0.0F, 1.0F);
      const float density = row[cell] + part * (row[cell + 1] - row[cell]);
      if (density < kFaintest / 2) continue;
      // Shadows that lie over each other grow darker, but never darker than one deep shadow. Codes go as the root.
      const float kept = std::sqrt(1 - kDarkest * density / (kDarkest + density));
      const float dither = dither_at(x, y);
      const auto channel = [&](int shift, float share_kept) {
        return static_cast<std::uint32_t>(static_cast<float>(pixels[x] >> shift & 255U) * share_kept + dither);
      };
      // The sky still lights a shadow, so it is a little bluer than the floor.
      const float cool = 1 - 0.94F * (1 - kept);
      pixels[x] = 0xFF000000U | channel(16, kept) << 16 | channel(8, 1 - 0.98F * (1 - kept)) << 8 | channel(0, cool);
    }
  }
}

void LeafFlock::State::lay_leaf(Image& image, const FlockLeaf& leaf) {
  const Vec3 place = vec3(leaf.pose.position);
  const Turn turn(leaf.pose.attitude);
  const Vec3 to_eye = view.eye() - place;
  const bool upper = dot(turn({0, 0, 1}), to_eye) >= 0;
  const float size = std::clamp(leaf.size, 0.1F, 4.0F);
  std::array<TexturedCorner, (kAlong + 1) * (kAcross + 1)> corners;
  float left = 1e9F, right = -1e9F, top = 1e9F, bottom = -1e9F;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const CardVertex& vertex = card[k];
    const Projected p = view(place + size * turn(vertex.place));
    if (!(p.depth > kNear)) return;
    const Vec3 normal = turn(vertex.normal);
    corners[k] = {p.x, p.y, vertex.u, vertex.v, shade(upper ? normal : -1.0F * normal, lamp)};
    left = std::min(left, p.x), right = std::max(right, p.x);
    top = std::min(top, p.y), bottom = std::max(bottom, p.y);
  }
  if (right < 0 || bottom < 0 || left > static_cast<float>(image.width()) || top > static_cast<float>(image.height()))
    return;
  const Texture& side = sides[leaf.look % sides.size()][upper ? 0 : 1];
  // The size of the texture that comes nearest to one of its pixels for one of the image's.
  const float long_axis = view.scale_at(dot(place - view.eye(), view.gaze())) * size * half_length * (kRight - kLeft);
  const float finer = std::log2(std::max(1.0F, kTextureWidth / std::max(1.0F, long_axis)));
  const auto level = std::min(static_cast<std::size_t>(finer + 0.4F), side.levels.size() - 1);
  const Texture::Level& texture = side.levels[level];
  for (int i = 0; i < kAlong; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      const auto a = static_cast<std::size_t>(i * (kAcross + 1) + j), b = a + kAcross + 1;
      draw_textured(image, corners[a], corners[b], corners[a + 1], texture, leaf.opacity);
      draw_textured(image, corners[a + 1], corners[b], corners[b + 1], texture, leaf.opacity);
    }
  }
}

LeafFlock::LeafFlock(int width, int height, const LeafCamera& camera, const LeafStyle& style, const LeafRoom& room)
    : state_(std::make_unique<State>(width, height, camera, style, room)) {}
LeafFlock::LeafFlock(LeafFlock&&) noexcept = default;
LeafFlock& LeafFlock::operator=(LeafFlock&&) noexcept = default;
LeafFlock::~LeafFlock() = default;

void LeafFlock::draw(Image& image, std::span<const FlockLeaf> leaves) {
  State& state = *state_;
  image = state.room_picture;
  std::fill(state.shadows.values.begin(), state.shadows.values.end(), 0.0F);
  state.order.clear();
  for (const FlockLeaf& leaf : leaves) {
    if (!is_drawable(leaf.pose)) continue;
    state.order.push_back(&leaf);
    state.cast(leaf, vec3(leaf.pose.position), Turn(leaf.pose.attitude));
  }
  state.lay_shadows(image);
  const auto depth = [&](const FlockLeaf* leaf) {
    return dot(vec3(leaf->pose.position) - state.view.eye(), state.view.gaze());
  };
  std::stable_sort(state.order.begin(), state.order.end(), [&](auto* a, auto* b) { return depth(a) > depth(b); });
  for (const FlockLeaf* leaf : state.order) state.lay_leaf(image, *leaf);
}

std::optional<Point> LeafFlock::pixel_of(const std::array<float, 3>& place) const {
  const Projected p = state_->view(vec3(place));
  if (!(p.depth > kNear)) return {};
  return Point{p.x, p.y};
}

float LeafFlock::pixels_per_metre() const { return state_->at_target; }

}  // namespace wisp
