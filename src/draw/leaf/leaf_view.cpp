#include "draw/leaf/leaf_view.hpp"

#include <algorithm>

namespace wisp::drawing {

Turn::Turn(const std::array<float, 4>& q) {
  const float two = 2 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const float w = q[0], x = q[1], y = q[2], z = q[3];
  x_ = {1 - two * (y * y + z * z), two * (x * y + w * z), two * (x * z - w * y)};
  y_ = {two * (x * y - w * z), 1 - two * (x * x + z * z), two * (y * z + w * x)};
  z_ = {two * (x * z + w * y), two * (y * z - w * x), 1 - two * (x * x + y * y)};
}

LeafView::LeafView(const LeafCamera& camera, int width, int height) : eye_(vec3(camera.eye)) {
  const Vec3 way = vec3(camera.target) - eye_;
  const float distance = std::max(length(way), kNear);
  forward_ = 1 / distance * way;
  // Straight down or up, y is what is above in the picture.
  const bool steep = std::abs(forward_.z) > 0.999F;
  right_ = unit(cross(forward_, steep ? Vec3{0, 1, 0} : Vec3{0, 0, 1}));
  up_ = cross(right_, forward_);
  focal_ = static_cast<float>(height) / std::clamp(camera.view_height, 0.01F, 1000.0F) * distance;
  middle_x_ = static_cast<float>(width) / 2;
  middle_y_ = static_cast<float>(height) / 2;
}

Projected LeafView::operator()(Vec3 place) const {
  const Vec3 way = place - eye_;
  const float depth = dot(way, forward_);
  const float scale = focal_ / std::max(depth, kNear);
  return {middle_x_ + scale * dot(way, right_), middle_y_ - scale * dot(way, up_), depth};
}

Vec3 LeafView::ray(float x, float y) const {
  return forward_ + (x - middle_x_) / focal_ * right_ + (middle_y_ - y) / focal_ * up_;
}

namespace {

constexpr Light kLamp{1.25F, 1.18F, 1.06F};
constexpr Light kSky{0.42F, 0.45F, 0.50F};
constexpr Light kFloor{0.30F, 0.27F, 0.23F};

Light mixed(Light a, Light b, float share) { return (1 - share) * a + share * b; }

// How much of a place is vein, 0 … 1.
float vein_at(float u, float v) {
  const float across = std::abs(v);
  const float midrib = 1 - smooth_step(0.6F, 1.0F, across / (0.075F - 0.055F * u));
  // Veins leave the midrib at an angle and bend to the tip.
  constexpr float kVeins = 9;
  const float at = (u - 0.24F * across - 0.06F * across * across) * kVeins;
  const float from_vein = std::abs(at - std::round(at));
  const bool there = at > 0.4F && at < kVeins - 0.7F;
  const float width = 0.10F * (1 - 0.65F * across);
  const float side =
      there ? (1 - smooth_step(0.45F, 1.0F, from_vein / width)) * (1 - smooth_step(0.75F, 1, across)) : 0;
  return std::max(midrib, 0.62F * side);
}

// Blotches of a leaf that is past its summer, −1 … 1: a few waves that do not repeat within it.
float blotch(float u, float v) {
  return (std::sin(9.1F * u + 3.7F * v + 0.4F) + std::sin(-5.3F * u + 7.9F * v + 1.9F) +
          std::sin(14.2F * u - 4.4F * v + 4.1F)) /
         3;
}

}  // namespace

LeafSurface::LeafSurface(const LeafStyle& style, Vec3 towards_lamp) : lamp_(towards_lamp) {
  const Tone& tone = Tone::get();
  upper_ = tone.linear(style.upper);
  margin_ = tone.linear(style.margin);
  under_ = tone.linear(style.under);
  vein_ = tone.linear(style.vein);
}

Light LeafSurface::reflectance(float u, float v, bool upper) const {
  if (u < 0) return mixed(vein_, margin_, 0.45F);
  const float edge = smooth_step(0.25F, 1.05F, std::abs(v) + 0.35F * std::abs(u - 0.45F) + 0.14F * blotch(u, v));
  const float vein = vein_at(u, v);
  if (upper) return mixed(mixed(upper_, margin_, edge), vein_, 0.75F * vein);
  // Below, veins stand out as ridges and the colour of the other side shows faintly.
  return mixed(mixed(under_, mixed(upper_, margin_, edge), 0.20F + 0.22F * edge), 0.55F * mixed(under_, margin_, 0.35F),
               0.8F * vein);
}

Light LeafSurface::seen(float u, float v, Vec3 normal, Vec3 to_eye) const {
  const bool upper = dot(normal, to_eye) >= 0;
  const Vec3 facing = upper ? normal : -1.0F * normal;
  const Light own = reflectance(u, v, upper);
  const float falls = dot(facing, lamp_);
  const float sky = 0.5F + 0.5F * facing.z;
  Light light = own * (std::max(falls, 0.0F) * kLamp + sky * kSky + (1 - sky) * kFloor);
  // What falls on the far side comes through, warmer by what the leaf has swallowed.
  if (falls < 0) {
    const Light through = mixed(upper_, margin_, 0.35F);
    light = light + (-falls * 0.3F * (1 - 0.7F * vein_at(u, v))) * (through * kLamp);
  }
  if (!upper) return light;
  const float shine = dot(facing, unit(lamp_ + to_eye));
  const float spot = std::pow(std::max(shine, 0.0F), 28.0F);
  return light + (0.09F * spot) * kLamp;
}

namespace {

constexpr int kAlong = 56, kAcross = 20;
constexpr int kTeeth = 19;
constexpr float kStalk = 0.24F;        // of the blade's length
constexpr float kStalkWidth = 0.016F;  // likewise

// Half width over the blade, 0 … 1: rounded at the base, drawn out at the tip.
float half_width(float u) {
  const float base = std::pow(u, 0.62F), tip = std::pow(1 - u, 0.95F);
  constexpr float kWidest = 0.4527F;  // of the product, at u = 0.62 / 1.57
  return std::min(1.0F, base * tip / (kWidest * (0.75F + 0.25F * std::min(1.0F, (1 - u) * 5))));
}

// Height over the leaf's plane, in lengths of the blade, for a place in halves of its length and width.
float bulge(float x, float y, float curl) {
  const float rib = std::sqrt(y * y + 0.01F);
  const float fold = 0.10F * rib;                                        // halves fold up along the midrib
  const float arch = -0.06F * x * x;                                     // base and tip hang
  const float tip = x > 0.35F ? -0.13F * (x - 0.35F) * (x - 0.35F) : 0;  // the tip more
  const float wave = 0.022F * y * std::abs(y) * std::sin(7.5F * x + 1.1F * (y > 0 ? 1.0F : -1.0F));
  const float twist = 0.035F * x * y;
  return curl * (fold + arch + tip + wave + twist);
}

// The blade's surface over (u, v).
struct Blade {
  float half_length, half_wide, curl;

