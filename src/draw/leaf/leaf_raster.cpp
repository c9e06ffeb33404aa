#include "draw/leaf/leaf_view.hpp"

#include <algorithm>
#include <limits>

namespace wisp::drawing {
namespace {

constexpr int kLargestPatch = 4096;

// Samples of a pixel along each side: fewer where a leaf fills the picture, whose edge is then a small part of it and
// whose samples would fill the memory.
int samples_a_side(const LeafPatch& patch) {
  const long long pixels = static_cast<long long>(patch.width) * patch.height;
  return pixels <= 400'000 ? 4 : pixels <= 2'500'000 ? 2 : 1;
}

// A corner of a triangle in samples of the patch.
struct Corner {
  float x, y, depth;
  const LeafVertex* vertex;
};

// Samples of a patch, nearest surface first.
struct Samples {
  Samples(const LeafPatch& patch, int samples_side)
      : side(samples_side), width(patch.width * side), height(patch.height * side) {
    const auto count = static_cast<std::size_t>(width) * height;
    depth.assign(count, std::numeric_limits<float>::infinity());
    u.resize(count);
    v.resize(count);
    normal.resize(count);
  }

  int side;  // samples of a pixel along each side
  int width, height;
  std::vector<float> depth, u, v;
  std::vector<Vec3> normal;
};

float edge(const Corner& a, const Corner& b, float x, float y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

void fill(Samples& samples, const Corner& a, const Corner& b, const Corner& c) {
  const float area = edge(a, b, c.x, c.y);
  if (!(std::abs(area) > 1e-9F)) return;
  // Held to the patch before they are whole numbers: a corner near the camera may be millions of samples away.
  const auto held = [](float at, int most) {
    return static_cast<int>(std::clamp(at, -1.0F, static_cast<float>(most)));
  };
  const int left = std::max(0, held(std::floor(std::min({a.x, b.x, c.x})), samples.width));
  const int right = std::min(samples.width - 1, held(std::ceil(std::max({a.x, b.x, c.x})), samples.width));
  const int top = std::max(0, held(std::floor(std::min({a.y, b.y, c.y})), samples.height));
  const int bottom = std::min(samples.height - 1, held(std::ceil(std::max({a.y, b.y, c.y})), samples.height));
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const float px = static_cast<float>(x) + 0.5F, py = static_cast<float>(y) + 0.5F;
      const float wa = edge(b, c, px, py) / area, wb = edge(c, a, px, py) / area, wc = 1 - wa - wb;
      if (wa < 0 || wb < 0 || wc < 0) continue;
      const float depth = wa * a.depth + wb * b.depth + wc * c.depth;
      const std::size_t at = static_cast<std::size_t>(y) * samples.width + x;
      if (depth >= samples.depth[at]) continue;
      const float u = wa * a.vertex->u + wb * b.vertex->u + wc * c.vertex->u;
      const float v = wa * a.vertex->v + wb * b.vertex->v + wc * c.vertex->v;
      if (!on_blade(u, v)) continue;
      samples.depth[at] = depth;
      samples.u[at] = u;
      samples.v[at] = v;
      samples.normal[at] = wa * a.vertex->normal + wb * b.vertex->normal + wc * c.vertex->normal;
    }
  }
}

// Where the vertices come to be, and the patch of pixels around them; empty where one is behind the camera.
struct Footprint {
  std::vector<Projected> corners;
  LeafPatch patch;
};

template <class Place>
Footprint footprint(const LeafMesh& mesh, const LeafView& view, int width, int height, int margin, Place place) {
  Footprint print;
  print.corners.reserve(mesh.vertices.size());
  float left = 1e9F, right = -1e9F, top = 1e9F, bottom = -1e9F;
  for (const LeafVertex& vertex : mesh.vertices) {
    const Projected p = view(place(vertex.place));
    if (!(p.depth > kNear) || !std::isfinite(p.x + p.y)) return {};
    left = std::min(left, p.x), right = std::max(right, p.x);
    top = std::min(top, p.y), bottom = std::max(bottom, p.y);
    print.corners.push_back(p);
  }
  const auto held = [margin](float at, int most) {
    return static_cast<int>(std::clamp(at, static_cast<float>(-margin), static_cast<float>(most + margin)));
  };
  LeafPatch& patch = print.patch;
  patch.x = held(std::floor(left) - static_cast<float>(margin), width);
  patch.y = held(std::floor(top) - static_cast<float>(margin), height);
  patch.width = std::min(kLargestPatch, held(std::ceil(right) + static_cast<float>(margin), width) - patch.x);
  patch.height = std::min(kLargestPatch, held(std::ceil(bottom) + static_cast<float>(margin), height) - patch.y);
  return print;
}

Samples sampled(const LeafMesh& mesh, const Footprint& print) {
  Samples samples(print.patch, samples_a_side(print.patch));
  const auto side = static_cast<float>(samples.side);
  const auto corner = [&](int k) {
    const Projected& p = print.corners[static_cast<std::size_t>(k)];
    return Corner{(p.x - static_cast<float>(print.patch.x)) * side, (p.y - static_cast<float>(print.patch.y)) * side,
                  p.depth, &mesh.vertices[static_cast<std::size_t>(k)]};
  };
  for (const auto& t : mesh.triangles) fill(samples, corner(t[0]), corner(t[1]), corner(t[2]));
  return samples;
}

// Calls `add(pixel, sample)` for every sample that is covered.
template <class Add>
void for_covered(const Samples& samples, const LeafPatch& patch, Add add) {
  for (int y = 0; y < samples.height; ++y) {
    for (int x = 0; x < samples.width; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * samples.width + x;
      if (std::isinf(samples.depth[at])) continue;
      add(static_cast<std::size_t>(y / samples.side) * patch.width + x / samples.side, at);
    }
  }
}

}  // namespace

