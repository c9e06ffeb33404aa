#pragma once
// Finds the thing in each frame, near where it was in the one before, and gives its edge points.

#include <cstdint>
#include <vector>

#include "capture/vision/edge_cloud.hpp"
#include "capture/vision/region.hpp"
#include "capture/vision/shoulder.hpp"
#include "capture/vision/survey.hpp"
#include "wisp/capture/vision/picture.hpp"

namespace wisp {

class OutlineSeeker {
 public:
  /// `area` is where the thing may be at all, `base` the side on which it is held.
  OutlineSeeker(const Survey& survey, const Region& area, BaseSide base, bool dark);

  /// Looks for the thing in the next frame. Returns whether it is there.
  bool seek(const Picture& picture);

  /// The edge points of the thing as it was found last, while that picture lives. Returns whether there are enough.
  bool edge_points(const EdgeCloudOptions& options, EdgeCloud& cloud) const;

  /// Mean absolute difference between this frame and the one before, in the thing's neighbourhood.
  double change() const { return change_; }
  /// Mean brightness of the thing's pixels, 0 to 255.
  double brightness() const { return brightness_; }
  /// Where nothing was found in its place: whether something as bright and about as large stands elsewhere.
  bool elsewhere() const { return elsewhere_; }
  const BrightRegion& found() const { return found_; }

 private:
  /// The part of the picture that is looked at, as one plane, and where it lies.
  struct Window {
    Region place;
    ImageView image;
  };
  Window open(const Picture& picture, const Region& place);
  bool find_in(const Picture& picture, Region place);
  bool part_from_stand();
  void follow();
  bool ours(const Region& box) const;
  bool alike() const;
  bool plausible(const Region& before) const;
  bool choose(std::span<const BrightRegion> regions, const Region& place);
  int margin() const;
  /// Row y of the picture in the window, such that column x of the picture is element x.
  const std::uint8_t* window_row(int y) const { return window_.image.row(y - window_.place.y) - window_.place.x; }
  void measure_change();
  void measure_brightness(const Picture& picture);

  PixelChannel channel_;
  int level_;
  BaseSide base_;
  bool dark_;
  Region area_;
  Region home_;
  std::vector<Region> others_;  // other flames, where they were when this one was at usual_
  Region usual_;                // where the thing usually was in the survey
  bool stands_;                 // it has mostly run together with what it stands on
  bool following_ = false;
  double usual_area_;
  int base_edge_;  // where the thing ended when it last stood alone
  BrightRegion found_;
  PixelPosition last_foot_;  // the middle of its end towards the base, when it was last there
  int pace_ = 0;             // how far the box's sides moved in the last frames, pixels a frame
  Window window_;
  std::vector<std::uint8_t> plane_;
  Region before_place_;
  std::vector<std::uint8_t> before_;
  double change_ = 0;
  double brightness_ = 0;
  double usual_brightness_ = 0;
  bool elsewhere_ = false;
  RegionFinder finder_;
  std::vector<PixelPosition> boundary_;
  Profile profile_;
};

}  // namespace wisp
