#pragma once
// A dynamic texture: linear dynamics on the principal components of frames.
//
// Source: G. Doretto, A. Chiuso, Y. N. Wu & S. Soatto, "Dynamic Textures", International Journal of Computer Vision 51
// (2003), section 4 (the closed form): y = mean + C x, x(t+1) = A x(t) + B v(t), v white; C are principal components, A
// follows by least squares, B B' is the covariance of what that leaves. Departures: an input may be added to the state,
// x(t+1) = A x(t) + G (u(t+1) − mean u) + B v(t), which the paper has not; an A that is not stable is scaled until it
// is.

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "studies/baselines/frames.hpp"

namespace wisp::baselines {

/// How to learn.
struct DynamicTextureOptions {
  double variance = 0.995;  ///< share of the frames' variance that components carry, above 0 to 1
  bool driven = false;      ///< the wind acts on the state
  double radius = 0.999;    ///< most that a pole may be from 0, below 1
};

/// A dynamic texture.
struct DynamicTexture {
  Eigen::VectorXd mean;
  Eigen::MatrixXd c;  ///< outputs × states, orthonormal columns
  Eigen::MatrixXd a;  ///< states × states
  Eigen::VectorXd g;  ///< the wind's gain; 0 where it is not driven
  Eigen::MatrixXd b;  ///< states × states
  double mean_wind = 0;
  bool driven = false;
  double found_radius = 0;  ///< of A before it was made stable

  Eigen::Index states() const { return a.rows(); }
  /// In single precision.
  std::size_t bytes() const;
  /// Multiplications and additions of a frame, without what random numbers cost.
  std::int64_t operations() const;
};

/// Learns a dynamic texture.
///
/// Precondition: there are frames, more than twice as many as outputs.
DynamicTexture learn_dynamic_texture(std::span<const Frames> frames, const DynamicTextureOptions& options = {});

/// Plays one from its mean.
class DynamicTexturePlayer {
 public:
  DynamicTexturePlayer(const DynamicTexture& texture, std::uint64_t seed, bool noise);
  Eigen::VectorXd step(double wind);

 private:
  const DynamicTexture& texture_;
  NormalStream random_;
  bool noise_;
  Eigen::VectorXd state_;
};

}  // namespace wisp::baselines
