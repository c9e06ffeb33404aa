#pragma once
// Locates the object in each frame near the object's last place, and computes its edge points.

#include <cstdint>
#include <vector>

#include "capture/vision/edge_cloud.hpp"
#include "capture/vision/region.hpp"
#include "capture/vision/survey.hpp"
#include "wisp/capture/vision/picture.hpp"

namespace wisp {

class OutlineSeeker {
 public:
  /// `area` limits the search; `base` is the side on which the object is held.
  OutlineSeeker(const Survey& survey, const Region& area, BaseSide base, bool dark);

  /// Searches the next frame. Returns whether the object was found.
  bool seek(const Picture& picture);

  /// Computes the edge points of the object found last, whose picture must still exist. Returns whether they suffice.
  bool edge_points(const EdgeCloudOptions& options, EdgeCloud& cloud) const;

  /// Mean absolute difference of the last two frames with the object, near the object; 255 if the object moved away.
  double change() const { return change_; }
  /// Mean brightness of the object's pixels, 0 to 255.
  double brightness() const { return brightness_; }
  /// After a failed search: whether a region of similar brightness and size is elsewhere.
  bool elsewhere() const { return elsewhere_; }
  const BrightRegion& found() const { return found_; }

 private:
  /// The searched part of the picture as one plane, and its position.
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
  /// Returns a pointer to row y of the picture, of which element x is column x; both must lie in the window.
  const std::uint8_t* window_row(int y) const { return window_.image.row(y - window_.place.y) - window_.place.x; }
  void measure_change();
  void measure_brightness(const Picture& picture);

  PixelChannel channel_;
  int level_;
  BaseSide base_;
  bool dark_;
  Region area_;
  Region home_;
  std::vector<Region> others_;  // usual places of the other flames in the survey
  Region usual_;                // usual place of the object in the survey
  bool stands_;                 // whether the object had merged with its stand in the survey
  bool following_ = false;
  double usual_area_;
  int base_edge_;  // coordinate of the base when the object was last separate from a stand
  BrightRegion found_;
  PixelPosition last_foot_;  // midpoint of the object's end towards the base, when last seen
  int pace_ = 0;             // recent motion of the box's sides, pixels a frame
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
