#include "wisp/draw/leaf.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "draw/cairo.hpp"
#include "draw/flame/flame_layers.hpp"
#include "draw/leaf/leaf_view.hpp"

namespace wisp {

using namespace drawing;

namespace {

// Resolution of the leaf's surface grid: sufficient for its curvature.
constexpr int kAlong = 6, kAcross = 4;

constexpr int kShadowCell = 4;        // pixels
constexpr float kFaintest = 0.006F;   // weaker shadows are invisible
constexpr float kBladeArea = 0.62F;   // area that blocks light, as a share of length × width
constexpr float kLampRadius = 0.10F;  // lamp radius over its distance, which determines the softness of shadows
constexpr float kDarkest = 0.62F;     // maximum share of the floor's light removed by a shadow

struct Colours {
  Colour upper, margin, under, vein;
};

// Returns leaf styles of successive weeks of an autumn, beginning with the given style.
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

Vec3 towards_lamp(const LeafRoom& room) {
  Vec3 way = vec3(room.lamp);
  const bool usable = std::isfinite(way.x + way.y + way.z) && way.z > 0;
  return unit(usable ? way : Vec3{0, 0, 1});
}

// Returns whether position and orientation of a leaf are valid numbers.
bool is_drawable(const LeafPose& pose) {
  float sum = 0, square = 0;
  for (const float part : pose.position) sum += part;
  for (const float part : pose.attitude) square += part * part;
  return std::isfinite(sum) && std::isfinite(square) && square > 1e-12F;
}

LeafStyle clamped(LeafStyle style) {
  style.length = std::clamp(style.length, 0.001F, 100.0F);
  style.width = std::clamp(style.width, 0.001F, 100.0F);
  style.curl = std::clamp(style.curl, 0.0F, 3.0F);
  return style;
}

Image empty_room(int width, int height, const LeafCamera& camera, const LeafRoom& room) {
  Image image(width, height);
  const LeafView view(camera, width, height);
  const Tone& tone = Tone::get();
  const Light floor = tone.linear(room.floor), backdrop = tone.linear(room.backdrop);
  const float reach = std::max(camera.view_height, 0.01F);
  const Vec3 target = vec3(camera.target);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Vec3 ray = view.ray(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      Light light = backdrop;
      const float along = ray.z < -1e-6F ? -view.eye().z / ray.z : -1;
      if (along > 0) {
        const Vec3 there = view.eye() + along * ray;
        // The floor blends into the backdrop without an edge, with a pool of light around the middle.
        const float far = std::hypot(there.x - target.x, there.y - target.y) / reach;
        const float away = smooth_step(0.5F, 2.2F, far);
        const float pool = 1 - 0.07F * smooth_step(0.2F, 1.8F, far);
        light = (1 - away) * pool * floor + away * backdrop;
      }
      blend(image.row(y)[static_cast<std::size_t>(x)], light, 1, dither_at(x, y));
    }
  }
  return image;
}

// Returns the card's height over the leaf's plane, in half lengths: the leaf folds up along the midrib, its ends droop.
float bulge(float x, float y, float curl) {
  const float fold = 0.20F * std::sqrt(y * y + 0.01F);
  const float hang = x > -1 ? -0.12F * x * x : -0.12F - 0.30F * (x + 1) * (x + 1) + 0.24F * (x + 1);
  return curl * (fold + hang + 0.07F * x * y);
}

struct CardVertex {
  Vec3 place;   // position in the leaf's axes, for a leaf of the style's size
  Vec3 normal;  // unit normal of the upper side
  float u, v;
};

std::vector<CardVertex> card_of(const LeafStyle& style) {
  const float half_length = style.length / 2, half_width = style.width / 2;
  const float curl = style.curl, h = 0.02F;
  std::vector<CardVertex> card;
  for (int i = 0; i <= kAlong; ++i) {
    for (int j = 0; j <= kAcross; ++j) {
      const float u = static_cast<float>(i) / kAlong, v = static_cast<float>(j) / kAcross;
      const float x = kLeafLeft + u * (kLeafRight - kLeafLeft), y = kLeafSide * (1 - 2 * v);
      const float along = (bulge(x + h, y, curl) - bulge(x - h, y, curl)) / (2 * h);
      const float across = (bulge(x, y + h, curl) - bulge(x, y - h, curl)) / (2 * h) * half_length / half_width;
      card.push_back(
          {{half_length * x, half_width * y, half_length * bulge(x, y, curl)}, unit({-along, -across, 1}), u, v});
    }
  }
  return card;
}

// Returns the light on a surface relative to a surface facing the lamp, as a factor of sRGB codes.
float shade(Vec3 normal, Vec3 lamp) {
  const float falls = dot(normal, lamp), sky = 0.5F + 0.5F * normal.z;
  const float light = 1.2F * std::max(falls, 0.0F) + 0.45F * sky + 0.27F * (1 - sky) + 0.36F * std::max(-falls, 0.0F);
  // Approximates a power of 1/2.2 by a square root and a linear factor. A surface facing the lamp has light 1.65.
  return std::sqrt(light) * (0.97F + 0.05F * light) / 1.34F;
}

}  // namespace

