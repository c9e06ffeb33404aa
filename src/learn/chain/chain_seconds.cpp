#include "learn/chain/chain_seconds.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "base/statistics.hpp"
#include "learn/fidelity/fidelity_distance.hpp"
#include "learn/numeric/constants.hpp"

namespace wisp::chain {
namespace {

constexpr std::array kLags = {0.5, 1.0, 2.0};                                            // seconds
constexpr double kUnseenMetres = 0.3e-3, kUnseenRadians = 0.2 * std::numbers::pi / 180;  // no eye sees less
constexpr double kTailValues[] = {0.001, 0.01, 0.99, 0.999};
constexpr double kNormalValues[] = {-3.0902, -2.3263, 2.3263, 3.0902};  // of a normal distribution, in deviations

using Pieces = std::vector<const MotionPiece*>;

Pieces pieces_of(const Motion& motion) {
  Pieces out;
  for (const MotionPiece& piece : motion.pieces) out.push_back(&piece);
  return out;
}

// Every other fall to a side.
std::array<Pieces, 2> halves_of(const Motion& motion) {
  std::array<Pieces, 2> halves;
  for (std::size_t k = 0; k < motion.pieces.size(); ++k) halves[k % 2].push_back(&motion.pieces[k]);
  return halves;
}

// What an eye follows of pieces: descent and speed over ground, and of poses the height of the normal, velocities and
// spins in the body's axes; with noise of the size that no eye sees.
std::vector<Stretch> signals_of(const Pieces& pieces, double rate_hz, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto noise = [&] { return std::sqrt(12.0) * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5); };
  std::vector<Stretch> out;
  for (const MotionPiece* piece : pieces) {
    const bool pose = !piece->orientation.empty();
    Stretch& own = out.emplace_back(Stretch{pose ? std::size_t{9} : std::size_t{2}, {}});
    std::vector<double> before(own.channels);
    for (std::size_t row = 0; row < piece->rows(); ++row) {
      std::vector<double> values{piece->velocity[row][2], std::hypot(piece->velocity[row][0], piece->velocity[row][1])};
      if (pose) {
        const Quad& q = piece->orientation[row];
        for (const Triple& x : {in_body_axes(q, piece->velocity[row]), in_body_axes(q, piece->spin[row])})
          values.insert(values.end(), x.begin(), x.end());
        values.push_back(std::abs(in_world_axes(q, {0, 0, 1})[2]));
      }
      for (std::size_t k = 0; k < values.size(); ++k) {
        const double unseen = (k < 5 ? kUnseenMetres : kUnseenRadians) * noise();
        own.values.push_back(values[k] + (k < 8 ? rate_hz * (unseen - before[k]) : unseen));
        before[k] = unseen;
      }
    }
  }
  return out;
}

double distance_of(FeatureWindows x, FeatureWindows y, std::size_t most) {
  x = thinned(x, most);
  y = thinned(y, most);
  if (x.size() < 2 || y.size() < 2) return kMissing;
  standardise(x, y);
  return energy_distance(x, y);
}

// Mean squared distance over ground after so many rows.
double spread_of(const Pieces& pieces, std::size_t lag) {
  double sum = 0, count = 0;
  for (const MotionPiece* piece : pieces) {
    for (std::size_t row = lag; row < piece->rows(); ++row, ++count) {
      const Triple &from = piece->position[row - lag], &to = piece->position[row];
      sum += (to[0] - from[0]) * (to[0] - from[0]) + (to[1] - from[1]) * (to[1] - from[1]);
    }
  }
  return count > 0 ? sum / count : kMissing;
}

std::size_t rows_in(double seconds, double rate_hz) { return static_cast<std::size_t>(std::lround(seconds * rate_hz)); }

FallExtremes extremes_of(const Pieces& pieces, double rate_hz) {
  FallExtremes out;
  std::vector<double> speed, acceleration;
  for (const MotionPiece* piece : pieces) {
    for (std::size_t row = 1; row + 1 < piece->rows(); ++row) {
      speed.push_back(piece->velocity[row][2]);
      double square = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = [&](std::size_t k) { return piece->position[k][axis]; };
        square += std::pow(at(row + 1) - 2 * at(row) + at(row - 1), 2);
      }
      acceleration.push_back(std::sqrt(square) * rate_hz * rate_hz);
    }
  }
  const auto share_of = [](std::vector<double>& values, double share) {
    return values.empty() ? kMissing : quantile_in_place(std::span(values), share);
  };
  for (std::size_t k = 0; k < 4; ++k) out.vertical_speed[k] = share_of(speed, kTailValues[k]);
  for (std::size_t k = 0; k < 2; ++k) out.acceleration[k] = share_of(acceleration, kTailValues[2 + k]);
  for (std::size_t k = 0; k < kLags.size(); ++k) out.spread[k] = spread_of(pieces, rows_in(kLags[k], rate_hz));
  return out;
}

