#include "wisp/draw/leaf.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "draw/cairo.hpp"
#include "draw/leaf/leaf_view.hpp"

namespace wisp {

using namespace drawing;

namespace {

constexpr float kSharpest = 0.0015F;  // metres of blur that even a leaf on the floor has
constexpr float kLargestBlur = 160;   // pixels; wider shadows are too thin to be seen

Vec3 towards_lamp(const LeafRoom& room) {
  Vec3 way = vec3(room.lamp);
  const bool usable = std::isfinite(way.x + way.y + way.z) && way.z > 0;
  return unit(usable ? way : Vec3{0, 0, 1});
}

// Two passes of a box, as near to a Gaussian as a shadow needs, along rows (step 1) or columns.
void blur_line(std::vector<float>& line, std::vector<float>& sums, int radius) {
  const int count = static_cast<int>(line.size());
  for (int pass = 0; pass < 2; ++pass) {
    sums.assign(static_cast<std::size_t>(count) + 1, 0);
    for (int k = 0; k < count; ++k)
      sums[static_cast<std::size_t>(k) + 1] = sums[static_cast<std::size_t>(k)] + line[static_cast<std::size_t>(k)];
    for (int k = 0; k < count; ++k) {
      const int first = std::max(0, k - radius), last = std::min(count, k + radius + 1);
      line[static_cast<std::size_t>(k)] =
          (sums[static_cast<std::size_t>(last)] - sums[static_cast<std::size_t>(first)]) /
          static_cast<float>(2 * radius + 1);
    }
  }
}

void blur(LeafPatch& patch, int radius_x, int radius_y) {
  std::vector<float> line, sums;
  for (int y = 0; y < patch.height && radius_x > 0; ++y) {
    const auto row = patch.cover.begin() + static_cast<std::ptrdiff_t>(y) * patch.width;
    line.assign(row, row + patch.width);
    blur_line(line, sums, radius_x);
    std::copy(line.begin(), line.end(), row);
  }
  line.resize(static_cast<std::size_t>(patch.height));
  for (int x = 0; x < patch.width && radius_y > 0; ++x) {
    for (int y = 0; y < patch.height; ++y)
      line[static_cast<std::size_t>(y)] = patch.cover[static_cast<std::size_t>(y) * patch.width + x];
    blur_line(line, sums, radius_y);
    for (int y = 0; y < patch.height; ++y)
      patch.cover[static_cast<std::size_t>(y) * patch.width + x] = line[static_cast<std::size_t>(y)];
  }
}

// Darkens what is there by the patch's cover.
void lay_shadow(Image& image, const LeafPatch& patch, float opacity) {
  const Tone& tone = Tone::get();
  for (int y = std::max(0, -patch.y); y < std::min(patch.height, image.height() - patch.y); ++y) {
    for (int x = std::max(0, -patch.x); x < std::min(patch.width, image.width() - patch.x); ++x) {
      const float cover = opacity * patch.cover[static_cast<std::size_t>(y) * patch.width + x];
      if (cover < 1.0F / 512) continue;
      std::uint32_t& pixel = image.row(patch.y + y)[static_cast<std::size_t>(patch.x + x)];
      const Light there{tone.linear(pixel >> 16 & 0xFFU), tone.linear(pixel >> 8 & 0xFFU), tone.linear(pixel & 0xFFU)};
      // The sky still lights a shadow, so it is a little bluer than the floor.
      const Light kept{1 - kDarkest * cover, 1 - 0.97F * kDarkest * cover, 1 - 0.92F * kDarkest * cover};
      blend(pixel, there * kept, 1, dither_at(patch.x + x, patch.y + y));
    }
  }
}

void lay_leaf(Image& image, const LeafPatch& patch, float opacity) {
  for (int y = 0; y < patch.height; ++y) {
    for (int x = 0; x < patch.width; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * patch.width + x;
      const float cover = std::min(patch.cover[at], 1.0F);
      if (cover <= 0) continue;
      const int px = patch.x + x, py = patch.y + y;
      if (px < 0 || py < 0 || px >= image.width() || py >= image.height()) continue;
      blend(image.row(py)[static_cast<std::size_t>(px)], 1 / cover * patch.light[at], opacity * cover,
            dither_at(px, py));
    }
  }
}

void cast_shadow(Image& image, const LeafMesh& mesh, const PlacedLeaf& leaf, float opacity, Vec3 lamp,
                 const LeafView& view) {
  const float height = std::max(leaf.position.z, 0.0F);
  const Vec3 spot = leaf.position - height / lamp.z * lamp;
  const Projected place = view(spot);
  if (!(place.depth > kNear)) return;
  const float wide = (kSharpest + kLampRadius * height / lamp.z) * view.scale_at(place.depth);
  // Seen from the side the floor is foreshortened, and so is the blur.
  const Vec3 way = unit(spot - view.eye());
  const int radius_x = static_cast<int>(std::lround(std::min(wide / 2, kLargestBlur)));
  const int radius_y = static_cast<int>(std::lround(std::min(wide / 2 * std::abs(way.z), kLargestBlur)));
  LeafPatch patch =
      shadow_patch(mesh, leaf, lamp, view, image.width(), image.height(), 2 * std::max(radius_x, radius_y) + 1);
  if (patch.empty()) return;
  blur(patch, radius_x, radius_y);
  lay_shadow(image, patch, opacity);
}

void draw_trail(Image& image, const DrawnLeaf& leaf, const LeafView& view) {
  if (leaf.trail.size() < 2) return;
  const CairoContext context = context_of(image);
  cairo_set_line_cap(context.get(), CAIRO_LINE_CAP_BUTT);
  Colour colour = leaf.style.margin;
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

}  // namespace

LeafCamera leaf_camera_from_side(float height) {
  // The floor's near edge comes into the picture's last eighth.
  const float middle = 0.40F * height;
  return {{0, -3.2F * height, 0.86F * height}, {0, 0, middle}, height};
}

LeafCamera leaf_camera_from_above(std::array<float, 3> middle, float view_height) {
  return {{middle[0], middle[1], middle[2] + 3.2F * view_height}, middle, view_height};
}

Image draw_leaf_room(int width, int height, const LeafCamera& camera, const LeafRoom& room) {
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
        // A floor that turns into the backdrop without an edge, and a pool of light around the middle.
        const float far = std::hypot(there.x - target.x, there.y - target.y) / reach;
        const float away = smooth_step(0.5F, 2.2F, far);
        const float pool = 1 - 0.07F * smooth_step(0.2F, 1.8F, far);
        const Light ground = pool * floor;
        const bool steep = view.gaze().z < -0.999F;
        light = steep ? ground : (1 - away) * ground + away * backdrop;
      }
      blend(image.row(y)[static_cast<std::size_t>(x)], light, 1, dither_at(x, y));
    }
  }
  return image;
}

