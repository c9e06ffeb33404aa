#include "studies/baselines/video_texture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>

namespace wisp::baselines {
namespace {

// D'(r, j) = sum of weight k times D(r + k − 2, j + k − 2): four taps of the binomial filter, two before and two from
// here on, as section 3.2 weights them.
constexpr std::array<float, 4> kTaps{0.125F, 0.375F, 0.375F, 0.125F};
constexpr Eigen::Index kBefore = 2;
constexpr double kDeadEnd = 10;  // times the mean distance: no jump is as bad
constexpr int kSweeps = 2000;
constexpr double kSettled = 1e-6;

// All frames one after the other, and how far each is from its stretch's ends.
struct Strip {
  Eigen::MatrixXf frames;  // outputs × frames
  Eigen::VectorXf wind;
  std::vector<char> whole;  // all taps lie within the frame's stretch
};

Strip strip_of(std::span<const Frames> frames) {
  Eigen::Index total = 0;
  for (const Frames& each : frames) total += each.size();
  Strip out{Eigen::MatrixXf(frames.front().outputs.cols(), total), Eigen::VectorXf(total), {}};
  Eigen::Index at = 0;
  for (const Frames& each : frames) {
    out.frames.middleCols(at, each.size()) = each.outputs.transpose().cast<float>();
    out.wind.segment(at, each.size()) = each.wind.cast<float>();
    at += each.size();
    for (Eigen::Index row = 0; row < each.size(); ++row) {
      out.whole.push_back(row >= kBefore && row + 1 < each.size() ? 1 : 0);
    }
  }
  return out;
}

// D of one frame to all.
Eigen::VectorXf distances(const Strip& strip, Eigen::Index row) {
  return (strip.frames.colwise() - strip.frames.col(row)).colwise().norm().transpose();
}

// D' rows in ascending order; the four rows of D that one needs are kept from one to the next.
class MotionDistances {
 public:
  explicit MotionDistances(const Strip& strip) : strip_(strip) {}

  Eigen::VectorXf row(Eigen::Index row) {
    const Eigen::Index size = strip_.frames.cols();
    for (; !rows_.empty() && first_ < row - kBefore; ++first_) rows_.pop_front();
    if (rows_.empty()) first_ = row - kBefore;
    while (first_ + static_cast<Eigen::Index>(rows_.size()) < row - kBefore + 4) {
      rows_.push_back(distances(strip_, first_ + static_cast<Eigen::Index>(rows_.size())));
    }
    Eigen::VectorXf out = Eigen::VectorXf::Constant(size, std::numeric_limits<float>::infinity());
    const Eigen::Index inner = size - 3;
    out.segment(kBefore, inner).setZero();
    for (std::size_t k = 0; k < 4; ++k) {
      out.segment(kBefore, inner) += kTaps[k] * rows_[k].segment(static_cast<Eigen::Index>(k), inner);
    }
    for (Eigen::Index j = 0; j < size; ++j) {
      if (!strip_.whole[static_cast<std::size_t>(j)]) out[j] = std::numeric_limits<float>::infinity();
    }
    return out;
  }

 private:
  const Strip& strip_;
  std::deque<Eigen::VectorXf> rows_;
  Eigen::Index first_ = 0;
};

// The best places to go on at: where D' is lower than at both neighbours, the natural follower always.
std::vector<Jump> best_jumps(const Eigen::VectorXf& distance, Eigen::Index natural, int most) {
  std::vector<Jump> found;
  for (Eigen::Index j = 1; j + 1 < distance.size(); ++j) {
    const bool lowest = distance[j] <= distance[j - 1] && distance[j] <= distance[j + 1] && std::isfinite(distance[j]);
    if (lowest || j == natural) found.push_back({static_cast<std::uint32_t>(j), distance[j], 0});
  }
  const auto kept = std::min<std::size_t>(found.size(), static_cast<std::size_t>(most));
  // The natural follower's distance is 0, so that it is first.
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept), found.end(),
                    [](const Jump& a, const Jump& b) { return a.distance < b.distance; });
  found.resize(kept);
  return found;
}