  Vec3 operator()(float u, float v) const {
    const float x = 2 * u - 1, y = v * half_width(u);
    return {half_length * x, half_wide * y, 2 * half_length * bulge(x, y, curl)};
  }

  Vec3 normal(float u, float v) const {
    // From the height's slopes over the plane, which also hold at the tips, where the grid closes to a point.
    const float x = 2 * u - 1, y = v * half_width(u), h = 1e-2F;
    const float along = (bulge(x + h, y, curl) - bulge(x - h, y, curl)) * half_length / (h * half_length);
    const float across = (bulge(x, y + h, curl) - bulge(x, y - h, curl)) * half_length / (h * half_wide);
    return unit({-along, -across, 1});
  }
};

void add_grid_triangles(LeafMesh& mesh, int first, int rows, int columns) {
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const int a = first + i * (columns + 1) + j, b = a + columns + 1;
      mesh.triangles.push_back({a, b, a + 1});
      mesh.triangles.push_back({a + 1, b, b + 1});
    }
  }
}

void add_stalk(LeafMesh& mesh, const Blade& blade) {
  constexpr int kPieces = 10;
  const int first = static_cast<int>(mesh.vertices.size());
  const float half = kStalkWidth * blade.half_length;
  const Vec3 root = blade(0, 0);
  const float sag = blade.curl * 0.35F * blade.half_length;
  for (int i = 0; i <= kPieces; ++i) {
    const float s = static_cast<float>(i) / kPieces;
    const Vec3 middle =
        root + Vec3{-2 * kStalk * blade.half_length * s, 0.06F * blade.half_length * s * s, -sag * s * s};
    for (const float side : {-1.0F, 1.0F})
      mesh.vertices.push_back({middle + Vec3{0, side * half * (1 + 0.6F * s * s), 0}, {0, 0, 1}, -s, side});
  }
  add_grid_triangles(mesh, first, kPieces, 1);
}

}  // namespace

bool on_blade(float u, float v) {
  if (u < 0) return true;
  // Teeth point to the tip: each rises slowly and falls at once.
  const float tooth = u * kTeeth - std::floor(u * kTeeth);
  return std::abs(v) <= 1 - 0.045F * (1 - tooth);
}

LeafMesh leaf_mesh(const LeafStyle& style) {
  const float scale = std::clamp(style.scale, 0.1F, 20.0F);
  const Blade blade{scale * std::clamp(style.length, 0.001F, 100.0F) / 2,
                    scale * std::clamp(style.width, 0.001F, 100.0F) / 2, std::clamp(style.curl, 0.0F, 3.0F)};
  LeafMesh mesh;
  for (int i = 0; i <= kAlong; ++i) {
    for (int j = 0; j <= kAcross; ++j) {
      const float u = static_cast<float>(i) / kAlong, v = 2 * static_cast<float>(j) / kAcross - 1;
      mesh.vertices.push_back({blade(u, v), blade.normal(u, v), u, v});
    }
  }
  add_grid_triangles(mesh, 0, kAlong, kAcross);
  add_stalk(mesh, blade);
  return mesh;
}

}  // namespace wisp::drawing