struct LeafFlock::State {
  State(int width, int height, const LeafCamera& camera, const LeafStyle& style, const LeafRoom& room)
      : room_picture(empty_room(width, height, camera, room)),
        view(camera, width, height),
        lamp(towards_lamp(room)),
        card(card_of(style)),
        half_length(style.length / 2),
        half_width(style.width / 2),
        at_target(static_cast<float>(height) / std::max(camera.view_height, 0.01F)),
        shadows((width + kShadowCell - 1) / kShadowCell + 1, (height + kShadowCell - 1) / kShadowCell + 1) {
    for (const LeafStyle& week : weeks_of(style)) {
      sides.push_back({painted_side(week, true), painted_side(week, false)});
      margins.push_back(week.margin);
    }
  }

  void cast(const FlockLeaf& leaf, Vec3 place, const Turn& turn);
  void lay_shadows(Image& image) const;
  void draw_trail(Image& image, const FlockLeaf& leaf) const;
  void lay_leaf(Image& image, const FlockLeaf& leaf);

  Image room_picture;
  LeafView view;
  Vec3 lamp;
  std::vector<CardVertex> card;
  float half_length, half_width;
  float at_target;                            // pixels per metre at the camera's target
  Plane shadows;                              // darkness, in cells
  std::vector<std::array<Texture, 2>> sides;  // textures of both sides, per look
  std::vector<Colour> margins;                // margin colour per look, for trails
  std::vector<const FlockLeaf*> order;
};

