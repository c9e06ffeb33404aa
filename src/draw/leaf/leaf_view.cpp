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

}  // namespace wisp::drawing
