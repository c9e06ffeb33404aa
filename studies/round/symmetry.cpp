#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "base/statistics.hpp"
#include "film_round.hpp"

namespace {

using namespace wisp;

constexpr std::size_t kWindLags = 6;

// Level coordinates and wind of a joined recording, axis by axis.
struct LevelRows {
  std::array<std::vector<const std::vector<double>*>, 2> places;
  std::array<std::vector<double>, 2> rest;
  std::array<const std::vector<double>*, 2> wind;
  double strongest = 0;

  double speed(std::size_t row) const { return std::hypot((*wind[0])[row], (*wind[1])[row]); }

  // Two past rows, then the wind's root, value and square along the axis at six lags, and the row itself. False where
  // something is missing.
  bool fill(std::size_t axis, std::size_t row, Eigen::VectorXd& past, Eigen::VectorXd& now) const {
    Eigen::Index at = 0;
    for (std::size_t lag = 0; lag <= 2; ++lag) {
      for (std::size_t k = 0; k < places[axis].size(); ++k) {
        const double value = (*places[axis][k])[row - lag] - rest[axis][k];
        if (lag == 0) now[static_cast<Eigen::Index>(k)] = value;
        if (lag > 0) past[at++] = value;
      }
    }
    for (std::size_t lag = 0; lag < kWindLags; ++lag) {
      const double speed_then = speed(row - lag), u = speed_then / strongest;
      const double along = speed_then > 0 ? (*wind[axis])[row - lag] / speed_then : 0;
      for (const double power : {std::sqrt(u), u, u * u}) past[at++] = along * power;
    }
    return past.allFinite() && now.allFinite();
  }
};

LevelRows level_rows(const Recording& rings) {
  LevelRows out;
  const auto samples = [&](const std::string& name) { return &rings.channels[*find_channel(rings, name)].samples; };
  out.wind = {samples("wind.x"), samples("wind.z")};
  for (std::size_t row = 0; row < rings.rows(); ++row) out.strongest = std::max(out.strongest, out.speed(row));
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (std::string ring = "ring0"; find_channel(rings, ring + ".x");
         ring = "ring" + std::to_string(out.places[axis].size() / 2)) {
      for (const char* part : {axis == 0 ? ".x" : ".z", axis == 0 ? ".tx" : ".tz"})
        out.places[axis].push_back(samples(ring + part));
    }
    for (const auto* place : out.places[axis]) {
      std::vector<double> calm;
      for (std::size_t row = 0; row < place->size(); ++row)
        if (!std::isnan((*place)[row]) && out.speed(row) < 0.05 * out.strongest) calm.push_back((*place)[row]);
      out.rest[axis].push_back(median(std::move(calm)));
    }
  }
  return out;
}

}  // namespace

int symmetry(const Recording& rings) {
  const LevelRows level = level_rows(rings);
  const auto second = static_cast<std::size_t>(rings.rate_hz);
  const std::size_t rows = rings.rows(), cut = rows * 7 / 10, seconds = (rows - cut) / second;
  const auto n = static_cast<Eigen::Index>(level.places[0].size());
  Eigen::VectorXd past(2 * n + 3 * static_cast<Eigen::Index>(kWindLags)), now(n);
  std::array<Eigen::MatrixXd, 3> grams, rights, found;  // of x, of z, of both
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grams[axis] = Eigen::MatrixXd::Zero(past.size(), past.size());
    rights[axis] = Eigen::MatrixXd::Zero(past.size(), n);
    for (std::size_t row = kWindLags; row < cut && axis < 2; ++row) {
      if (!level.fill(axis, row, past, now)) continue;
      grams[axis] += past * past.transpose();
      rights[axis] += past * now.transpose();
    }
    if (axis == 2) grams[2] = grams[0] + grams[1], rights[2] = rights[0] + rights[1];
    Eigen::MatrixXd ridged = grams[axis];
    ridged.diagonal().array() += 1e-6 * ridged.trace() / static_cast<double>(ridged.rows());
    found[axis] = ridged.ldlt().solve(rights[axis]);
  }
  // Seconds are compared, since rows are not independent.
  std::vector<double> gains(seconds);
  double all = 0;
  for (std::size_t row = cut; row < cut + seconds * second; ++row) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (!level.fill(axis, row, past, now)) continue;
      const double shared = (now - found[2].transpose() * past).squaredNorm();
      gains[(row - cut) / second] += shared - (now - found[axis].transpose() * past).squaredNorm();
      all += shared;
    }
  }
  for (double& gain : gains) gain *= 100 * static_cast<double>(seconds) / all;
  const double error = 1.96 * deviation(gains) / std::sqrt(std::max(1.0, static_cast<double>(seconds) - 1));
  std::printf(
      "%s: coefficients of their own for x and z win %.1f ± %.1f %% of the squared error one step ahead, on %zu "
      "held-out seconds\n",
      rings.source.c_str(), mean(gains), error, seconds);
  return 0;
}