// The largest relative deviation of a percentile: of the two low ones of vertical speed, and of accelerations.
double tails_apart(const FallExtremes& a, const FallExtremes& b) {
  double most = 0;
  const auto add = [&](double x, double y) {
    const double off = std::abs(y / x - 1);
    if (!(off <= most)) most = off;  // what can't be told of one stays so
  };
  for (std::size_t k = 0; k < 2; ++k) add(a.vertical_speed[k], b.vertical_speed[k]);
  for (std::size_t k = 0; k < 2; ++k) add(a.acceleration[k], b.acceleration[k]);
  return most;
}

// The extremes of vertical speed that a normal distribution of the same mean and deviation has.
FallExtremes normal_like(const Pieces& pieces, FallExtremes out) {
  double sum = 0, square = 0, count = 0;
  for (const MotionPiece* piece : pieces) {
    for (const Triple& v : piece->velocity) sum += v[2], square += v[2] * v[2], ++count;
  }
  const double mean = sum / count, deviation = std::sqrt(std::max(0.0, square / count - mean * mean));
  for (std::size_t k = 0; k < 4; ++k) out.vertical_speed[k] = mean + kNormalValues[k] * deviation;
  return out;
}

// The spread of the same steps in random order, which is that of a random walk.
double shuffled_spread(const Pieces& pieces, std::size_t lag) {
  double square = 0, count = 0;
  for (const MotionPiece* piece : pieces) {
    for (std::size_t row = 1; row < piece->rows(); ++row, ++count) {
      for (std::size_t axis = 0; axis < 2; ++axis)
        square += std::pow(piece->position[row][axis] - piece->position[row - 1][axis], 2);
    }
  }
  return static_cast<double>(lag) * square / count;
}

}  // namespace

SecondsFidelity seconds_fidelity(const Motion& real, const Motion& synthesized, std::size_t max_windows,
                                 std::uint64_t seed) {
  const double rate = real.rate_hz;
  const std::size_t rows = rows_in(kLongWindowSeconds, rate);
  const Pieces all = pieces_of(real), made = pieces_of(synthesized);
  const auto halves = halves_of(real);
  SecondsFidelity out;
  const auto seen = signals_of(all, rate, 1);
  const auto apart_by_spectra = [&](const std::vector<Stretch>& a, const std::vector<Stretch>& b) {
    return distance_of(spectral_windows(a, rows, rows), spectral_windows(b, rows, rows), max_windows);
  };
  out.spectra = {apart_by_spectra(seen, signals_of(made, rate, 2)),
                 apart_by_spectra(signals_of(halves[0], rate, 1), signals_of(halves[1], rate, 2)),
                 apart_by_spectra(seen, shuffled(seen, seed))};
  out.real = extremes_of(all, rate);
  out.synthesized = extremes_of(made, rate);
  const FallExtremes half = extremes_of(halves[0], rate), other = extremes_of(halves[1], rate);
  out.tails = {tails_apart(out.real, out.synthesized), tails_apart(half, other),
               tails_apart(out.real, normal_like(all, out.real))};
  const auto apart = [](double a, double b) {
    return a > kUnseenMetres * kUnseenMetres ? std::abs(b / a - 1)
                                             : kMissing;  // what does not spread has no share of it
  };
  out.spread = {apart(out.real.spread[2], out.synthesized.spread[2]), apart(half.spread[2], other.spread[2]),
                apart(out.real.spread[2], shuffled_spread(all, rows))};
  return out;
}

}  // namespace wisp::chain