double cheapest(const std::vector<Jump>& jumps, double none) {
  double least = none;
  for (const Jump& jump : jumps) least = std::min(least, jump.cost);
  return least;
}

// D'' = D' + alpha · min D'' from there, until nothing changes; from the last frame to the first, as the paper advises.
void find_future_costs(VideoTexture& texture, double future, double dead_end) {
  std::vector<double> least(texture.jumps.size(), 0.0);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double change = 0;
    for (std::size_t i = texture.jumps.size(); i-- > 0;) {
      for (Jump& jump : texture.jumps[i]) jump.cost = jump.distance + future * least[jump.to];
      const double now = cheapest(texture.jumps[i], dead_end);
      change = std::max(change, std::abs(now - least[i]));
      least[i] = now;
    }
    if (change < kSettled * dead_end) return;
  }
}

}  // namespace

std::size_t VideoTexture::jump_count() const {
  std::size_t count = 0;
  for (const auto& each : jumps) count += each.size();
  return count;
}

std::size_t VideoTexture::bytes() const {
  const auto values =
      static_cast<std::size_t>(frames.size()) + (steering > 0 ? static_cast<std::size_t>(wind.size()) : 0);
  return 2 * values + 8 * jump_count();
}

VideoTexture learn_video_texture(std::span<const Frames> frames, const VideoTextureOptions& options) {
  const Strip strip = strip_of(frames);
  const Eigen::Index size = strip.frames.cols();
  VideoTexture out{strip.frames.transpose().cast<double>(), strip.wind.cast<double>(), {}, 1, options.steering};
  out.jumps.resize(static_cast<std::size_t>(size));
  MotionDistances motion(strip);
  double sum = 0;
  double count = 0;
  for (Eigen::Index i = 0; i + 1 < size; ++i) {
    if (!strip.whole[static_cast<std::size_t>(i)] || !strip.whole[static_cast<std::size_t>(i + 1)]) continue;
    const Eigen::VectorXf row = motion.row(i + 1);
    for (Eigen::Index j = 0; j < size; ++j) {
      if (!std::isfinite(row[j])) continue;
      sum += row[j];
      count += 1;
    }
    out.jumps[static_cast<std::size_t>(i)] = best_jumps(row, i + 1, options.jumps);
  }
  const double mean = sum / count;
  out.sigma = options.looseness * mean;
  find_future_costs(out, options.future, kDeadEnd * mean);
  return out;
}

VideoTexturePlayer::VideoTexturePlayer(const VideoTexture& texture, std::uint64_t seed, bool noise)
    : texture_(texture), random_(seed), noise_(noise) {
  while (texture_.jumps[frame_].empty()) ++frame_;
}

const Jump& VideoTexturePlayer::choose(double wind) {
  const std::vector<Jump>& jumps = texture_.jumps[frame_];
  const auto cost = [&](const Jump& jump) {
    return jump.cost / texture_.sigma + texture_.steering * std::abs(texture_.wind[jump.to] - wind);
  };
  std::vector<double> costs;
  for (const Jump& jump : jumps) costs.push_back(cost(jump));
  const auto best = std::min_element(costs.begin(), costs.end());
  if (!noise_) return jumps[static_cast<std::size_t>(best - costs.begin())];
  const double least = *best;
  double total = 0;
  for (double& each : costs) total += each = std::exp(least - each);
  double left = random_.uniform() * total;
  std::size_t taken = 0;
  while (taken + 1 < costs.size() && left >= costs[taken]) left -= costs[taken++];
  return jumps[taken];
}

Eigen::VectorXd VideoTexturePlayer::step(double wind) {
  frame_ = choose(wind).to;
  return texture_.frames.row(static_cast<Eigen::Index>(frame_)).transpose();
}

}  // namespace wisp::baselines
