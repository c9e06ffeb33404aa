// A dynamic texture is the linear system that made the frames.

#include "studies/baselines/dynamic_texture.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

namespace wisp::baselines::dynamic_texture_test {
namespace {

constexpr Eigen::Index kFrames = 20000;

// Two states seen in five outputs: a resonance at 0.9 e^{±0.3i}, pushed by the wind.
struct Known {
  Eigen::Matrix2d a{{0.9 * std::cos(0.3), -0.9 * std::sin(0.3)}, {0.9 * std::sin(0.3), 0.9 * std::cos(0.3)}};
  Eigen::Vector2d g{0.5, 0.2};
  Eigen::MatrixXd c{{1, 0}, {0, 1}, {1, 1}, {0.5, -1}, {0, 0.3}};
  Eigen::VectorXd mean = Eigen::VectorXd::LinSpaced(5, 1, 3);

  Frames play(double noise, double wind) const {
    NormalStream random(7);
    Frames out{Eigen::MatrixXd(kFrames, 5), Eigen::VectorXd(kFrames)};
    Eigen::Vector2d x = Eigen::Vector2d::Zero();
    for (Eigen::Index t = 0; t < kFrames; ++t) {
      out.wind[t] = wind * random.next();
      x = a * x + g * out.wind[t] + noise * Eigen::Vector2d(random.next(2));
      out.outputs.row(t) = mean + c * x;
    }
    return out;
  }
};

double off(const Eigen::MatrixXd& found, const Eigen::MatrixXd& known) {
  double worst = 0;
  for (const std::complex<double>& pole : Eigen::VectorXcd(known.eigenvalues())) {
    worst = std::max(worst, (Eigen::VectorXcd(found.eigenvalues()).array() - pole).abs().minCoeff());
  }
  return worst;
}

TEST(DynamicTexture, RecoversTheSystemsPoles) {
  const Known known;
  const std::vector<Frames> frames{known.play(0.1, 0)};
  const DynamicTexture texture = learn_dynamic_texture(frames);
  ASSERT_EQ(texture.states(), 2);
  // A pole's standard error is about sqrt((1 − 0.81) / 20000) = 0.003.
  EXPECT_LT(off(texture.a, known.a), 0.01);
}

TEST(DynamicTexture, RecoversWhatTheWindDoes) {
  const Known known;
  const std::vector<Frames> frames{known.play(0.02, 1)};
  const DynamicTexture texture = learn_dynamic_texture(frames, {.driven = true});
  // As seen in the outputs: the states have axes of their own.
  EXPECT_LT((texture.c * texture.g - known.c * known.g).norm(), 0.01);
}

TEST(DynamicTexture, PlaysWithTheVarianceOfWhatItLearnedFrom) {
  const Known known;
  const std::vector<Frames> frames{known.play(0.1, 0)};
  const DynamicTexture texture = learn_dynamic_texture(frames);
  DynamicTexturePlayer player(texture, 1, true);
  Eigen::MatrixXd played(kFrames, 5);
  for (Eigen::Index t = 0; t < kFrames; ++t) played.row(t) = player.step(0);
  const auto sd = [](const Eigen::MatrixXd& rows) -> Eigen::RowVectorXd {
    return (rows.rowwise() - rows.colwise().mean()).colwise().norm() / std::sqrt(static_cast<double>(rows.rows()));
  };
  const Eigen::RowVectorXd ratio = sd(played).cwiseQuotient(sd(frames.front().outputs));
  EXPECT_LT((ratio.array() - 1).abs().maxCoeff(), 0.05);
}

TEST(DynamicTexture, IsMadeStable) {
  // A growing oscillation, as a short recording may have it.
  Frames growing{Eigen::MatrixXd(200, 2), Eigen::VectorXd::Zero(200)};
  for (Eigen::Index t = 0; t < 200; ++t) {
    growing.outputs.row(t) << std::pow(1.02, t) * std::cos(0.4 * static_cast<double>(t)),
        std::pow(1.02, t) * std::sin(0.4 * static_cast<double>(t));
  }
  const DynamicTexture texture = learn_dynamic_texture(std::vector{growing});
  EXPECT_GT(texture.found_radius, 1);
  EXPECT_LE(texture.a.eigenvalues().cwiseAbs().maxCoeff(), 0.999 + 1e-12);
}

}  // namespace
}  // namespace wisp::baselines::dynamic_texture_test
