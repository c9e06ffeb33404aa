#include "draw/leaf/leaf_mesh.hpp"

#include <algorithm>

namespace wisp::drawing {
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
