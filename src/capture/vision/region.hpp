#pragma once
// Finds the connected bright regions of a picture, the outer boundary of a region, and the boundary between an object
// and its stand where both have merged into one region.
//
// A region is a maximal set of pixels brighter than a level, connected by sides or corners. Only its outer boundary is
// followed, so enclosed holes (a wick, a dark core) belong to the region.
//
// A flame touches lit wax, its pool or the wick's holder by a few bright pixels or by its whole base. From the tip
// down, the region then widens abruptly at the shoulder. A slanted, hollow or pointed base has no shoulder.

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "wisp/capture/vision/image.hpp"

namespace wisp {

struct BrightRegion {
  Region box;             ///< bounding box
  std::int64_t area = 0;  ///< number of bright pixels, without holes
  int seed_x = 0;         ///< leftmost pixel of its first row, where its boundary starts
  int seed_y = 0;
};

/// Position of a pixel.
struct PixelPosition {
  int x = 0;
  int y = 0;
  friend bool operator==(const PixelPosition&, const PixelPosition&) = default;
};

/// Finds bright regions; reuses its memory between pictures.
class RegionFinder {
 public:
  /// Returns the regions above `level` of at least `min_area` pixels, largest first; valid until the next call.
  std::span<const BrightRegion> find(const ImageView& image, int level, std::int64_t min_area);

 private:
  struct Run {
    int begin = 0;
    int end = 0;
    int region = 0;
  };
  int root(int region);
  int join(int a, int b);
  void find_runs(const std::uint8_t* row, int width, int level, std::vector<Run>& runs);
  void connect(std::vector<Run>& runs, const std::vector<Run>& above, int y);
  int new_region(const Run& run, int y);
  void add(int region, const Run& run, int y);

  std::vector<std::uint8_t> bright_;
  std::vector<Run> runs_;
  std::vector<Run> above_;
  std::vector<int> parent_;
  std::vector<BrightRegion> regions_;  // regions of the rows so far, some joined to another
  std::vector<BrightRegion> found_;
};

inline constexpr int kMinStep = 3;  ///< pixels: a smaller step of a boundary is noise

/// Follows the outer boundary of the region at `seed`, clockwise on the screen, starting there: each pixel touches the
/// next by side or corner and lies in the region. Replaces the contents of `boundary`. Precondition: seed is the
/// leftmost pixel of the region's first row.
void follow_boundary(const ImageView& image, int level, PixelPosition seed, std::vector<PixelPosition>& boundary);

/// Length of a vector. std::hypot, which guards against overflow that pixels cannot reach, takes ten times as long.
inline double length(double x, double y) { return std::sqrt(x * x + y * y); }

/// One row of a profile: coordinates of its first and last pixel.
struct ProfileRow {
  int low = 0;
  int high = 0;
  int width() const { return high - low + 1; }
};

/// Width of a region in each row from tip to base, holes included. Where the base is left or right, rows are columns.
struct Profile {
  int first = 0;  ///< depth of the first row: a coordinate that increases towards the base
  std::vector<ProfileRow> rows;
};

/// Computes the profile of a boundary's interior, for a base on `side`; reuses the profile's memory.
void measure_profile(std::span<const PixelPosition> boundary, BaseSide side, Profile& profile);

/// Converts a picture coordinate `edge` to depth, which increases towards the base; the function is its own inverse.
int depth_of(int edge, BaseSide side);

/// Coordinate of the last row (or column) of `box` towards the base.
int base_edge(const Region& box, BaseSide side);

/// Returns by how many pixels `edge` lies beyond `other` towards the base; negative if it lies before.
int deeper(int edge, int other, BaseSide side);

/// Returns the part of `place` on the object's side of `edge`, which is included.
Region above_edge(const Region& place, int edge, BaseSide side);

/// Returns the index, at least `from`, of the last row above the sharpest shoulder; none if there is no shoulder.
std::optional<std::size_t> find_shoulder(const Profile& profile, std::size_t from);

}  // namespace wisp