void draw_leaves(Image& image, std::span<const DrawnLeaf> leaves, const LeafCamera& camera, const LeafRoom& room) {
  const LeafView view(camera, image.width(), image.height());
  const Vec3 lamp = towards_lamp(room);
  std::vector<const DrawnLeaf*> order;
  for (const DrawnLeaf& leaf : leaves) {
    if (is_drawable(leaf.pose)) order.push_back(&leaf);
  }
  const auto depth = [&](const DrawnLeaf* leaf) { return dot(vec3(leaf->pose.position) - view.eye(), view.gaze()); };
  std::stable_sort(order.begin(), order.end(), [&](auto* a, auto* b) { return depth(a) > depth(b); });
  const auto placed = [](const DrawnLeaf& leaf) {
    return PlacedLeaf{vec3(leaf.pose.position), Turn(leaf.pose.attitude)};
  };
  const auto opacity = [](const DrawnLeaf& leaf) { return std::clamp(leaf.opacity, 0.0F, 1.0F); };
  std::vector<LeafMesh> meshes;
  for (const DrawnLeaf* leaf : order) {
    meshes.push_back(leaf_mesh(leaf->style));
    cast_shadow(image, meshes.back(), placed(*leaf), opacity(*leaf), lamp, view);
  }
  for (const DrawnLeaf* leaf : order) draw_trail(image, *leaf, view);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const LeafSurface surface(order[k]->style, lamp);
    const LeafPatch patch = leaf_patch(meshes[k], placed(*order[k]), surface, view, image.width(), image.height());
    lay_leaf(image, patch, opacity(*order[k]));
  }
}

}  // namespace wisp
