#pragma once
// What baselines learn from: frames of an outline as rows of numbers, and the wind in them.

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::baselines {

/// Consecutive complete frames: no history crosses from one of these to the next.
struct Frames {
  Eigen::MatrixXd outputs;  ///< frames × outputs
  Eigen::VectorXd wind;     ///< one a frame

  Eigen::Index size() const { return wind.size(); }
};

/// The stretches of recordings in which all `outputs` and `wind` are known, those of at least `least` frames.
/// Errors: a channel that a recording has not.
Result<std::vector<Frames>> frames_of(std::span<const Recording> recordings, const std::vector<std::string>& outputs,
                                      const std::string& wind, Eigen::Index least = 16);

/// Mean of every output over all frames.
///
/// Precondition: there are frames.
Eigen::VectorXd mean_of(std::span<const Frames> frames);

/// Independent standard normal numbers, one after the other.
class NormalStream {
 public:
  explicit NormalStream(std::uint64_t seed) : seed_(seed) {}

  double next();
  /// Evenly spread in [0, 1).
  double uniform();
  Eigen::VectorXd next(Eigen::Index count);

 private:
  std::uint32_t word();

  std::uint64_t seed_;
  std::uint64_t count_ = 0;
};

/// One frame of play: the wind in it, and the outputs that come out.
using Step = std::function<Eigen::VectorXd(double wind)>;

/// Plays a baseline along a wind, `warm_up` frames of the wind's end before its start thrown away: a recording of the
/// outputs, one row a sample of the wind; a missing sample is calm.
///
/// Precondition: the wind has samples.
Recording play_along(const Step& step, std::span<const double> wind, std::size_t warm_up,
                     const std::vector<std::string>& outputs, double rate_hz);

}  // namespace wisp::baselines