bool is_drawable(const LeafPose& pose) {
  float sum = 0, square = 0;
  for (const float part : pose.position) sum += part;
  for (const float part : pose.attitude) square += part * part;
  return std::isfinite(sum) && std::isfinite(square) && square > 1e-12F;
}

LeafPatch leaf_patch(const LeafMesh& mesh, const PlacedLeaf& leaf, const LeafSurface& surface, const LeafView& view,
                     int width, int height) {
  Footprint print =
      footprint(mesh, view, width, height, 0, [&](Vec3 place) { return leaf.position + leaf.turn(place); });
  LeafPatch& patch = print.patch;
  if (patch.empty()) return {};
  const Samples samples = sampled(mesh, print);
  const auto pixels = static_cast<std::size_t>(patch.width) * patch.height;
  patch.light.resize(pixels);
  patch.cover.resize(pixels);
  const Vec3 to_eye = unit(view.eye() - leaf.position);
  const float share = 1.0F / static_cast<float>(samples.side * samples.side);
  for_covered(samples, patch, [&](std::size_t pixel, std::size_t at) {
    const Vec3 normal = unit(leaf.turn(samples.normal[at]));
    patch.light[pixel] = patch.light[pixel] + share * surface.seen(samples.u[at], samples.v[at], normal, to_eye);
    patch.cover[pixel] += share;
  });
  return std::move(patch);
}

LeafPatch shadow_patch(const LeafMesh& mesh, const PlacedLeaf& leaf, Vec3 towards_lamp, const LeafView& view, int width,
                       int height, int margin) {
  Footprint print = footprint(mesh, view, width, height, margin, [&](Vec3 place) {
    const Vec3 there = leaf.position + leaf.turn(place);
    return there - std::max(there.z, 0.0F) / towards_lamp.z * towards_lamp;
  });
  LeafPatch& patch = print.patch;
  if (patch.empty()) return {};
  const Samples samples = sampled(mesh, print);
  const float share = 1.0F / static_cast<float>(samples.side * samples.side);
  patch.cover.resize(static_cast<std::size_t>(patch.width) * patch.height);
  for_covered(samples, patch, [&](std::size_t pixel, std::size_t) { patch.cover[pixel] += share; });
  return std::move(patch);
}

}  // namespace wisp::drawing