// Adds a leaf's shadow: a Gaussian on the floor, widened by the leaf's own size and the lamp's.
void LeafFlock::State::cast(const FlockLeaf& leaf, Vec3 place, const Turn& turn) {
  const float height = std::max(place.z, 0.0F);
  const auto on_floor = [&](Vec3 p) { return p - p.z / lamp.z * lamp; };
  const Vec3 spot = on_floor({place.x, place.y, height});
  const Projected middle = view(spot);
  if (!(middle.depth > kNear)) return;
  const float scale = view.scale_at(middle.depth) / kShadowCell;
  const float flat = std::max(0.05F, std::abs(unit(spot - view.eye()).z));
  // Half axes of the leaf projected from the lamp onto the floor, in metres.
  const Vec3 a = on_floor(leaf.size * half_length * turn({1, 0, 0}));
  const Vec3 b = on_floor(leaf.size * half_width * turn({0, 1, 0}));
  const float soft = 0.5F * kLampRadius * height / lamp.z;

  // Covariance in cells: a quarter of the half axes' squares; the rows of the picture foreshorten the floor.
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
  const auto cell = [](float at, int most) {
    return static_cast<int>(std::clamp(at, -1.0F, static_cast<float>(most)));
  };
  const int left = std::max(0, cell(mx - reach * std::sqrt(xx), shadows.width));
  const int right = std::min(shadows.width - 1, cell(mx + reach * std::sqrt(xx) + 1, shadows.width));
  const int top = std::max(0, cell(my - reach * std::sqrt(yy), shadows.height));
  const int bottom = std::min(shadows.height - 1, cell(my + reach * std::sqrt(yy) + 1, shadows.height));
  for (int y = top; y <= bottom; ++y) {
    float* row = shadows.row(y);
    const float dy = static_cast<float>(y) - my;
    for (int x = left; x <= right; ++x) {
      const float dx = static_cast<float>(x) - mx;
      const float square = (yy * dx * dx - 2 * xy * dx * dy + xx * dy * dy) / area;
      // (1 − s/6)³ approximates e^(−s/2) with finite support.
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
      // Overlapping shadows get darker, but never darker than one deep shadow. Codes vary as the square root of light.
      const float kept = std::sqrt(1 - kDarkest * density / (kDarkest + density));
      const float dither = dither_at(x, y);
      const auto channel = [&](int shift, float share_kept) {
        return static_cast<std::uint32_t>(static_cast<float>(pixels[x] >> shift & 255U) * share_kept + dither);
      };
      // Shadows are still lit by the sky, so they are slightly bluer than the floor.
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
  // Selects the texture level whose pixels are nearest in size to the image's.
  const float long_axis =
      view.scale_at(dot(place - view.eye(), view.gaze())) * size * half_length * (kLeafRight - kLeafLeft);
  const float finer = std::log2(std::max(1.0F, kLeafPixels / std::max(1.0F, long_axis)));
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

void LeafFlock::State::draw_trail(Image& image, const FlockLeaf& leaf) const {
  if (leaf.trail.size() < 2) return;
  const CairoContext context = context_of(image);
  cairo_set_line_cap(context.get(), CAIRO_LINE_CAP_BUTT);
  Colour colour = margins[leaf.look % margins.size()];
  const float count = static_cast<float>(leaf.trail.size());
  for (std::size_t k = 1; k < leaf.trail.size(); ++k) {
    if (!is_drawable(leaf.trail[k - 1]) || !is_drawable(leaf.trail[k])) continue;
    const Projected a = view(vec3(leaf.trail[k - 1].position)), b = view(vec3(leaf.trail[k].position));
    if (a.depth <= kNear || b.depth <= kNear) continue;
    const float age = 1 - static_cast<float>(k) / count;
    colour.opacity = static_cast<std::uint8_t>(190 * (1 - age));
    set_colour(context.get(), colour);
    cairo_set_line_width(context.get(), std::max(1.1, 0.0028 * static_cast<double>(view.scale_at(b.depth))));
    cairo_move_to(context.get(), static_cast<double>(a.x), static_cast<double>(a.y));
    cairo_line_to(context.get(), static_cast<double>(b.x), static_cast<double>(b.y));
    cairo_stroke(context.get());
  }
}

LeafCamera leaf_camera_from_side(float height) {
  // The floor below the target is in the lowest eighth of the picture.
  const float middle = 0.40F * height;
  return {{0, -3.2F * height, 0.86F * height}, {0, 0, middle}, height};
}

LeafFlock::LeafFlock(int width, int height, const LeafCamera& camera, const LeafStyle& style, const LeafRoom& room)
    : state_(std::make_unique<State>(width, height, camera, clamped(style), room)) {}
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
  for (const FlockLeaf* leaf : state.order) state.draw_trail(image, *leaf);
  for (const FlockLeaf* leaf : state.order) state.lay_leaf(image, *leaf);
}

std::optional<Point> LeafFlock::pixel_of(const std::array<float, 3>& place) const {
  const Projected p = state_->view(vec3(place));
  if (!(p.depth > kNear)) return {};
  return Point{p.x, p.y};
}

float LeafFlock::pixels_per_metre() const { return state_->at_target; }

}  // namespace wisp
