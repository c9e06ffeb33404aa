// The surface of a body from its rings (wisp/run/body_facet.hpp).

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "wisp/run/body_facet.hpp"

namespace wisp {
namespace {

constexpr int kMaxRingSegments = 256, kMaxRings = 1 << 20;

struct Vector {
  float x, y, z;
};

// Returns cosine and sine, computed by their series to give the same bits with every standard library.
std::pair<float, float> direction(double angle) {
  double sums[] = {0, 0}, term = 1;
  for (int k = 0; k < 24; ++k) {
    sums[k % 2] += k % 4 < 2 ? term : -term;
    term *= angle / (k + 1);
  }
  return {static_cast<float>(sums[0]), static_cast<float>(sums[1])};
}

// Returns the vertex of a ring in the horizontal direction (x, z).
Vector rim(const float* ring, float x, float z) {
  return {ring[0] + ring[3] * x, ring[1] + ring[4] * x + ring[5] * z, ring[2] + ring[3] * z};
}

Vector normal_of(Vector around, Vector from, Vector to) {
  const Vector up{to.x - from.x, to.y - from.y, to.z - from.z};
  const Vector n{up.y * around.z - up.z * around.y, up.z * around.x - up.x * around.z,
                 up.x * around.y - up.y * around.x};
  const float length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
  return length > 1e-12f ? Vector{n.x / length, n.y / length, n.z / length} : Vector{0, 1, 0};
}

}  // namespace

bool ring_mesh(std::span<const float> rings, int segments, std::span<float> numbers, std::size_t stride) {
  if (rings.size() < 2 * kRingNumbers || segments < 3 || segments > kMaxRingSegments || stride < kVertexNumbers)
    return false;
  const std::size_t count = rings.size() / kRingNumbers, last = count - 1;
  if (numbers.size() / count / static_cast<std::size_t>(segments) < stride) return false;
  const auto [step_x, step_z] = direction(2 * std::numbers::pi / segments);
  float* out = numbers.data();
  for (std::size_t k = 0; k <= last; ++k) {
    const float* ring = &rings[k * kRingNumbers];
    const float *below = k > 0 ? ring - kRingNumbers : ring, *above = k < last ? ring + kRingNumbers : ring;
    float x = 1, z = 0;
    for (int n = 0; n < segments; ++n, out += stride) {
      const Vector place = rim(ring, x, z), around{-z * ring[3], ring[5] * x - ring[4] * z, x * ring[3]};
      const Vector normal = normal_of(around, rim(below, x, z), rim(above, x, z));
      std::copy_n(&place.x, 3, out);
      std::copy_n(&normal.x, 3, out + 3);
      const float turned = x * step_x - z * step_z;
      z = x * step_z + z * step_x;
      x = turned;
    }
  }
  return true;
}

bool ring_triangles(int rings, int segments, std::span<std::uint32_t> indices) {
  if (rings < 2 || rings > kMaxRings || segments < 3 || segments > kMaxRingSegments) return false;
  if (indices.size() != 3 * static_cast<std::size_t>(ring_triangle_count(rings, segments))) return false;
  auto out = indices.begin();
  const auto add = [&](int a, int b, int c) {
    for (int index : {a, b, c}) *out++ = static_cast<std::uint32_t>(index);
  };
  const int tip = (rings - 1) * segments;
  for (int k = 0; k < tip; ++k) {
    const int next = k % segments + 1 < segments ? k + 1 : k + 1 - segments;
    add(k, k + segments, next);
    add(next, k + segments, next + segments);
  }
  for (int k = 1; k + 1 < segments; ++k) {
    add(0, k, k + 1);
    add(tip, tip + k + 1, tip + k);
  }
  return true;
}

}  // namespace wisp
