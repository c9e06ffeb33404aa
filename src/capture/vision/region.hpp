#pragma once
// Connected bright regions of a picture, and the line around one of them.
//
// A region is a maximal set of pixels brighter than a level, connected by sides or corners. Only its outer boundary is
// followed, so enclosed holes (a wick, a dark core) belong to the region.

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "wisp/capture/vision/image.hpp"

namespace wisp {

/// A bright region.
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
  /// All regions of pixels above `level`, largest first, without those under `min_area` pixels.
  /// The span is valid until the next call.
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
  std::vector<BrightRegion> regions_;  // until all rows are seen
  std::vector<BrightRegion> found_;
};

/// Follows the outer boundary of the region at `seed`, clockwise on the screen, starting there: each pixel touches the
/// next by side or corner and lies in the region. Appends to `boundary`, which is cleared first.
///
/// Precondition: seed is the leftmost pixel of the region's first row.
void follow_boundary(const ImageView& image, int level, PixelPosition seed, std::vector<PixelPosition>& boundary);

/// Length of a vector in the picture. std::hypot, which guards against overflow that pixels cannot reach, takes ten
/// times as long.
inline double length(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace wisp
