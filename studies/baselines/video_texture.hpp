#pragma once
// A video texture: recorded frames, and from which of them one may go on at which other.
//
// Source: A. Schödl, R. Szeliski, D. H. Salesin & I. Essa, "Video Textures", SIGGRAPH 2000, sections 3.1 (distances,
// probabilities), 3.2 (motion is kept by comparing frames with their neighbours; the future cost of a jump, which keeps
// play from dead ends) and 3.3 (few jumps are kept a frame, those that are best among their neighbours). Departures: a
// frame is an outline's control points and not its pixels; jumps are pruned before their future cost is found, so that
// minutes fit into memory; a jump may also cost by how unlike the wind there is to the wind now, as section 6's video
// sprites are steered by where they are to go.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "studies/baselines/frames.hpp"

namespace wisp::baselines {

/// How to learn.
struct VideoTextureOptions {
  int jumps = 5;  ///< kept a frame, >= 1, the natural follower among them
  double looseness =
      0.001;             ///< sigma over the mean distance between frames, > 0: higher jumps more, and less smoothly;
                         ///< where a thing is often at rest, 0.05 never leaves it: all frames of rest are alike
  double future = 0.99;  ///< alpha, what a later jump's cost counts for, 0 to below 1
  double steering = 0;   ///< cost of wind 1 away from the wind now, in sigma, >= 0; 0: the wind is not looked at
};

/// A place to go on at.
struct Jump {
  std::uint32_t to = 0;
  double distance = 0;  ///< D': of the frame that would follow from the one that follows here, with their neighbours
  double cost = 0;      ///< D'': that and its future
};

/// Frames and jumps. A frame without jumps is a dead end.
struct VideoTexture {
  Eigen::MatrixXd frames;  ///< frames × outputs
  Eigen::VectorXd wind;
  std::vector<std::vector<Jump>> jumps;  ///< one list a frame
  double sigma = 1;
  double steering = 0;

  std::size_t jump_count() const;
  /// As a game would keep it: 2 bytes a coordinate, 4 and 4 a jump, and 2 of wind a frame where it steers.
  std::size_t bytes() const;
};

/// Learns a video texture.
///
/// Precondition: there are frames, one stretch at least five long.
VideoTexture learn_video_texture(std::span<const Frames> frames, const VideoTextureOptions& options = {});

/// Plays one. Without noise it takes the cheapest jump and not one by chance.
class VideoTexturePlayer {
 public:
  VideoTexturePlayer(const VideoTexture& texture, std::uint64_t seed, bool noise);

  /// Goes on by one frame in that wind; returns its outputs.
  Eigen::VectorXd step(double wind);
  std::size_t frame() const { return frame_; }

 private:
  const Jump& choose(double wind);

  const VideoTexture& texture_;
  NormalStream random_;
  bool noise_;
  std::size_t frame_ = 0;
};

}  // namespace wisp::baselines
